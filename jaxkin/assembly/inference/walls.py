"""Walls: plane faces of two parts that look at each other, which leave slides, and keep from turning."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from jaxtyping import Bool, Float

from jaxkin._memory import once_for_each
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.contacts.contact import Contact
from jaxkin.contacts.overlap import Flat, flat, overlap
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Vector, cross, perpendicular, unit
from jaxkin.geometry.surfaces import Plane

MAX_SIDE_PLAY = 0.06
"""Play of a part between two faces, over its width there, in all: drawers that people drew have half a
millimetre on each side of 20."""
TOUCHING = 1e-3
"""Overlap of two faces, over the length that they have in common, that is none: rounding of the file, not a fit."""
NARROW = 1e-5
"""Area of what two faces share, seen along their normals, over the square of its length, that is none: faces which only
meet at an edge do not look at each other."""

LEAST_SIDES = 3
"""Sides of a polygon that keeps a hub from turning, at least: one flat, or two, may be beside it by chance."""
LARGEST, INSIDE = 8, 0.01
"""Triangles of a face of which the middle is looked for on another one, and by what share of these it is inside."""
ALIKE = 0.999
"""Cosine of the angle between two normals of a polygon that are one direction: sides of a polygon of 60 have 0.995."""
MAX_TURN = 0.1
"""Radians by which a hub turns to and fro on a polygon with play in all, at most: 0.1 on each side of a square of 5."""


Looking = tuple[Vector, float, float]
"""A face of a part that looks at another body: see `facing`."""
_Opposed = tuple[Plane, Face, Face, float]
"""Two faces that look at each other: the plane of the first one, both faces, and the gap between them."""


def between_faces(one: Part, *others: Part) -> list[tuple[Vector, float]]:
    """Find the directions in which a part is between two faces of another one, or of several that are one body: unit
    normals, and the play along them."""
    return [(normal, play) for normal, play, _ in walls(facing(one, others))]


def facing(one: Part, others: Sequence[Part]) -> list[Looking]:
    """Find the faces of a part that look at faces of others: normals, gaps, and where the faces are along them."""
    found = (each for other in others for each in _opposed_faces(one, other))
    return [(plane.normal, gap, float(plane.point @ plane.normal)) for plane, _, _, gap in found]


def walls(found: Sequence[Looking]) -> list[tuple[Vector, float, float]]:
    """Find the walls on both sides among faces that look at each other: normals, plays, and widths between."""
    if not found:
        return []
    normals, gaps, places = (np.array(each) for each in zip(*found, strict=True))
    plays, widths = gaps[:, None] + gaps, np.abs(places[:, None] + places)
    both = np.argwhere(np.tril(_are_opposite(normals, normals) & (plays <= MAX_SIDE_PLAY * widths), -1))
    return [(found[i][0], float(plays[i, j]), float(widths[i, j])) for i, j in both.tolist()]


def slot_normals(contacts: Sequence[Contact], part: str) -> Float[np.ndarray, "walls 3"]:
    """Find the unit normals of faces of a part that lie on walls of another one on both sides, as those of a block in a
    slot do, by all contacts of the two parts."""
    surfaces = [each.surfaces[each.parts.index(part)] for each in contacts if each.contact_state.is_flat]
    planes = [surface for surface in surfaces if isinstance(surface, Plane)]
    normals = np.array([plane.normal for plane in planes]).reshape(-1, 3)
    points = np.array([plane.point for plane in planes]).reshape(-1, 3)
    heights = normals @ points.T
    outwards = np.diagonal(heights)[:, None] > heights  # the second face lies behind the first
    return normals[(_are_opposite(normals, normals) & outwards).any(axis=1)]


def turns(ones: Sequence[Part], others: Sequence[Part], point: Vector, axis: Vector) -> float:
    """Measure the angle by which a body can turn about an axis in all, to and fro, until faces along the axis meet.

    A face of the body that looks at one of the other body at a gap g, and reaches from t1 to t2 beside the axis, along
    axis x normal, meets it after g / -t1 one way and g / t2 the other way.
    """
    room = [np.inf, np.inf]
    for normal, a, b, gap in _beside(ones, others, axis):
        along = np.cross(axis, normal)
        first, second = ((face.triangles.reshape(-1, 3) - point) @ along for face in (a, b))
        low, high = max(first.min(), second.min()), min(first.max(), second.max())
        room = [min(most, gap / arm) if arm > 0 else most for most, arm in zip(room, (-low, high), strict=True)]
    return float(sum(room))


def is_on_polygon(hub: Part, shaft: Part, point: Vector, axis: Vector, turn: float = MAX_TURN) -> bool:
    """Tell whether a hub is on a square, a hexagon or the like of a shaft about an axis: faces along it look at each
    other in three directions or more, the nearest ones as far from the axis, and leave it a play of up to `turn`
    radians."""
    nearest: list[tuple[Vector, float]] = []
    for normal, face, *_ in _beside([hub], [shaft], axis):
        away = float((point - face.triangles[0, 0]) @ normal)
        if away > 0:
            same = next((k for k, (each, _) in enumerate(nearest) if normal @ each > ALIKE), None)
            if same is None:
                nearest.append((normal, away))
            else:
                nearest[same] = nearest[same][0], min(away, nearest[same][1])
    if len(nearest) < LEAST_SIDES:
        return False
    least, most = min(away for _, away in nearest), max(away for _, away in nearest)
    return most - least <= MAX_TURN * most and turns([hub], [shaft], point, axis) <= turn


def lengths_beside(hub: Part, shaft: Part, axis: Vector) -> tuple[float, float]:
    """Measure how long the faces along an axis are that a hub and its shaft have beside each other: of each part."""
    found = _beside([hub], [shaft], axis)
    faces = [a for _, a, _, _ in found], [b for _, _, b, _ in found]
    ends = [np.concatenate([face.triangles.reshape(-1, 3) for face in some]) @ axis for some in faces]
    return float(np.ptp(ends[0])), float(np.ptp(ends[1]))


def _beside(ones: Sequence[Part], others: Sequence[Part], axis: Vector) -> list[tuple[Vector, Face, Face, float]]:
    """Find the plane faces along an axis of a body that look at those of another one, with their normals and gaps."""
    found = (each for one in ones for other in others for each in _opposed_faces(one, other))
    return [(plane.normal, a, b, gap) for plane, a, b, gap in found if abs(plane.normal @ axis) < ACROSS]


def _opposed_faces(one: Part, other: Part) -> list[_Opposed]:
    """Find the plane faces of two parts that look at each other, once for many rules and mechanisms that are tried."""
    kept = _opposed_to(one)
    if other not in kept:
        kept[other] = _opposed(_planes(one), _planes(other))
    return kept[other]


@once_for_each
def _opposed_to(one: Part) -> WeakKeyDictionary[Part, list[_Opposed]]:
    """Keep what was found for a part and each other one."""
    return WeakKeyDictionary()


class _Planes(NamedTuple):
    """The plane faces of a part."""

    planes: list[Plane]
    faces: list[Face]
    normals: Float[np.ndarray, "faces 3"]
    axes: Float[np.ndarray, "faces 2 3"]
    """Directions in each plane, the first along a side of the face."""
    outlines: list[_Outline]
    """Each face along its axes, from the point of its plane."""
    middles: Float[np.ndarray, "faces 3"]
    halves: Float[np.ndarray, "faces 3"]
    """Of the box of each face: its middle, and half its sides."""


@once_for_each
def _planes(part: Part) -> _Planes:
    """Collect the plane faces of a part."""
    planes, faces, axes, outlines = [], [], [], []
    for face in part.faces:
        if isinstance(plane := face.surface, Plane):
            x = _along_a_side(plane, face)
            axes.append((x, cross(plane.normal, x)))
            outlines.append(_Outline.of(flat(face.triangles, plane.point, *axes[-1])))
            planes.append(plane)
            faces.append(face)
    boxes = np.array([face.box for face in faces]).reshape(-1, 2, 3)
    normals = np.array([plane.normal for plane in planes]).reshape(-1, 3)
    axes = np.array(axes).reshape(-1, 2, 3)
    return _Planes(planes, faces, normals, axes, outlines, boxes.mean(axis=1), np.ptp(boxes, axis=1) / 2)


def _opposed(ones: _Planes, others: _Planes) -> list[_Opposed]:
    """Find the plane faces that look at each other.

    Faces that are only beside each other along the normal of the first do not.
    """
    found = []
    opposite = _are_opposite(ones.normals, others.normals)
    for k in np.flatnonzero(opposite.any(axis=1)).tolist():
        plane, axes, own = ones.planes[k], ones.axes[k], ones.outlines[k]
        # most share nothing, which their boxes tell
        middles, reaches = (others.middles - plane.point) @ axes.T, others.halves @ np.abs(axes).T
        beside = np.all((middles - reaches < own.high) & (middles + reaches > own.low), axis=1)
        for j in np.flatnonzero(opposite[k] & beside).tolist():
            gap = float((others.planes[j].point - plane.point) @ plane.normal)
            if gap < -TOUCHING * own.longest:
                continue
            face = others.faces[j]
            width = own.shared_width(_Outline.of(flat(face.triangles, plane.point, *axes)))
            if width is not None and gap >= -TOUCHING * width:
                found.append((plane, ones.faces[k], face, max(gap, 0.0)))
    return found


def _are_opposite(
    ones: Float[np.ndarray, "ones 3"], others: Float[np.ndarray, "others 3"]
) -> Bool[np.ndarray, "ones others"]:
    """Tell which unit normals are opposite, to `ACROSS` radians: |a + b|^2 = 2 + 2 a.b."""
    return ones @ others.T <= ACROSS**2 / 2 - 1


def _along_a_side(plane: Plane, face: Face) -> Vector:
    """Choose a direction in a plane face that turns with it: the shortest side of one of its triangles, which is along
    a side of a rectangle."""
    sides = np.roll(face.triangles[0], -1, axis=0) - face.triangles[0]
    squares = np.sum(sides**2, axis=1)
    if not squares.all():  # a triangle without an area
        return perpendicular(plane.normal)
    return unit(sides[np.argmin(squares)])


class _Outline(NamedTuple):
    """A plane face in coordinates of a plane."""

    triangles: Flat
    areas: Float[np.ndarray, " triangles"]
    """Twice the areas of its triangles, less than zero of those that are turned clockwise."""
    low: Float[np.ndarray, "2"]
    high: Float[np.ndarray, "2"]

    @staticmethod
    def of(triangles: Flat) -> _Outline:
        """Measure a face."""
        corners = triangles.reshape(-1, 2)
        sides = triangles[:, 1:] - triangles[:, :1]
        areas = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
        return _Outline(triangles, areas, corners.min(axis=0), corners.max(axis=0))

    @property
    def longest(self) -> float:
        """The longer side of its box."""
        return float(np.max(self.high - self.low))

    @property
    def is_box(self) -> bool:
        """Whether the face is a rectangle along the axes, as most are."""
        return bool(np.abs(self.areas).sum() / 2 >= (1 - NARROW) * np.prod(self.high - self.low))

    def shared_width(self, other: _Outline) -> float | None:
        """Measure the diagonal of what the boxes of two faces share; None where the faces share nothing but an edge."""
        low, high = np.maximum(self.low, other.low), np.minimum(self.high, other.high)
        if np.any(high <= low):
            return None
        width = float(np.linalg.norm(high - low))
        if self.is_box and other.is_box:
            area = float(np.prod(high - low))
        elif self._covers_middles(other) or other._covers_middles(self):
            return width
        else:
            shared = overlap(self.triangles, other.triangles, 0.0)
            area = 0.0 if shared is None else shared.area
        return width if area > NARROW * width**2 else None

    def _covers_middles(self, other: _Outline) -> bool:
        """Tell whether it covers the middle of one of the largest triangles of another face: a tenth of the time of
        what they share."""
        largest = np.argpartition(-np.abs(other.areas), min(LARGEST, len(other.areas)) - 1)[:LARGEST]
        middles = other.triangles[largest].mean(axis=1)
        starts = self.triangles[None]
        edges, offset = np.roll(starts, -1, axis=2) - starts, middles[:, None, None] - starts
        turns = edges[..., 0] * offset[..., 1] - edges[..., 1] * offset[..., 0]
        least = INSIDE * np.abs(self.areas)[:, None]
        return bool((np.all(turns > least, axis=-1) | np.all(turns < -least, axis=-1)).any())
