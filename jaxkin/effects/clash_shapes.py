"""Prepare the solids of a mechanism for the search for clashes: trees of triangles, boxes, and what may overlap."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.contacts.whole_face import is_whole
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.surfaces import Cone, Plane, Sphere
from jaxkin.geometry.triangle_tree import TriangleTree, aligned_axes, triangle_tree

_SAME_PLACE = 1e-7
"""Share of the size of a part within which two triangles are the same: corners were moved by rounded displacements."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A part as triangles with labels: the number of their face, or the number of faces where they are of none."""

    part: Part
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
    def middle(self) -> Float[np.ndarray, "3"]:
        """A point inside of the solid, in the axes: half-way through it, below its largest triangle."""
        triangles = self.tree.triangles
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        areas = np.linalg.norm(normals, axis=-1)
        largest = int(np.argmax(areas))
        inwards = -normals[largest] / areas[largest]
        start = triangles[largest].mean(axis=0)
        through = _ray(triangles, start, inwards)
        through = through[through > _SAME_PLACE * float((self.tree.high[0] - self.tree.low[0]).max())]
        return start + inwards * (float(through.min(initial=np.inf)) / 2 if len(through) else 0.0)


def _ray(triangles: np.ndarray, start: np.ndarray, direction: np.ndarray) -> Float[np.ndarray, " _"]:
    """Find where a ray goes through triangles: lengths along its unit direction."""
    edge1, edge2 = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    across = np.cross(direction, edge2)
    determinant = np.sum(edge1 * across, axis=-1)
    off = start - triangles[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):  # rays along a triangle go through it nowhere
        u = np.sum(off * across, axis=-1) / determinant
        turned = np.cross(off, edge1)
        v = (turned @ direction) / determinant
        place = np.sum(edge2 * turned, axis=-1) / determinant
    return np.compress((u >= 0) & (v >= 0) & (u <= 1 - v) & np.isfinite(place), place)


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


def shape_of(part: Part) -> Shape:
    """Prepare a part."""
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
    return Shape(part, axes, triangle_tree(triangles, labels), labels)


def displaced(one: Shape, other: Shape, of_one: np.ndarray, of_other: np.ndarray) -> Displaced:
    """Compute the displacements of one shape relative to another from those in the world, (poses, 4, 4) each."""
    turn = np.swapaxes(of_one[:, :3, :3], 1, 2)
    rotation = turn @ of_other[:, :3, :3]
    shift = np.einsum("pij,pj->pi", turn, of_other[:, :3, 3] - of_one[:, :3, 3])
    return Displaced(one.axes @ rotation @ other.axes.T, shift @ one.axes.T)


def boxes_along(shape: Shape, transforms: Float[np.ndarray, "poses 4 4"]) -> Float[np.ndarray, "poses 2 3"]:
    """Compute the bounding boxes of a displaced part in world axes."""
    points = np.einsum("pij,nj->pni", transforms[:, :3, :3], shape.part.outermost) + transforms[:, None, :3, 3]
    return np.stack([points.min(axis=1), points.max(axis=1)], axis=1)


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
