"""Find where a drive force vanishes along a range: single displacements, refined all at once, and intervals."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin._runs import runs

PerPose = Float[np.ndarray, " poses"]

MAX_REFINEMENTS = 60
"""Steps that refine a sign change, at most: halving alone gains a digit in three."""
WITHIN = 1e-12
"""Width of a sign change, or length of a step, over the range, that is small enough; in float32 a unit of rounding."""


def vanishing(
    force: Callable[[PerPose], PerPose],
    vanishes: Callable[[PerPose], Bool[np.ndarray, " poses"]],
    inputs: PerPose,
    forces: PerPose,
    within: float,
) -> tuple[PerPose, Int[np.ndarray, "intervals 2"]]:
    """Find where a force vanishes along a range: in single displacements, rising, and throughout which intervals.

    `forces` are those of the range, zero where they are none but for rounding, as `vanishes` tells of any displacement.
    Displacements are refined to `within` of the range. Intervals are told by the numbers of their first and last pose.
    """
    none = forces == 0.0
    between = none[:-1] & none[1:]  # two equilibria may be neighbours, with forces between them
    if between.any():
        between[between] = vanishes(0.5 * (inputs[:-1] + inputs[1:])[between])
    at_zero = np.flatnonzero(none & ~np.append(between, False) & ~np.append(False, between))
    changing = np.flatnonzero(forces[:-1] * forces[1:] < 0)
    ends = inputs[changing], inputs[changing + 1], forces[changing], forces[changing + 1]
    refined, found = refined_sign_changes(force, *ends, within * np.ptp(inputs))
    # runs of gaps between poses: the index behind the last gap is that of the last pose
    return np.sort(np.concatenate([inputs[at_zero], refined[found]])), runs(between)


def refined_sign_changes(
    force: Callable[[PerPose], PerPose], low: PerPose, high: PerPose, at_low: PerPose, at_high: PerPose, within: float
) -> tuple[PerPose, Bool[np.ndarray, " poses"]]:
    """Refine sign changes, all at once: false position with halved ends (Illinois), halving where that is slow.

    Returns the displacements, and whether the force vanishes there. At a dead point it changes its sign through
    infinity: the ends of the interval, as it narrows, have larger forces, and not smaller ones.
    """
    low, high, at_low, at_high = (each.copy() for each in (low, high, at_low, at_high))
    best, left = np.where(np.abs(at_low) < np.abs(at_high), low, high), np.minimum(np.abs(at_low), np.abs(at_high))
    first = np.abs(at_low) * np.abs(at_high)
    weights = np.ones((2, len(low)))
    for step in range(MAX_REFINEMENTS):
        if not len(low) or np.all((high - low <= within) | (left == 0)):
            break
        one, other = weights[0] * at_low, weights[1] * at_high
        middle = (low * other - high * one) / (other - one)
        middle = np.where((step % 3 == 2) | ~((middle > low) & (middle < high)), (low + high) / 2, middle)
        if step % 3 != 2 and np.all(np.abs(middle - best) <= within):
            break
        here = force(middle)
        better = np.abs(here) < left
        best, left = np.where(better, middle, best), np.where(better, np.abs(here), left)
        below = here * at_low > 0
        weights = np.where(below, [np.ones_like(low), weights[1] / 2], [weights[0] / 2, np.ones_like(low)])
        low, at_low = np.where(below, middle, low), np.where(below, here, at_low)
        high, at_high = np.where(below, high, middle), np.where(below, at_high, here)
    return best, np.abs(at_low) * np.abs(at_high) < first
