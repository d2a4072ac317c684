"""What is drawn of the links of a robot: boxes and the like, and mesh files, each read once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from jaxkin._names import listed
from jaxkin.geometry.inertial import Inertial, sum_of
from jaxkin.geometry.pose import apply, inverse
from jaxkin.io.mesh import MESHES
from jaxkin.io.mesh_nodes import MeshNode, read_several
from jaxkin.io.robot_model import LinkShape, RobotLink
from jaxkin.io.shape_masses import inertial_of

DRAWN = (*MESHES, ".dae")
"""Suffixes of the meshes that links are drawn by. COLLADA is what most robots of ROS look like; the axis that a file of
it calls up is not turned upright, as the viewers of ROS do not turn it."""

FOLDERS_UP = 4
"""Folders above that of a robot file in which its meshes are looked for: packages of ROS keep urdf/ and meshes/ side by
side, at most two or three levels below the folder that package:// stands for."""

PREFIXES = ("package://", "model://", "file://")
"""Beginnings of the names of meshes that stand for folders of other machines."""


class Drawn:
    """The solids of the links of a robot: what is seen of a link, or, where no file of that can be read, what it
    collides with."""

    def __init__(self, path: Path, links: Sequence[RobotLink], seconds: float | None) -> None:
        """Read the mesh files, each within `seconds`; `path` is that of the robot file."""
        self._folders = [path.resolve().parent, *path.resolve().parent.parents][: FOLDERS_UP + 1]
        self._seconds = seconds
        self._read: dict[str, np.ndarray | str] = {}
        """Of each mesh its triangles (n, 3, 3), in the unit of its file, or why there are none."""
        shapes = {link.name: link.shapes for link in links}
        self.solids: dict[str, list[np.ndarray]] = self._solids(shapes)
        """Of each link the triangles (n, 3, 3) of its solids, in its frame, metres; none where there is no file."""
        others = {link.name: link.collisions for link in links if not self.solids[link.name]}
        self.solids |= self._solids(others)
        missing: dict[str, list[str]] = {}
        for name, each in (*shapes.items(), *others.items()):
            for shape in filter(_is_file, each):
                if isinstance(why := self._read[shape.file], str) and name not in missing.setdefault(why, []):
                    missing[why].append(name)
        self.notes = tuple(
            f"{path.name}: {why}; {listed(list(map(repr, names)))} {'is' if len(names) == 1 else 'are'} drawn without "
            "it"
            for why, names in missing.items()
        )
        """The meshes that are not there, with their links."""

    def _solids(self, shapes: dict[str, tuple[LinkShape, ...]]) -> dict[str, list[np.ndarray]]:
        """Make the triangles of the shapes of each link; those of which there is no file are left out."""
        self._fetch(shape.file for each in shapes.values() for shape in each if _is_file(shape))
        return {
            name: [apply(shape.pose, corners) for shape in each if not isinstance(corners := self._corners(shape), str)]
            for name, each in shapes.items()
        }

    def inertial(self, link: RobotLink) -> tuple[Inertial | None, str]:
        """Add up what the solids of a link weigh, in its frame, metres; None, and why, where that of one is unknown."""
        self._fetch(each.shape.file for each in link.weighed if _is_file(each.shape))
        found = []
        for weighed in link.weighed:
            corners = self._corners(weighed.shape) if weighed.shape.kind == "mesh" else None
            if isinstance(corners, str):
                return None, corners
            own = inertial_of(weighed, corners)
            if own is None:
                return None, f"the surface of mesh {weighed.shape.file!r} is not closed"
            found.append(own)
        return sum_of(found), ""

    def _corners(self, shape: LinkShape) -> np.ndarray | str:
        """Return the triangles (n, 3, 3) of a shape, in its frame, metres; or why there are none."""
        if shape.kind != "mesh":
            return triangles_of(shape)
        found = self._read[shape.file] if shape.corners is None else shape.corners
        if isinstance(found, str):
            return found
        if shape.reference is not None:
            found = apply(inverse(shape.reference), found)
        corners = found * np.array(shape.size or (1.0, 1.0, 1.0))
        return corners[:, ::-1] if np.prod(shape.size or (1.0,)) < 0 else corners

    def _fetch(self, names: Iterable[str]) -> None:
        """Read the meshes of these names, as the robot file gives them, that are not read yet."""
        files = {name: self._file(name) for name in sorted({*names} - {*self._read})}
        read = read_several(dict.fromkeys(file for file in files.values() if isinstance(file, Path)), self._seconds)
        for name, file in files.items():
            self._read[name] = _joined(name, read[file]) if isinstance(file, Path) else file

    def _file(self, name: str) -> Path | str:
        """Find the file of a mesh; or why there is none."""
        rest = name
        for prefix in PREFIXES:
            rest = rest.removeprefix(prefix)
        rest = rest.replace("\\", "/").lstrip("/")
        if not Path(rest).suffix:
            return f"mesh {name!r} is not there"
        if Path(rest).suffix.lower() not in DRAWN:
            return f"mesh {name!r} is not read: its format is none of {', '.join(DRAWN)}"
        shorter = rest.partition("/")[2]  # without the name of the package
        tries = [folder / part for folder in self._folders for part in (rest, shorter) if part]
        absolute = [Path(f"/{rest}")] if name.startswith(("/", "file:///")) else []
        file = next((each for each in (*absolute, *tries) if each.is_file()), None)
        return f"mesh {name!r} is not there" if file is None else file


def _is_file(shape: LinkShape) -> bool:
    return shape.kind == "mesh" and shape.corners is None


def _joined(name: str, found: list[MeshNode] | ValueError) -> np.ndarray | str:
    """Return the triangles of the mesh of that name, or why there are none."""
    if isinstance(found, ValueError):
        return f"mesh {name!r} cannot be read: {found}"
    return np.concatenate([node.corners for node in found])


def triangles_of(shape: LinkShape) -> np.ndarray:
    """Make the triangles (n, 3, 3) of a solid that needs no file, in its frame, metres.

    Round ones have their exact volume, so that they weigh what they are: triangles with their corners on a sphere hold
    3 % less. Moments of inertia are right to 1e-5 for spheres and cylinders, and to 4e-3 for capsules.
    """
    from trimesh.creation import box, capsule, cylinder, icosphere

    if shape.kind == "box":
        return np.array(box(shape.size).triangles, float)
    if shape.kind == "sphere":
        corners = np.array(icosphere(3).triangles) * np.broadcast_to(shape.size, 3)
        return corners * np.cbrt(_ratio(4 / 3 * np.pi * np.prod(np.broadcast_to(shape.size, 3)), corners))
    radius, length = shape.size
    volume = np.pi * radius**2 * length
    if shape.kind == "cylinder":
        corners = np.array(cylinder(1.0, 1.0, sections=32).triangles) * [radius, radius, length]
    else:
        mesh = capsule(1.0, 1.0, count=(16, 32))
        mesh.apply_translation(-mesh.bounds.mean(axis=0))  # it begins at the middle of one end in some versions
        ends = np.sign(np.array(mesh.triangles)) * [0, 0, 0.5]
        corners = (mesh.triangles - ends) * radius + ends * length
        volume += 4 / 3 * np.pi * radius**3
    across = np.sqrt(_ratio(volume, corners))
    return corners * [across, across, 1.0]


def _ratio(volume: float, corners: np.ndarray) -> float:
    """Compute a volume over that of triangles; 1 where these hold none."""
    held = float(np.linalg.det(corners).sum()) / 6
    return volume / held if held > 0 else 1.0
