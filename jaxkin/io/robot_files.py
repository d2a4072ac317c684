"""Robot files of all formats, each recognised by its suffix or by its first element."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element

from jaxkin.assembly.exported import Exported
from jaxkin.geometry.part import Part
from jaxkin.io.mjcf import read_mjcf
from jaxkin.io.robots import assembled
from jaxkin.io.urdf import read_urdf
from jaxkin.io.xml_tree import read_xml

ROBOT_SUFFIXES = (".urdf", ".mjcf")
"""Suffixes of robot files; those of MuJoCo are ".xml", as other files are too."""

ROBOT_ROOTS = ("robot", "mujoco")
"""First elements of robot files."""


def read_robot(
    path: Path, root: Element | None, loops: Path | None, seconds: float | None
) -> tuple[tuple[Part, ...], str, Exported]:
    """Read the parts of a robot, their unit, and what its file says of joints; `root` where the file is parsed.

    `loops` is the YAML file of the loops of a URDF. Raises FileNotFoundError where a file is not there, and ValueError,
    in one line, for what is not understood or not safe to leave out.
    """
    root = read_xml(path) if root is None else root
    if root.tag == "robot":
        return assembled(read_urdf(path, root, loops), path, seconds)
    if loops is not None:
        raise ValueError(f"loops is the YAML file of the loops of a robot in URDF; {path.name} is none: it has its own")
    if root.tag == "mujoco":
        return assembled(read_mjcf(path, root), path, seconds)
    raise ValueError(f"{path.name}: expected a robot in URDF (<robot>) or MJCF (<mujoco>), got <{root.tag}>")
