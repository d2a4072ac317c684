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
    """Intervals of displacements x -> R x + s of solid 2 relative to solid 1, of one pair of solids or of many.

    The first intervals hold all displacements of a pair each. With the middle displacement M of an interval, and the
    point c of its pair, for every displacement D of the interval and box 2 of middle m and half size h, along each axis
    of tree 1:

        |(D m - M m)| + (|R| - |R_M|) h <= turning (|m - c| + h) + shifting

    and the same for box 1 along the axes of tree 2, displaced by the inverses, about the point M c.
    """

    pair: Int[np.ndarray, " intervals"]
    """The pair of solids of each interval."""
    point: Float[np.ndarray, "3 pairs"]
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

    @cached_property
    def alone(self) -> Int[np.ndarray, " poses"]:
        """The interval that holds each displacement alone."""
        (ones,) = np.nonzero(self.is_one)
        return ones[np.argsort(self.begin[ones])]

    def largest(self, values: Float[np.ndarray, " poses"]) -> Float[np.ndarray, " intervals"]:
        """Find the largest value, one a displacement, in each interval."""
        return _largest(values, self.begin, self.end)


def pose_intervals(
    displaced: Displaced, first: Int[np.ndarray, " pairs"], middles: Float[np.ndarray, "pairs 3"]
) -> PoseIntervals:
    """Halve the displacements of each pair of solids, level by level.

    `first` is the first displacement of each pair, one at least a pair, and `middles` are those of solids 2.
    """
    rotation, shift = displaced
    count = len(shift)
    counts = np.diff(first, append=count)
    own = np.repeat(np.arange(len(first)), counts)
    point = _least_moved(rotation, shift, first, own, middles)
    places = np.einsum("pij,pj->pi", rotation, point[own]) + shift
    begin, end = first, first + counts
    every = np.arange(count)  # the displacement half-way through the interval of each one
    found, children, total = [], [], 0
    while len(begin):
        half = (begin + end) // 2
        inside = _spread(begin, end)
        every[inside] = np.repeat(half, end - begin)
        turned, moved = np.zeros_like(rotation), np.zeros_like(shift)
        turned[inside] = np.abs(rotation[inside] - rotation[every[inside]])
        moved[inside] = places[inside] - places[every[inside]]
        back = np.abs(np.einsum("pij,pi->pj", rotation, moved))
        found.append(
            (own[begin], half, begin, end, *(_largest(each, begin, end) for each in (turned, np.abs(moved), back)))
        )
        split = end - begin > 1
        number, total = np.arange(total, total + len(begin)), total + len(begin)
        later = total + np.cumsum(2 * split) - 2 * split
        children.append(np.where(split[:, None], np.stack([later, later + 1], axis=-1), number[:, None]))
        begin, end = (np.stack(pair, axis=-1)[split].ravel() for pair in ((begin, half), (half, end)))
    pair, half, begin, end, turning, shifting, back = (np.concatenate(each) for each in zip(*found, strict=True))
    by_row = (rotation[half], shift[half], places[half], turning, shifting, back)
    return PoseIntervals(
        pair,
        np.ascontiguousarray(point.T),
        half,
        np.concatenate(children),
        begin,
        end,
        *(np.ascontiguousarray(np.moveaxis(row, 0, -1)) for row in by_row),
    )


def _largest(values: np.ndarray, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Find the largest of the values, first axis, of each range."""
    ranges = np.stack([begin, end], axis=-1).ravel()
    return np.maximum.reduceat(np.concatenate([values, values[-1:]]), ranges, axis=0)[::2]


def _spread(begin: np.ndarray, end: np.ndarray) -> Int[np.ndarray, " _"]:
    """List the indices in ranges, one range after the other."""
    counts = end - begin
    return np.arange(counts.sum()) + np.repeat(begin - np.cumsum(counts) + counts, counts)


def _least_moved(
    rotation: np.ndarray, shift: np.ndarray, first: np.ndarray, own: np.ndarray, middles: np.ndarray
) -> Float[np.ndarray, "pairs 3"]:
    """Find for each pair the point whose places are least scattered, by least squares: for a rotation, on its axis."""
    turned, moved = rotation - rotation[first[own]], shift - shift[first[own]]
    off = np.einsum("pij,pi->pj", turned, np.einsum("pij,pj->pi", turned, middles[own]) + moved)
    square = np.add.reduceat(turned.swapaxes(1, 2) @ turned, first)
    size = np.trace(square, axis1=1, axis2=2)[:, None]
    regular = square + np.where(size > 0, _REGULAR * size, 1.0)[:, :, None] * np.eye(3)
    return middles - np.linalg.solve(regular, np.add.reduceat(off, first)[:, :, None])[:, :, 0]
