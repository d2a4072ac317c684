"""Prepare the solids of a mechanism for the search for clashes: trees of triangles, boxes, and what may overlap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin._memory import once_for_each
from jaxkin.contacts.whole_face import is_whole
from jaxkin.geometry.congruent import displacement
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.part import Face, Part, box_corners
from jaxkin.geometry.pose import Transform
from jaxkin.geometry.sample_points import SurfacePoints, core_points, surface_points
from jaxkin.geometry.surfaces import Cone, Plane, Sphere
from jaxkin.geometry.triangle_distance import Points
from jaxkin.geometry.triangle_tree import TriangleTree, aligned_axes, triangle_tree

_SAME_PLACE = 1e-7
"""Share of the size of a part within which two triangles are the same: corners were moved by rounded displacements."""
_SAME_MESH = 1e-9
"""Share of the size of a part within which the corners of two instances are the same: both were moved from one mesh, in
float64. Meshes of files in float32 that differ by their rounding are searched as they are."""


@dataclass(frozen=True, eq=False)
class ClashShape:
    """A mesh as triangles with labels: the number of their face, or the number of faces where they are of none."""

    part: Part
    """The first part that has this mesh; the others are displaced from where it is."""
    number: int
    """The place of the mesh among all of a mechanism."""
    axes: Float[np.ndarray, "3 3"]
    """Axes along which the part is flat, in rows; the coordinates of the tree are along them."""
    tree: TriangleTree
    labels: Int[np.ndarray, " triangles"]

    @cached_property
    def bulges(self) -> Float[np.ndarray, " labels"]:
        """How far the surface of each label is from its triangles; 0 for faces whose surface is not known."""
        return np.array([*(face.bulge for face in self.part.faces), 0.0])

    @cached_property
    def axis_points(self) -> dict[int, Float[np.ndarray, "_ 3"]]:
        """By the labels of whole faces of revolution, points of their axes, in the axes of the shape."""
        found = {label: axis_points(face) for label, face in enumerate(self.part.faces)}
        return {label: points @ self.axes.T for label, points in found.items() if points is not None}

    @cached_property
    def corners(self) -> tuple[Float[np.ndarray, "corners 3"], Int[np.ndarray, "triangles 3"]]:
        """The corners, each once, in the axes, and for each triangle the indices of its corners."""
        points, index = np.unique(self.tree.triangles.reshape(-1, 3), axis=0, return_inverse=True)
        return points, index.reshape(-1, 3)

    @cached_property
    def surface_points(self) -> SurfacePoints:
        """Points of each face, in the axes."""
        return surface_points(self.tree.triangles, self.labels)

    @cached_property
    def core_points(self) -> Points:
        """Points inside of the solid, in the axes."""
        return core_points(self.tree.triangles, self.labels)

    def reached(self, points: Points, back: Displaced) -> Bool[np.ndarray, " points"]:
        """Tell which points of another solid are in the box of the shape, which is displaced, at some displacement."""
        middle, half = self.tree.middles[:, 0], self.tree.halves[:, 0]
        middles, halves = back.rotation @ middle + back.shift, np.abs(back.rotation) @ half
        low, high = (middles - halves).min(axis=0), (middles + halves).max(axis=0)
        return np.all((points >= low) & (points <= high), axis=1)


def axis_points(face: Face) -> Float[np.ndarray, "_ 3"] | None:
    """Find points of the axis of a whole face of revolution, at its ends, or its centre; None for all other faces."""
    surface = face.surface
    if isinstance(surface, Plane) or not is_whole(face):
        return None
    if isinstance(surface, Sphere):
        return surface.centre[None]
    point = surface.apex if isinstance(surface, Cone) else surface.point
    middle, half = face.box.mean(axis=0), float(np.linalg.norm(np.ptp(face.box, axis=0))) / 2
    foot = point + ((middle - point) @ surface.axis) * surface.axis
    return np.stack([foot - half * surface.axis, foot + half * surface.axis])


@dataclass(frozen=True, eq=False)
class ClashPart:
    """A part as one of few meshes, displaced: a screw that an assembly has a hundred times is prepared once."""

    part: Part
    shape: ClashShape
    place: Transform
    """Displacement of the part that has the mesh to this one."""


def clash_parts(parts: Sequence[Part]) -> tuple[ClashPart, ...]:
    """Prepare parts, and find which of them are displaced copies of others, with the same faces in the same order."""
    found: list[ClashPart] = []
    alike: dict[tuple[int, ...], list[ClashShape]] = {}
    count = 0
    for part in parts:
        known = alike.setdefault((len(part.triangles), *(len(face.triangles) for face in part.faces)), [])
        corners, length = _corners(part), _SAME_MESH * float(np.ptp(part.box, axis=0).max())
        places = ((shape, displacement(_corners(shape.part), corners, length)) for shape in known)
        shape, place = next(((shape, place) for shape, place in places if place is not None), (None, np.eye(4)))
        if shape is None:
            shape, count = ClashShape(part, count, *_mesh(part)), count + 1
            known.append(shape)
        found.append(ClashPart(part, shape, place))
    return tuple(found)


def _corners(part: Part) -> Points:
    """List the corners of all triangles of a part, and those of its faces."""
    return np.concatenate([part.triangles, *(face.triangles for face in part.faces)]).reshape(-1, 3).astype(float)


@once_for_each
def _mesh(part: Part) -> tuple[Float[np.ndarray, "3 3"], TriangleTree, Int[np.ndarray, " triangles"]]:
    """Prepare the mesh of a part, for all searches of its mechanism: its axes, its triangles along these, and the
    number of the face of each triangle."""
    from scipy.spatial import KDTree

    axes = aligned_axes(part.triangles)
    labels = np.full(len(part.triangles), len(part.faces))
    if part.faces:
        owners = np.repeat(np.arange(len(part.faces)), [len(face.triangles) for face in part.faces])
        middles = np.concatenate([face.triangles.mean(axis=1) for face in part.faces])
        reach = _SAME_PLACE * float(np.ptp(part.box, axis=0).max())
        distance, nearest = KDTree(middles).query(part.triangles.mean(axis=1), distance_upper_bound=reach)
        known = np.isfinite(distance)
        labels[known] = owners[np.asarray(nearest)[known]]
    triangles = np.ascontiguousarray(part.triangles, float) @ axes.T
    return axes, triangle_tree(triangles, labels), labels


def displaced(one: ClashPart, other: ClashPart, of_one: np.ndarray, of_other: np.ndarray) -> Displaced:
    """Compute the displacements of one mesh relative to another from those of the parts in the world, (poses, 4, 4)."""
    of_one, of_other = of_one @ one.place, of_other @ other.place
    turn = np.swapaxes(of_one[:, :3, :3], 1, 2)
    rotation = turn @ of_other[:, :3, :3]
    shift = np.einsum("pij,pj->pi", turn, of_other[:, :3, 3] - of_one[:, :3, 3])
    return Displaced(one.shape.axes @ rotation @ other.shape.axes.T, shift @ one.shape.axes.T)


def boxes_along(part: Part, transforms: Float[np.ndarray, "poses 4 4"]) -> Float[np.ndarray, "poses 2 3"]:
    """Compute the bounding boxes of a displaced part in world axes."""
    points = np.einsum("pij,nj->pni", transforms[:, :3, :3], part.outermost) + transforms[:, None, :3, 3]
    return np.stack([points.min(axis=1), points.max(axis=1)], axis=1)


def largest_step(parts: Sequence[Part], places: Sequence[Float[np.ndarray, "poses 4 4"]]) -> float:
    """Bound how far a point of a displaced part moves from one pose to the next, unit of the parts.

    It is an affine function of the point, so that none of the box of a part moves farther than a corner of it.
    """
    found = 0.0
    for part, transforms in zip(parts, places, strict=True):
        points = part.outermost
        corners = box_corners(np.stack([points.min(axis=0), points.max(axis=0)]))
        steps = np.diff(transforms, axis=0)
        moved = np.einsum("pij,nj->pni", steps[:, :3, :3], corners) + steps[:, None, :3, 3]
        found = max(found, float(np.linalg.norm(moved, axis=-1).max(initial=0.0)))
    return found


def near_pairs(
    boxes: Float[np.ndarray, "parts poses 2 3"], compared: Bool[np.ndarray, "parts parts"], margin: float
) -> list[tuple[int, int, Int[np.ndarray, " poses"]]]:
    """Find the pairs of parts whose boxes come nearer than a margin, with the poses at which they do."""
    found = []
    for i in range(len(boxes)):
        others = i + 1 + np.flatnonzero(compared[i, i + 1 :])
        low, high = boxes[i, :, 0] - margin, boxes[i, :, 1] + margin
        near = np.all((boxes[others, :, 0] <= high) & (boxes[others, :, 1] >= low), axis=-1)
        found += [(i, int(j), np.flatnonzero(row)) for j, row in zip(others, near, strict=True) if row.any()]
    return found
