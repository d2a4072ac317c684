"""Report parts that touch only along an edge or at a corner, such as a box on its edge: none of the sixteen states."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from jaxkin._names import listed
from jaxkin.contacts.boxes import Boxes, Pairs, boxes_of, crossing
from jaxkin.geometry.part import Part
from jaxkin.geometry.triangles import Triangles

TINY = np.finfo(float).tiny
"""Smallest denominator: avoids 0 / 0 for degenerate triangles, which tessellations contain."""

_PARALLEL_SQUARE = 1e-12
"""Squared sine of the angle between two edges up to which they count as parallel; then a corner is as near."""

_AT_ONCE = 100_000
"""Number of pairs of triangles compared at once: bounds the memory to a hundred megabytes."""

_MEASURED = 2_000
"""Number of pairs of triangles measured exactly at once: few, since each lot may spare all that are farther apart."""

_ROUNDING = 1e-9
"""Rounding of a lower bound of a distance, over the coordinates that it is computed from: far above that of double
precision, far below any tolerance."""

_FLAT = 1e-9
"""Height of a triangle over its longest side, below which the direction across its plane is rounding."""


def edge_note(one: Part, two: Part, tolerance: float) -> str | None:
    """Name the nearest faces of two parts without a contact in a message, if they touch; None if the parts are apart.

    Faces count as touching where their triangles are no farther apart than `tolerance` (a length) and the lengths by
    which the true surfaces bulge over the triangles.
    """
    sides = (_all_triangles(one), _all_triangles(two))
    found = _nearest(*sides, tolerance)
    if found is None:
        return None
    each = zip((one, two), sides, found, strict=True)
    names = [f"{part.name} {listed(part.faces[side.faces[k]].name.split(', '))}" for part, side, k in each]
    return f"{' and '.join(names)} meet at an edge or a corner only: none of the sixteen contact states, so no joint"


class _Side(NamedTuple):
    """The triangles of a part."""

    triangles: Triangles
    faces: Int[np.ndarray, " triangles"]
    """The index of the face of each triangle."""
    bulges: Float[np.ndarray, " triangles"]
    """By how much the true surface bulges over each triangle, a length."""


def _nearest(one: _Side, two: _Side, tolerance: float) -> tuple[int, int] | None:
    """Find the two triangles that are the nearest to each other less their bulges; None if that is above `tolerance`.

    Pairs are measured in the order of a lower bound of their distance, until all others are farther apart.
    """
    along = _directions(one, two)
    pairs = crossing(_inflated(one, along), _inflated(two, along), tolerance)
    bounds = _least_distances(one.triangles, two.triangles, pairs) - one.bulges[pairs[:, 0]] - two.bulges[pairs[:, 1]]
    near = np.flatnonzero(bounds <= tolerance)
    near = near[np.argsort(bounds[near], kind="stable")]
    best, least = -1, np.inf
    for start in range(0, len(near), _MEASURED):
        some = near[start : start + _MEASURED]
        if bounds[some[0]] > min(least, tolerance):
            break
        i, j = pairs[some].T
        beyond = distances(one.triangles[i], two.triangles[j]) - one.bulges[i] - two.bulges[j]
        if (here := float(beyond.min())) <= least:
            first = int(some[beyond == here].min())  # the first of those that are alike, in the order of the faces
            best, least = first if here < least else min(first, best), here
    return (int(pairs[best, 0]), int(pairs[best, 1])) if least <= tolerance else None


def _least_distances(one: Triangles, two: Triangles, pairs: Pairs) -> Float[np.ndarray, " pairs"]:
    """Compute lower bounds of the distances between pairs of triangles, by their indices in `one` and in `two`.

    Each triangle has a box of its own, along its longest side and across its plane, which a thin triangle fills as it
    does not fill a box along the axes: the other triangle is as far away as its box along these directions.
    """
    frames1, frames2 = _frames(one), _frames(two)
    result = np.empty(len(pairs))
    for start in range(0, len(pairs), _AT_ONCE):
        i, j = pairs[start : start + _AT_ONCE].T
        apart = np.maximum(_apart(one[i], two[j], frames1[i]), _apart(one[i], two[j], frames2[j]))
        result[start : start + _AT_ONCE] = apart
    return result - _ROUNDING * max((float(np.abs(side).max()) for side in (one, two) if len(side)), default=0.0)


def _apart(a: Triangles, b: Triangles, frames: Float[np.ndarray, "pairs 3 3"]) -> Float[np.ndarray, " pairs"]:
    """Compute the distances between the boxes of two triangles along the columns of a frame, pair by pair."""
    (low1, high1), (low2, high2) = _ends(a @ frames), _ends(b @ frames)
    return np.linalg.norm(np.maximum(np.maximum(low2 - high1, low1 - high2), 0.0), axis=-1)


def _ends(corners: Triangles) -> tuple[Float[np.ndarray, "_ 3"], Float[np.ndarray, "_ 3"]]:
    """Find the lowest and the highest coordinates of triangles; by pairs, since reductions over three are slow."""
    first, second, third = corners[:, 0], corners[:, 1], corners[:, 2]
    return np.minimum(np.minimum(first, second), third), np.maximum(np.maximum(first, second), third)


def _frames(triangles: Triangles) -> Float[np.ndarray, "triangles 3 3"]:
    """Find unit vectors along the longest side of each triangle, across that in its plane, and across its plane.

    They are the columns of (triangles, 3, 3); those that a degenerate triangle lacks are zero, and tell no distance.
    """
    edges = np.roll(triangles, -1, axis=1) - triangles
    longest = np.take_along_axis(edges, np.argmax(np.sum(edges**2, axis=-1), axis=1)[:, None, None], axis=1)[:, 0]
    length = np.linalg.norm(longest, axis=-1, keepdims=True)
    along = longest / np.maximum(length, TINY)
    across = np.cross(along, edges[:, 0] + edges[:, 1] / 2)
    height = np.linalg.norm(across, axis=-1, keepdims=True)
    across = np.where(height > _FLAT * length, across / np.maximum(height, TINY), 0.0)
    return np.stack([along, np.cross(across, along), across], axis=-1)


def distances(a: Triangles, b: Triangles) -> Float[np.ndarray, "_"]:
    """Compute the distance between the two triangles of each pair (pairs,), from `a` and `b` (pairs, 3, 3).

    It is the least distance of a corner from the other triangle, or of two crossing edges; so it is not zero for
    triangles that pierce each other.
    """
    return np.min([_corners_to(a, b), _corners_to(b, a), _crossing_edges(a, b)], axis=0)


def _corners_to(a: Triangles, b: Triangles) -> np.ndarray:
    """Compute the distance of the nearest corner of `a` from the triangle `b`, pair by pair."""
    edges = np.roll(b, -1, axis=1) - b
    offset = a[:, :, None] - b[:, None]  # pair, corner of a, edge of b
    along = np.sum(offset * edges[:, None], axis=-1) / np.maximum(np.sum(edges**2, axis=-1), TINY)[:, None]
    to_edges = np.linalg.norm(offset - along.clip(0, 1)[..., None] * edges[:, None], axis=-1).min(axis=-1)
    normal = np.cross(edges[:, 0], edges[:, 1])[:, None]
    over = np.all(np.sum(np.cross(edges[:, None], offset) * normal[:, None], axis=-1) > 0, axis=-1)
    height = np.abs(np.sum(offset[:, :, 0] * normal, axis=-1)) / np.maximum(np.linalg.norm(normal, axis=-1), TINY)
    return np.where(over, height, to_edges).min(axis=-1)


def _crossing_edges(a: Triangles, b: Triangles) -> np.ndarray:
    """Compute the least distance of an edge of `a` and an edge of `b` that cross each other, seen along their common
    normal, pair by pair; infinity where none do."""
    u, v = (np.roll(a, -1, axis=1) - a)[:, :, None], (np.roll(b, -1, axis=1) - b)[:, None]
    w = a[:, :, None] - b[:, None]
    uu, uv, vv, uw, vw = (np.sum(x * y, axis=-1) for x, y in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    square = uu * vv - uv**2
    parallel = square <= _PARALLEL_SQUARE * uu * vv
    square = np.where(parallel, 1.0, square)
    s, t = (uv * vw - vv * uw) / square, (uu * vw - uv * uw) / square
    within = ~parallel & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    apart = np.linalg.norm(w + s[..., None] * u - t[..., None] * v, axis=-1)
    return np.where(within, apart, np.inf).min(axis=(1, 2))


def _all_triangles(part: Part) -> _Side:
    """List the triangles of all faces of a part."""
    numbers = np.repeat(np.arange(len(part.faces)), [len(face.triangles) for face in part.faces])
    bulges = np.array([face.bulge for face in part.faces])
    return _Side(np.concatenate([face.triangles for face in part.faces]), numbers, bulges[numbers])


def _directions(*sides: _Side) -> Float[np.ndarray, "3 3"]:
    """Find three directions, the columns, along which the long sides of triangles lie: their boxes are small there.

    They are the principal axes of the sides, by the squares of their lengths.
    """
    edges = np.concatenate([(side.triangles - np.roll(side.triangles, 1, axis=1)).reshape(-1, 3) for side in sides])
    return np.linalg.eigh(edges.T @ edges)[1]


def _inflated(side: _Side, along: Float[np.ndarray, "3 3"]) -> Boxes:
    """Compute the bounding box of each triangle along some directions, enlarged on all sides by its bulge."""
    return boxes_of(side.triangles @ along) + side.bulges[:, None, None] * np.array([[-1.0], [1.0]])
