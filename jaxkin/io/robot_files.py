"""Robot files of all formats, each recognised by its suffix or by its first element."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element

from jaxkin.assembly.exported import Exported
from jaxkin.geometry.part import Part
from jaxkin.io.asmt import read_asmt
from jaxkin.io.fcstd import read_fcstd
from jaxkin.io.mjcf import read_mjcf
from jaxkin.io.robots import parts_and_export
from jaxkin.io.sdf import read_sdf
from jaxkin.io.urdf import read_urdf
from jaxkin.io.xml_tree import read_xml

ASMT = ".asmt"
"""The suffix of assemblies of FreeCAD's solver."""

FCSTD = ".fcstd"
"""The suffix of FreeCAD's own documents."""

ROBOT_SUFFIXES = (".urdf", ".mjcf", ".sdf", ".world", ASMT, FCSTD)
"""Suffixes of robot files; those of MuJoCo are ".xml", as other files are too."""

ROBOT_ROOTS = ("robot", "mujoco", "sdf", "mujocoinclude")
"""First elements of robot files, and of what a model of MuJoCo includes."""


def read_robot(
    path: Path, root: Element | None, loops: Path | None, seconds: float | None
) -> tuple[tuple[Part, ...], str, Exported]:
    """Read the parts of a robot, their unit, and what its file says of joints; `root` where the file is parsed.

    `loops` is the YAML file of the loops of a URDF. Raises FileNotFoundError where a file is not there, and ValueError,
    in one line, for what is not understood or not safe to leave out.
    """
    suffix = path.suffix.lower()
    if suffix in (ASMT, FCSTD):
        _refuse_loops(path, loops)
        return parts_and_export(read_asmt(path) if suffix == ASMT else read_fcstd(path), path, seconds)
    root = read_xml(path) if root is None else root
    if root.tag == "robot":
        return parts_and_export(read_urdf(path, root, loops), path, seconds)
    _refuse_loops(path, loops)
    if root.tag == "mujoco":
        return parts_and_export(read_mjcf(path, root), path, seconds)
    if root.tag == "sdf":
        return parts_and_export(read_sdf(path, root), path, seconds)
    if root.tag == "mujocoinclude":
        raise ValueError(f"{path.name}: it is a part of a model (<mujocoinclude>): load the file that includes it")
    raise ValueError(f"{path.name}: expected URDF (<robot>), MJCF (<mujoco>) or SDF (<sdf>), got <{root.tag}>")


def _refuse_loops(path: Path, loops: Path | None) -> None:
    if loops is not None:
        raise ValueError(f"loops is the YAML file of the loops of a robot in URDF; {path.name} is none: it has its own")
