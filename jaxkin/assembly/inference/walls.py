"""Walls: plane faces of two parts that look at each other, which leave slides, and keep from turning."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane

MAX_PLAY = 0.06
"""Play of a part between two faces, over its width there, in all: drawers that people drew have half a
millimetre on each side of 20."""
TOUCHING = 1e-3
"""Overlap of two faces, over the length that they have in common, that is none: rounding of the file, not a fit."""

LEAST_SIDES = 3
"""Sides of a polygon that keeps a hub from turning, at least: one flat, or two, may be beside it by chance."""
MAX_TURN = 0.1
"""Radians by which a hub turns to and fro on a polygon with play in all, at most: 0.1 on each side of a square of 5."""


Looking = tuple[Vector, float, float]
"""A face of a part that looks at another body: see `facing`."""


def between_faces(one: Part, *others: Part) -> list[tuple[Vector, float]]:
    """Find the directions in which a part is between two faces of another one, or of several that are one body: unit
    normals, and the play along them."""
    return [(normal, play) for normal, play, _ in walls(facing(one, others))]


def facing(one: Part, others: Sequence[Part]) -> list[Looking]:
    """Find the faces of a part that look at faces of others: normals, gaps, and where the faces are along them."""
    return [
        (a.surface.normal, gap, float(a.surface.point @ a.surface.normal))
        for a, _, gap in _pairs(one, others)
        if isinstance(a.surface, Plane)
    ]


def walls(found: Sequence[Looking]) -> list[tuple[Vector, float, float]]:
    """Find the walls on both sides among faces that look at each other: normals, plays, and widths between."""
    held: list[tuple[Vector, float, float]] = []
    for k, (normal, gap, place) in enumerate(found):
        for back, other_gap, other_place in found[:k]:
            width = abs(place + other_place)
            if np.linalg.norm(normal + back) < ACROSS and gap + other_gap <= MAX_PLAY * width:
                held.append((normal, gap + other_gap, width))
    return held


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


def is_on_polygon(hub: Part, shaft: Part, point: Vector, axis: Vector) -> bool:
    """Tell whether a hub is on a square, a hexagon or the like of a shaft about an axis: faces along it look at each
    other in three directions or more, the nearest ones as far from the axis, and leave little play to turn."""
    nearest: dict[tuple[float, ...], float] = {}
    for normal, face, *_ in _beside([hub], [shaft], axis):
        away = float((point - face.triangles[0, 0]) @ normal)
        if away > 0:
            direction = tuple(np.round(normal, 2) + 0.0)
            nearest[direction] = min(away, nearest.get(direction, np.inf))
    if len(nearest) < LEAST_SIDES:
        return False
    least, most = min(nearest.values()), max(nearest.values())
    return most - least <= MAX_TURN * most and turns([hub], [shaft], point, axis) <= MAX_TURN


def _beside(ones: Sequence[Part], others: Sequence[Part], axis: Vector) -> list[tuple[Vector, Face, Face, float]]:
    """Find the plane faces along an axis of a body that look at those of another one, with their normals and gaps."""
    first, second = (
        [
            (face.surface.normal, face)
            for part in parts
            for face in part.faces
            if isinstance(face.surface, Plane) and abs(face.surface.normal @ axis) < ACROSS
        ]
        for parts in (ones, others)
    )
    if not first or not second:
        return []
    normals, against = (np.array([normal for normal, _ in faces]) for faces in (first, second))
    facing = np.argwhere(np.linalg.norm(normals[:, None] + against, axis=-1) <= ACROSS)
    pairs = [(*first[i], second[j][1]) for i, j in facing]
    return [(normal, a, b, gap) for normal, a, b in pairs if (gap := _gap(a, b)) is not None]


def _pairs(one: Part, others: Sequence[Part]) -> list[tuple[Face, Face, float]]:
    """Find the plane faces of a part that look at plane faces of others, with the gaps between them."""
    return [(a, b, gap) for a in one.faces for other in others for b in other.faces if (gap := _gap(a, b)) is not None]


def _gap(a: Face, b: Face) -> float | None:
    """Measure the gap between two faces that look at each other; None where they do not, or only beside each other."""
    one, other = a.surface, b.surface
    if not isinstance(one, Plane) or not isinstance(other, Plane) or np.linalg.norm(one.normal + other.normal) > ACROSS:
        return None
    gap = float((other.point - one.point) @ one.normal)
    x = np.cross(one.normal, np.eye(3)[np.argmin(np.abs(one.normal))])
    across = np.column_stack([x, np.cross(one.normal, x)])
    first, second = (face.triangles.reshape(-1, 3) @ across for face in (a, b))
    low, high = np.maximum(first.min(axis=0), second.min(axis=0)), np.minimum(first.max(axis=0), second.max(axis=0))
    touching = TOUCHING * float(np.max(high - low))
    return max(gap, 0.0) if np.all(high > low) and gap >= -touching else None
