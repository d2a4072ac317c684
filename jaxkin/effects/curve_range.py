"""Find the inputs over which a curve is looked at: all of them, or those up to where it begins anew (host code)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.geometry.trig import TURN

MEETS = 1e-10
"""Distance of two points, over the extent of the curve, at which they count as one: rounding of the poses, which is
that of the mechanism, for a curve of a hundredth of its size."""
SAME_SLOPE = 1e-6
"""Difference of two slopes, over the extent of the curve a radian, up to which they count as one: far more than
rounding, far less than between two branches that happen to meet."""
ONE_INPUT = 1e-6
"""Difference of two inputs, over the steps of the motion, up to which they are one: far more than refining leaves, and
far less than two cusps or crossings that steps can tell apart."""


class CurvePoints(NamedTuple):
    """Points of the path of a point, with their derivatives by the input."""

    point: Float[np.ndarray, "inputs 3"]
    slope: Float[np.ndarray, "inputs 3"]
    """First derivative."""
    bend: Float[np.ndarray, "inputs 3"]
    """Second derivative."""
    closed: Bool[np.ndarray, " inputs"]
    """At which inputs the loops close, and there are points."""


Evaluate = Callable[[Float[np.ndarray, " inputs"]], CurvePoints]


class CurveRange(NamedTuple):
    """Rising inputs and their points, from the first input to where the curve ends, or begins anew."""

    inputs: Float[np.ndarray, " poses"]
    points: Float[np.ndarray, "poses 3"]
    repeats: bool
    """Whether the curve begins anew at the last input, whose pose is the first one again."""

    @property
    def step(self) -> float:
        """The largest step of the inputs."""
        return float(np.diff(self.inputs).max())

    def around(self, inputs: np.ndarray, steps: float) -> tuple[np.ndarray, np.ndarray]:
        """Bound inputs that are so many steps from others: within the range, unless the curve repeats."""
        low, high = inputs - steps * self.step, inputs + steps * self.step
        return (low, high) if self.repeats else (np.maximum(low, self.inputs[0]), np.minimum(high, self.inputs[-1]))

    def within(self, inputs: np.ndarray) -> np.ndarray:
        """Bring inputs into the range by whole periods; its end is its beginning, where the curve repeats."""
        if not self.repeats:
            return inputs
        first, last = self.inputs[[0, -1]]
        inputs = first + np.mod(inputs - first, last - first)
        return np.where(last - inputs <= ONE_INPUT * self.step, first, inputs)

    def are_one(self, inputs: Any, others: Any) -> Any:
        """Tell which inputs, within the range, are the same pose."""
        return np.abs(np.subtract(inputs, others)) <= ONE_INPUT * self.step

    def steps_between(self, inputs: Any, others: Any) -> Any:
        """Count the steps from inputs to others, by the shorter way where the curve repeats."""
        numbers = np.arange(len(self.inputs))
        apart = np.abs(np.interp(inputs, self.inputs, numbers) - np.interp(others, self.inputs, numbers))
        return np.minimum(apart, numbers[-1] - apart) if self.repeats else apart


def range_of(
    evaluate: Evaluate, inputs: Float[np.ndarray, " poses"], points: Float[np.ndarray, "poses 3"], extent: float
) -> CurveRange:
    """Find the least number of full turns of the input after which a curve passes itself again, up to its last input.

    `inputs` rise. The range ends there, with the first point again; it is all of the inputs where there are none.
    """
    whole = CurveRange(inputs, points, False)
    least = ONE_INPUT * whole.step
    turns = TURN * np.arange(1, int((inputs[-1] - inputs[0] + least) // TURN) + 1)
    if not len(turns):
        return whole
    start = evaluate(inputs[0] + np.append(0.0, turns))
    same = start.closed & (np.linalg.norm(start.point - start.point[0], axis=1) <= MEETS * extent)
    # a branch may meet the first point by chance, but then in another direction
    same &= np.linalg.norm(start.slope - start.slope[0], axis=1) <= SAME_SLOPE * extent
    for period in turns[same[1:]]:
        later = inputs > inputs[0] + period - least
        before = evaluate(inputs[later] - period)
        if np.all(before.closed & (np.linalg.norm(points[later] - before.point, axis=1) <= MEETS * extent)):
            own = ~later
            return CurveRange(
                np.append(inputs[own], inputs[0] + period), np.concatenate([points[own], points[:1]]), True
            )
    return whole
