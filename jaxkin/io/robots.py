"""Assemblies from robot files: each link a part with its solids, each joint a constraint, the loops closed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from jaxkin._names import listed
from jaxkin.assembly.close_export import closed_export
from jaxkin.assembly.exported import Constraint, Exported
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import apply
from jaxkin.io.mesh import MESHES
from jaxkin.io.mesh_nodes import Node, read_several
from jaxkin.io.names import cleaned, unique
from jaxkin.io.robot_model import RobotJoint, RobotLink, RobotModel, Shape
from jaxkin.joints.combine import Chain
from jaxkin.joints.on_frames import MOVEMENT_OF
from jaxkin.topology.components import connected

MARK = 0.02
"""Edge of the box that is drawn for a link without a solid, over the extent of the robot."""

LEAST_EXTENT = 1e-3
"""Extent in metres that a robot is given at least: all links of one may begin at the same point."""

FOLDERS_UP = 4
"""Folders above that of a robot file in which its meshes are looked for: packages of ROS keep urdf/ and meshes/ side by
side, at most two or three levels below the folder that package:// stands for."""

PREFIXES = ("package://", "model://", "file://")
"""Beginnings of the names of meshes that stand for folders of other machines."""


def assembled(model: RobotModel, path: Path, seconds: float | None) -> tuple[tuple[Part, ...], str, Exported]:
    """Make the parts of a robot in a closed pose, their unit, and what the file says of joints and bodies.

    Meshes that are there are read as they are, without looking for faces; links without a solid are small boxes.
    `seconds` is the time allowed for each mesh. Raises ValueError where names repeat.
    """
    _refuse_repeats(path.name, "link", [link.name for link in model.links])
    _refuse_repeats(path.name, "joint", [joint.name for joint in model.joints])
    link_names = _clean_names([link.name for link in model.links])
    joint_names = _clean_names([each.name for each in model.joints])
    model = _held(model, path.name)
    meshes = _Meshes(path, seconds, [shape for link in model.links for shape in link.shapes])
    mark = MARK * _extent(model)
    parts = tuple(_part(link, link_names[link.name], meshes.triangles, mark) for link in model.links)
    constraints = [_constraint(each, joint_names[each.name], link_names) for each in model.joints]
    exported = Exported(
        fixed=tuple(link_names[name] for name in model.fixed),
        rigid=(),
        constraints=tuple(constraints),
        notes=(*model.notes, *meshes.notes()),
        motors=tuple(_renamed(name, joint_names) for name in model.motors),
        couplings=tuple(
            replace(each, coordinates=tuple(_renamed(name, joint_names) for name in each.coordinates))
            for each in model.couplings
        ),
        system="robot file",
    )
    parts, exported = closed_export(parts, exported, [each.frame_2[None] for each in model.joints], model.unit)
    return parts, model.unit, exported


def _held(model: RobotModel, file: str) -> RobotModel:
    """Hold one link of each group of links that no joints tie to those at rest: the first; a note says so."""
    names = [link.name for link in model.links]
    ties = [*(each.parts for each in model.joints), *((model.fixed[0], name) for name in model.fixed[1:])]
    loose = [group for group in connected(names, ties) if not group & {*model.fixed}]
    if not loose:
        return model
    held = tuple(min(group, key=names.index) for group in loose)
    note = (
        f"{file}: nothing ties {listed(list(map(repr, held)))} to the ground: held at rest; give fixed= to hold "
        "another part instead"
    )
    return replace(model, fixed=(*model.fixed, *held), notes=(*model.notes, note))


def _renamed(motor: str, names: Mapping[str, str]) -> str:
    """Rename a motor, which is a joint, or a coordinate of one, "joint.phi"."""
    joint, _, coordinate = motor.rpartition(".")
    return names[motor] if motor in names else f"{names[joint]}.{coordinate}"


def _clean_names(names: list[str]) -> dict[str, str]:
    """Map names as the file has them to names that are fit for messages."""
    return dict(zip(names, unique(cleaned(name) or "unnamed" for name in names), strict=True))


def _refuse_repeats(file: str, what: str, names: list[str]) -> None:
    if repeated := [name for name, count in Counter(names).items() if count > 1]:
        raise ValueError(f"{file}: {what} {repeated[0]!r} is there twice; every {what} needs a name of its own")


def _constraint(each: RobotJoint, name: str, link_names: Mapping[str, str]) -> Constraint:
    parts = (link_names[each.parts[0]], link_names[each.parts[1]])
    chain = Chain((MOVEMENT_OF[each.kind],), each.frame_1[None])
    return Constraint(
        name, parts, each.text, chain, each.kind, limits=each.limits, pitch=each.pitch, values=each.values
    )


def _extent(model: RobotModel) -> float:
    """Measure the largest extent of the origins of links and joints, metres."""
    points = [link.pose[:3, 3] for link in model.links] + [joint.frame_1[:3, 3] for joint in model.joints]
    return max(LEAST_EXTENT, float(np.ptp(points, axis=0).max()))


def _part(link: RobotLink, name: str, triangles_of: Callable[[Shape, str], np.ndarray | None], mark: float) -> Part:
    """Make a part of a link, in the world; a small box at its origin where none of its solids is there."""
    found = [triangles for shape in link.shapes if (triangles := triangles_of(shape, link.name)) is not None]
    notes = () if found or not link.shapes else ("no file of its solid",)
    corners = np.concatenate(found) if found else _corners(Shape(np.eye(4), "box", (mark,) * 3))
    inertial = None if link.inertial is None else link.inertial.moved(link.pose)
    triangles, is_solid = apply(link.pose, corners), bool(found)
    return Part(name, (), triangles, notes=notes, original_name=link.name, inertial=inertial, is_solid=is_solid)


def _corners(shape: Shape) -> np.ndarray:
    """Make the triangles (n, 3, 3) of a solid that needs no file, in the frame of its link, metres."""
    import trimesh

    make = {
        "box": lambda: trimesh.creation.box(shape.size),
        "sphere": lambda: trimesh.creation.icosphere(2).apply_scale(np.broadcast_to(shape.size, 3)),
        "cylinder": lambda: trimesh.creation.cylinder(*shape.size, sections=32),
        "capsule": lambda: trimesh.creation.capsule(shape.size[1], shape.size[0], count=(16, 16)),
    }
    corners = np.array(make[shape.kind]().triangles, float)
    if shape.kind == "capsule":  # trimesh centres a capsule at the middle of one of its ends in some versions
        corners -= (corners.reshape(-1, 3).min(axis=0) + corners.reshape(-1, 3).max(axis=0)) / 2
    return apply(shape.pose, corners)


class _Meshes:
    """The mesh files of a robot, each read once."""

    def __init__(self, path: Path, seconds: float | None, shapes: list[Shape]) -> None:
        self.path = path
        self.folders = [path.resolve().parent, *path.resolve().parent.parents][: FOLDERS_UP + 1]
        names = {shape.file for shape in shapes if shape.kind == "mesh" and shape.corners is None}
        files = {name: self._file(name) for name in sorted(names)}
        read = read_several({file for file in files.values() if isinstance(file, Path)}, seconds)
        self.read = {
            name: _corners_of(name, read[file] if isinstance(file, Path) else file) for name, file in files.items()
        }
        """Triangles (n, 3, 3) in the unit of the file, or why there are none."""
        self.missing: dict[str, list[str]] = {}
        """Why there are none -> the links."""

    def triangles(self, shape: Shape, link: str) -> np.ndarray | None:
        """Make the triangles (n, 3, 3) of a solid in the frame of its link, metres; None where there is no file."""
        if shape.kind != "mesh":
            return _corners(shape)
        found = self.read[shape.file] if shape.corners is None else shape.corners
        if isinstance(found, str):
            links = self.missing.setdefault(found, [])
            links += [link] if link not in links else []
            return None
        corners = found * np.array(shape.size or (1.0, 1.0, 1.0))
        if np.prod(shape.size or (1.0,)) < 0:
            corners = corners[:, ::-1]
        return apply(shape.pose, corners)

    def notes(self) -> list[str]:
        """Name the meshes that are not there, with their links."""
        return [
            f"{self.path.name}: {why}; {listed(list(map(repr, links)))} {'is' if len(links) == 1 else 'are'} drawn "
            "without it"
            for why, links in self.missing.items()
        ]

    def _file(self, name: str) -> Path | str:
        """Find the file of a mesh by the name that the robot file gives; or why there is none."""
        rest = name
        for prefix in PREFIXES:
            rest = rest.removeprefix(prefix)
        rest = rest.replace("\\", "/").lstrip("/")
        if Path(rest).suffix.lower() not in MESHES:
            return f"mesh {name!r} is not read: its format is none of {', '.join(MESHES)}"
        shorter = rest.partition("/")[2]  # without the name of the package
        tries = [folder / part for folder in self.folders for part in (rest, shorter) if part]
        absolute = [Path(f"/{rest}")] if name.startswith(("/", "file:///")) else []
        file = next((each for each in (*absolute, *tries) if each.is_file()), None)
        return f"mesh {name!r} is not there" if file is None else file


def _corners_of(name: str, found: list[Node] | ValueError | str) -> np.ndarray | str:
    """Return the triangles of the mesh of that name, or why there are none."""
    if isinstance(found, list):
        return np.concatenate([node.corners for node in found])
    return f"mesh {name!r} cannot be read: {found}" if isinstance(found, ValueError) else found
