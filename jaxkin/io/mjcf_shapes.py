"""The solids of a MuJoCo model: its <geom> elements, and the <mesh> assets that they name."""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from jaxkin.io.mjcf_text import Compiler, Defaults
from jaxkin.io.robot_model import LinkShape, numbers, placed, quaternion

SIZES = {"sphere": 1, "ellipsoid": 3, "box": 3, "capsule": 2, "cylinder": 2}
"""Types of solids -> how many sizes each needs."""

COLLIDING = 3
"""Group of solids that by custom are drawn in debuggers only: they stand for those of the groups below."""


class Shapes:
    """The meshes of a model by name."""

    def __init__(self, root: Element, compiler: Compiler, defaults: Defaults) -> None:
        self.compiler, self.defaults = compiler, defaults
        self.meshes = {}
        for each in root.iterfind("asset/mesh"):
            said = defaults.said(each)
            file = said.get("file", "")
            stem = file.replace("\\", "/").rpartition("/")[2].rpartition(".")[0]
            self.meshes[said.get("name", stem)] = said

    def drawn(self, geom: Element, child_class: str | None, where: str) -> LinkShape | None:
        """Read a solid as `solid` does; None, too, for what is only for collisions."""
        said = self.defaults.said(geom, child_class)
        return None if group_of(said) >= COLLIDING else self.solid(said, where)

    def is_solid(self, geom: Element, child_class: str | None) -> bool:
        """Tell whether a geom is of a type that is drawn, and not only for collisions."""
        said = self.defaults.said(geom, child_class)
        return said.get("type", "sphere") in SIZES and group_of(said) < COLLIDING

    def solid(self, said: dict[str, str], where: str) -> LinkShape | None:
        """Read a solid in the frame that it is written in, from its attributes; None for a plane, and for a size that
        is none."""
        kind = said.get("type", "mesh" if "mesh" in said and "type" not in said else "sphere")
        pose = self.compiler.pose(said, where)
        if kind == "mesh":
            return self._mesh(said.get("mesh", ""), where, pose)
        if kind not in SIZES:
            return None
        size = np.array((said.get("size") or "").split(), float)
        if "fromto" in said:
            start, end = numbers(said["fromto"], 6, where).reshape(2, 3)
            half = float(np.linalg.norm(end - start)) / 2
            size = np.array([size[0], half] if SIZES[kind] == 2 else [size[0], size[0], half])
        if len(size) < SIZES[kind] or not np.isfinite(size).all() or np.any(size[: SIZES[kind]] <= 0):
            return None
        if kind in ("capsule", "cylinder"):
            return LinkShape(pose, kind, (float(size[0]), 2 * float(size[1])))
        lengths = tuple(float(each) for each in size[: SIZES[kind]])
        if kind == "box":
            return LinkShape(pose, "box", tuple(2 * each for each in lengths))
        return LinkShape(pose, "sphere", lengths)

    def _mesh(self, name: str, where: str, pose: np.ndarray) -> LinkShape:
        said = self.meshes.get(name, {"file": name})
        file = said.get("file", "")
        if self.compiler.strip and "folder" not in said:
            file = file.replace("\\", "/").rpartition("/")[2]
        scale, reference = tuple(numbers(said.get("scale"), 3, where, (1, 1, 1))), None
        if "refpos" in said or "refquat" in said:
            turn = quaternion(numbers(said.get("refquat"), 4, where, (1, 0, 0, 0)), where)
            reference = placed(turn, numbers(said.get("refpos"), 3, where, (0, 0, 0)))
        if not file and "vertex" in said:
            corners = _inline(said, f"{where}: mesh {name!r}")
            return LinkShape(pose, "mesh", scale, name, corners, reference)
        folder = said.get("folder", self.compiler.folder).rstrip("/")  # an attached model lies in one of its own
        return LinkShape(pose, "mesh", scale, f"{folder}/{file}" if folder else file, reference=reference)


def _hull(points: np.ndarray) -> np.ndarray:
    """Make the triangles (n, 3, 3) of the convex hull of points (m, 3), wound outwards."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(points)
    corners = points[hull.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = np.einsum("fi,fi->f", normals, hull.equations[:, :3]) < 0
    corners[inwards] = corners[inwards, ::-1]
    return corners


def group_of(said: dict[str, str]) -> int:
    """Return the group of a solid: 0 where none is written."""
    text = said.get("group", "0").strip()
    return int(text) if text.isdigit() else 0


def _inline(said: dict[str, str], where: str) -> np.ndarray:
    """Read the triangles (n, 3, 3) of a mesh that the model holds itself: of its faces, else of its convex hull."""
    from scipy.spatial import QhullError

    try:
        points = np.array(said["vertex"].split(), float).reshape(-1, 3)
        faces = np.array(said.get("face", "").split(), int).reshape(-1, 3)
        if not np.isfinite(points).all() or (len(faces) and not 0 <= faces.min() <= faces.max() < len(points)):
            raise ValueError("numbers that are not finite, or faces of vertices that are not there")
        if not len(faces):
            return _hull(points)
    except (ValueError, QhullError) as error:
        raise ValueError(f"{where}: its vertices and faces are no triangles: {str(error).splitlines()[0]}") from error
    return points[faces]
