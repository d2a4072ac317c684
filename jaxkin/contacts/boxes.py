"""Find the pairs of axis-aligned boxes that overlap or nearly do: the broad phase of contact detection."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.part import Face

Boxes = Float[np.ndarray, "_ 2 d"]
"""Lowest and highest corner of each box, in d dimensions."""
Pairs = Int[np.ndarray, "_ 2"]
"""Indices of the two boxes of each pair."""

_MIXING = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
"""Factors of the integer coordinates of a cell, whose sum is its hash key: large odd numbers without pattern, so that
few cells share a key."""

_MAX_COMPARED = 4_000_000
"""Number of pairs of boxes compared at once: bounds the memory to a few hundred megabytes."""

_LEAST_SIZE = 1e-9
"""Smallest size that a box counts as, relative to the extent of all boxes: a point has size zero, for which
there is no grid."""


def overlapping(boxes: Boxes, margin: float) -> Pairs:
    """Find all pairs i < j of boxes no farther apart than `margin` (a length) along each axis, in rising order.

    There is one grid for each power of two that is the size of some box, rounded up. A box is compared, on the grid of
    its own size, with the boxes of this size or smaller in the same cells, of which each of them covers at most two
    along an axis. So the time is that of sorting and of the pairs found, however the sizes of the boxes differ.
    """
    if len(boxes) < 2:
        return np.zeros((0, 2), int)
    lows, highs = boxes[:, 0] - boxes[:, 0].min(axis=0), boxes[:, 1] - boxes[:, 0].min(axis=0) + margin
    sizes = np.maximum((highs - lows).max(axis=1), _LEAST_SIZE * highs.max())
    levels = np.ceil(np.log2(np.where(sizes > 0, sizes, 1.0))).astype(int)
    found = [np.zeros((0, 2), int)]
    for level in np.unique(levels).tolist():
        own, other = _cells(lows, highs, level, levels == level), _cells(lows, highs, level, levels <= level)
        found.append(_meeting(lows, highs, own, other))
    return np.unique(np.concatenate(found), axis=0)


def _cells(lows: np.ndarray, highs: np.ndarray, level: int, which: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """List the cells of a grid of cell size 2^level that the boxes of the mask `which` lie in.

    Returns the hash keys of the cells, sorted, and for each the index of the box; distant cells may share a key.
    """
    members = np.flatnonzero(which)
    first, last = (np.floor(ends[members] / 2.0**level).astype(np.int64) for ends in (lows, highs))
    d = lows.shape[1]
    corners = np.stack(np.meshgrid(*[[0, 1]] * d, indexing="ij"), axis=-1).reshape(-1, 1, d)
    cells = first + corners
    inside = np.all(cells <= last, axis=-1)
    keys = (cells.astype(np.uint64) * _MIXING[:d]).sum(axis=-1)
    keys, owners = keys[inside], np.broadcast_to(members, inside.shape)[inside]
    order = np.argsort(keys, kind="stable")
    return keys[order], owners[order]


def _meeting(
    lows: np.ndarray, highs: np.ndarray, own: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray]
) -> Pairs:
    """Find the pairs of a box of `own` and a box of `other` that share a cell and overlap.

    `own` and `other` are sorted keys of cells with their boxes, as `_cells` returns them.
    """
    start, stop = (np.searchsorted(own[0], other[0], side=side) for side in ("left", "right"))
    pairs = [np.zeros((0, 2), int)]
    for some in np.array_split(np.arange(len(start)), 1 + (stop - start).sum() // _MAX_COMPARED):
        counts = (stop - start)[some]
        second = np.repeat(other[1][some], counts)
        within = np.arange(len(second)) - np.repeat(np.cumsum(counts) - counts, counts)
        first = own[1][np.repeat(start[some], counts) + within]
        meet = (first != second) & np.all((lows[first] <= highs[second]) & (lows[second] <= highs[first]), axis=-1)
        pairs.append(np.sort(np.stack([first[meet], second[meet]], axis=-1), axis=-1))
    return np.unique(np.concatenate(pairs), axis=0)


def crossing(boxes1: Boxes, boxes2: Boxes, margin: float) -> Pairs:
    """Find all pairs (i, j) of a box of the first set and one of the second no farther apart than `margin` (a length).

    All boxes that reach the bounding box of the other set are compared with each other. That suits the faces of two
    parts and the triangles of two faces, most of which do not reach it.
    """
    inside1 = np.flatnonzero(_reaches(boxes1, boxes2, margin))
    inside2 = np.flatnonzero(_reaches(boxes2, boxes1, margin))
    rows = max(1, _MAX_COMPARED // max(1, len(inside2)))
    found = [np.zeros((0, 2), int)]
    for start in range(0, len(inside1), rows):
        some = inside1[start : start + rows]
        a, b = boxes1[some][:, None], boxes2[inside2][None]
        meet = np.all((a[:, :, 0] <= b[:, :, 1] + margin) & (b[:, :, 0] <= a[:, :, 1] + margin), axis=-1)
        i, j = np.nonzero(meet)
        found.append(np.stack([some[i], inside2[j]], axis=-1))
    return np.concatenate(found)


def face_box(face: Face) -> Float[np.ndarray, "2 3"]:
    """Compute a box around the true surface of a face, which bulges over its triangles."""
    return face.box + np.array([[-face.bulge], [face.bulge]])


def boxes_of(triangles: Float[np.ndarray, "triangles 3 d"]) -> Float[np.ndarray, "triangles 2 d"]:
    """Compute the bounding box of each triangle."""
    return np.stack([triangles.min(axis=1), triangles.max(axis=1)], axis=1)


def _reaches(boxes: Boxes, others: Boxes, margin: float) -> np.ndarray:
    """Mark the boxes that come within `margin` of the bounding box of all `others`."""
    if not len(others):
        return np.zeros(len(boxes), bool)
    low, high = others[:, 0].min(axis=0) - margin, others[:, 1].max(axis=0) + margin
    return np.all((boxes[:, 0] <= high) & (boxes[:, 1] >= low), axis=-1)
