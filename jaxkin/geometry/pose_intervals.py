"""Halve a sequence of displacements again and again, and bound how far points move within each interval of it.

What holds at the middle displacement of an interval, with room for how far points move from there, holds at all of its
displacements: most pairs of boxes that are apart at one pose are so at many, and are looked at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.geometry.displaced import Displaced

_REGULAR = 1e-9
"""Share of the mean square change of rotations by which the point that moves least is drawn to the middle of the solid:
along the axis of a rotation every point moves alike."""


@dataclass(frozen=True, eq=False)
class PoseIntervals:
    """Intervals of displacements x -> R x + s of solid 2 relative to solid 1; interval 0 holds all of them.

    With the middle displacement M of an interval, and the point c, for every displacement D of the interval and box 2
    of middle m and half size h, along each axis of tree 1:

        |(D m - M m)| + (|R| - |R_M|) h <= turning (|m - c| + h) + shifting

    and the same for box 1 along the axes of tree 2, displaced by the inverses, about the point M c.
    """

    point: Float[np.ndarray, "3"]
    """c: the point of solid 2 that moves least."""
    middle: Int[np.ndarray, " intervals"]
    """The displacement half-way through each interval; an interval of one displacement is that displacement."""
    children: Int[np.ndarray, "intervals 2"]
    """The two halves; both are the interval itself where it holds one displacement only."""
    begin: Int[np.ndarray, " intervals"]
    """The first displacement of each interval."""
    end: Int[np.ndarray, " intervals"]
    """The one behind its last."""
    turn: Float[np.ndarray, "3 3 intervals"]
    """Rotation of M."""
    shift: Float[np.ndarray, "3 intervals"]
    """Shift of M."""
    place: Float[np.ndarray, "3 intervals"]
    """M c."""
    turning: Float[np.ndarray, "3 3 intervals"]
    """Largest change of each component of the rotation from that of M."""
    shifting: Float[np.ndarray, "3 intervals"]
    """Largest change of D c from M c, along the axes of tree 1."""
    back_shifting: Float[np.ndarray, "3 intervals"]
    """Largest R^T (D c - M c), along the axes of tree 2."""

    @cached_property
    def is_one(self) -> Bool[np.ndarray, " intervals"]:
        """Which intervals hold one displacement only."""
        return self.end - self.begin == 1

    def largest(self, values: Float[np.ndarray, " poses"]) -> Float[np.ndarray, " intervals"]:
        """Find the largest value, one a displacement, in each interval."""
        ranges = np.stack([self.begin, self.end], axis=-1).ravel()
        return np.maximum.reduceat(np.append(values, -np.inf), ranges)[::2]


def pose_intervals(displaced: Displaced, middle: Float[np.ndarray, "3"]) -> PoseIntervals:
    """Halve a sequence of displacements of a solid, whose middle is given, level by level."""
    rotation, shift = displaced
    point = _least_moved(rotation, shift, middle)
    places = rotation @ point + shift
    begin, end = np.array([0]), np.array([len(shift)])
    found, children, total = [], [], 0
    while True:
        half = (begin + end) // 2
        every = np.repeat(half, end - begin)
        turned = np.abs(rotation - rotation[every])
        moved = places - places[every]
        back = np.abs(np.einsum("pij,pi->pj", rotation, moved))
        rows = [np.maximum.reduceat(each, begin) for each in (turned, np.abs(moved), back)]
        found.append((half, begin, end, *rows))
        split = end - begin > 1
        own = np.arange(total, total + len(begin))
        total += len(begin)
        if not split.any():
            children.append(np.stack([own, own], axis=-1))
            break
        # every interval goes on to the next level, those of one displacement as they are
        first = total + np.cumsum(np.where(split, 2, 1)) - np.where(split, 2, 1)
        children.append(np.where(split[:, None], np.stack([first, first + 1], axis=-1), own[:, None]))
        begin, end = (
            np.concatenate([begin[~split], begin[split], half[split]]),
            np.concatenate([end[~split], half[split], end[split]]),
        )
        order = np.argsort(begin)
        begin, end = begin[order], end[order]
    half, begin, end, turning, shifting, back = (np.concatenate(each) for each in zip(*found, strict=True))
    by_row = (rotation[half], shift[half], places[half], turning, shifting, back)
    return PoseIntervals(
        point,
        half,
        np.concatenate(children),
        begin,
        end,
        *(np.ascontiguousarray(np.moveaxis(row, 0, -1)) for row in by_row),
    )


def _least_moved(rotation: np.ndarray, shift: np.ndarray, middle: np.ndarray) -> Float[np.ndarray, "3"]:
    """Find the point whose places are least scattered, by least squares: for a rotation, on its axis."""
    turned, moved = rotation - rotation[0], shift - shift[0]
    square = np.einsum("pij,pik->jk", turned, turned)
    off = np.einsum("pij,pi->j", turned, turned @ middle + moved)
    size = float(np.trace(square))
    return middle if size == 0 else middle - np.linalg.solve(square + _REGULAR * size * np.eye(3), off)
