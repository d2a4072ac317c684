"""Measure the arcs of the rim of a face, which its triangles follow in chords."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.pose import Points
from jaxkin.geometry.triangles import Triangles

Difference = Callable[[Points, Points], np.ndarray]
"""Function (ends, starts) of points (_, 3) that gives the vectors from the starts to the ends, in space (_, 3) or in a
chart of the surface (_, 2)."""

CORNER = 0.7
"""Largest angle, radians, between successive chords of one arc; where a rim turns by more, it has a corner."""


def numbered(corners: Float[np.ndarray, "corners axes"]) -> Int[np.ndarray, " corners"]:
    """Number the corners of triangles, in space or in a plane: those at one place have one number."""
    scale = 1e-7 * float(np.ptp(corners, axis=0).max()) or 1.0  # corners are kept in single precision by most readers
    return np.unique(np.round((corners - corners[0]) / scale), axis=0, return_inverse=True)[1].ravel()


def chord_height(triangles: Triangles, between: Difference) -> float:
    """Estimate by how much the chords along the rim of a face may cut into it: the largest height of an arc, a length.

    An arc of length l that turns by t radians is l t / 8 high over its chord; l is the length of an edge of the rim,
    t the angle between this edge and the next one.
    """
    loops = numbered(triangles.reshape(-1, 3)).reshape(-1, 3)
    edges = np.stack([loops, np.roll(loops, -1, axis=1)], axis=-1).reshape(-1, 2)
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-2).reshape(-1, 2, 3)
    _, position, count = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    rim = position[count == 1]  # edges of one triangle only
    leaving = {int(start): number for number, (start, _) in zip(rim, edges[rim], strict=True)}
    joined = np.array([(number, leaving[end]) for number in rim if (end := int(edges[number, 1])) in leaving])
    if not len(joined):
        return 0.0
    before, after = (between(ends[numbers, 1], ends[numbers, 0]) for numbers in joined.T)
    length, following = np.linalg.norm(before, axis=-1), np.linalg.norm(after, axis=-1)
    before, after = before * following[:, None], after * length[:, None]
    turn = 2 * np.arctan2(np.linalg.norm(after - before, axis=-1), np.linalg.norm(after + before, axis=-1))
    return float(np.max(np.where(turn < CORNER, length * turn / 8, 0.0)))
