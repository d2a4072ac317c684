"""Find the inputs over which a curve is looked at: all of them, or those up to where it begins anew (host code)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.geometry.trig import TURN


class CurvePrecision(NamedTuple):
    """What of a curve counts as zero, in the precision of its poses."""

    rests: float
    """Extent of a curve, over the largest coordinate of its points and the joints, up to which the point rests: far
    above the rounding of a pose, and no curve whose cusps or crossings could be told from it."""
    flat: float
    """Extent of a curve across its plane, over that along it, up to which it counts as plane."""
    meets: float
    """Distance of two points, over the extent of the curve, at which they count as one: rounding of the poses, which is
    that of the mechanism, for a curve that is much smaller."""
    same_slope: float
    """Difference of two slopes, over the extent of the curve a radian, up to which they count as one: far more than
    rounding, far less than between two branches that happen to meet."""
    one_input: float
    """Difference of two inputs, over the steps of the motion, up to which they are one: far more than refining leaves,
    and far less than two cusps or crossings that steps can tell apart."""
    stands_still: float
    """Speed of the point, over its largest one, at which it counts as standing still: a hundred times the rounding of a
    pose over the steps of the drive, and far below what a curve without a cusp shows."""
    touches: float
    """What the cosine between two tangents lacks of 1, up to which the curve touches itself, or passes a pose again,
    and does not cross: an angle as exact as tangents at refined places are, 1e-6 or 1e-3 in single precision."""


DOUBLE = CurvePrecision(
    rests=1e-10, flat=1e-9, meets=1e-10, same_slope=1e-6, one_input=1e-6, stands_still=1e-9, touches=1e-12
)
SINGLE = CurvePrecision(
    rests=1e-5, flat=1e-5, meets=1e-5, same_slope=1e-4, one_input=1e-2, stands_still=1e-5, touches=1e-6
)
"""Loops close to 5e-7 of the size in float32, and inputs of some radians are rounded to as much: of 20 random cusps the
speeds that were left were up to 2e-6."""


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
    precision: CurvePrecision = DOUBLE

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
        return np.where(last - inputs <= self.precision.one_input * self.step, first, inputs)

    def are_one(self, inputs: Any, others: Any) -> Any:
        """Tell which inputs, within the range, are the same pose."""
        return np.abs(np.subtract(inputs, others)) <= self.precision.one_input * self.step

    def steps_between(self, inputs: Any, others: Any) -> Any:
        """Count the steps from inputs to others, by the shorter way where the curve repeats."""
        numbers = np.arange(len(self.inputs))
        apart = np.abs(np.interp(inputs, self.inputs, numbers) - np.interp(others, self.inputs, numbers))
        return np.minimum(apart, numbers[-1] - apart) if self.repeats else apart


def range_of(
    evaluate: Evaluate,
    inputs: Float[np.ndarray, " poses"],
    points: Float[np.ndarray, "poses 3"],
    extent: float,
    precision: CurvePrecision = DOUBLE,
) -> CurveRange:
    """Find the least number of full turns of the input after which a curve passes itself again, up to its last input.

    `inputs` rise. The range ends there, with the first point again; it is all of the inputs where there are none.
    """
    whole = CurveRange(inputs, points, False, precision)
    least = precision.one_input * whole.step
    turns = TURN * np.arange(1, int((inputs[-1] - inputs[0] + least) // TURN) + 1)
    if not len(turns):
        return whole
    start = evaluate(inputs[0] + np.append(0.0, turns))
    same = start.closed & (np.linalg.norm(start.point - start.point[0], axis=1) <= precision.meets * extent)
    # a branch may meet the first point by chance, but then in another direction
    same &= np.linalg.norm(start.slope - start.slope[0], axis=1) <= precision.same_slope * extent
    for period in turns[same[1:]]:
        later = inputs > inputs[0] + period - least
        before = evaluate(inputs[later] - period)
        if np.all(before.closed & (np.linalg.norm(points[later] - before.point, axis=1) <= precision.meets * extent)):
            own = ~later
            return CurveRange(
                np.append(inputs[own], inputs[0] + period), np.concatenate([points[own], points[:1]]), True, precision
            )
    return whole
