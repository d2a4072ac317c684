"""Compute with sets of intervals on a line: arrays (k, 2) of the lower and upper ends."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

Intervals = Float[np.ndarray, "_ 2"]
"""Lower and upper end of each interval."""


def union(intervals: Intervals, gap: float) -> Intervals:
    """Unite intervals into disjoint ones in rising order; those no farther apart than `gap` become one."""
    if not len(intervals):
        return intervals
    intervals = intervals[np.argsort(intervals[:, 0], kind="stable")]
    reach = np.maximum.accumulate(intervals[:, 1])
    starts = np.concatenate([[0], np.flatnonzero(intervals[1:, 0] > reach[:-1] + gap) + 1])
    return np.stack([intervals[starts, 0], np.maximum.reduceat(intervals[:, 1], starts)], axis=-1)


def intersection(first: Intervals, second: Intervals) -> Intervals:
    """Intersect two sets of disjoint intervals; common end points alone are left out."""
    lows = np.maximum(first[:, None, 0], second[None, :, 0])
    highs = np.minimum(first[:, None, 1], second[None, :, 1])
    shared = lows < highs
    return union(np.stack([lows[shared], highs[shared]], axis=-1), 0.0)


def length(intervals: Intervals) -> float:
    """Compute the total length of disjoint intervals."""
    return float(np.sum(intervals[:, 1] - intervals[:, 0]))


def centroid(intervals: Intervals) -> float:
    """Compute the centroid of disjoint intervals of non-zero total length."""
    lengths = intervals[:, 1] - intervals[:, 0]
    return float(lengths @ intervals.mean(axis=1) / lengths.sum())
