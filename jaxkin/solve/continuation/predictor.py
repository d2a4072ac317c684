"""Predict the next pose of a branch: by a curve through the last poses, their secant, or the tangent.

The curve follows the slopes of the last three poses (Adams-Bashforth), and errs by the fourth power of the step. Where
no correction brings back an error, as of the idle spin of a rod between two balls, or of a spring that no motor drives,
a cubic through two poses would make that error five times as large in each step of equal length. The secant leads
through change points, where the tangent is not unique and a start from the last pose itself leaves the branch. The
tangent is for branches of which one pose is known, and for places where a prediction from two poses was refused.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.system.state import State, difference, select_poses

SMOOTH = 0.25
"""Distance of a curve from its chord, over the length of the chord, above which the chord replaces the curve. At a
change point the tangent is not unique, and the slope computed there may be that of the other branch. Where the slopes
agree with the last chord (`AGREEMENT`), the next step follows the curve all the same."""
AGREEMENT = 0.2
"""Largest distance of the chord of the last step from the mean of the slopes at its ends, over the length of the chord,
up to which both slopes count as those of the branch. A path of several inputs turns within a few steps: there the curve
leads far from the chord, and the chord is wrong. A closed curve of a platform on six legs takes 35 steps with 0.2, 38
with 0.1, 48 with 0.05, and 76 without this test. Once such a curve was refused, the chord is tried: beside a change
point rounding may be in both slopes, as in those of a parallelogram in float32."""


class History(NamedTuple):
    """The poses of the branch before the last one; slopes are derivatives by the distance along the path."""

    state: State
    """The state one accepted step back."""
    tangent: State
    """Its slope."""
    width: Float[Array, " fronts"]
    """Distance along the path, with its sign, from that state to the last one."""
    earlier_tangent: State
    """Slope of the state two accepted steps back."""
    earlier_width: Float[Array, " fronts"]
    """Distance, with its sign, from that state to `state`; infinite if it is no pose of the branch."""


def predict_state(
    state: State,
    tangent: State,
    history: History,
    moved: Float[Array, " fronts"],
    along_tangent: Bool[Array, " fronts"],
    may_bend: Bool[Array, " fronts"],
) -> tuple[State, Bool[Array, " fronts"]]:
    """Extrapolate from `state` and its slope `tangent` by the distance `moved` along the path.

    Where `along_tangent` holds, `history` is not used. The quaternions of balls are not normalised. Returns also which
    fronts follow a curve that is far from its chord, as only those of `may_bend` do.
    """
    before, before_tangent, width, earlier_tangent, earlier_width = history
    s = moved / width

    def chord(x: Array, x_before: Array) -> Array:
        return x + s * (x - x_before)

    def integral(x: Array, d: Array, d_before: Array, d_earlier: Array) -> Array:
        second = (d - d_before) / width
        third = (second - (d_before - d_earlier) / earlier_width) / (width + earlier_width)
        return x + moved * (d + moved * (second / 2 + third * (moved / 3 + width / 2)))

    straight = jax.tree.map(chord, state, before)
    curve = jax.tree.map(integral, state, tangent, before_tangent, earlier_tangent)
    smooth = difference(curve, straight) <= SMOOTH * difference(straight, state)
    agree = may_bend & _agree(before, before_tangent, state, tangent, width)
    linear = jax.tree.map(lambda x, d: x + moved * d, state, tangent)
    predicted = select_poses(along_tangent, linear, select_poses(smooth | agree, curve, straight))
    return predicted, agree & ~smooth & ~along_tangent


def hermite(
    left: State,
    left_slope: State,
    right: State,
    right_slope: State,
    width: Float[Array, " poses"],
    t: Float[Array, " poses"],
) -> State:
    """Interpolate between two states, a distance `width` apart, at the fraction `t` of it, by a Hermite cubic.

    Slopes are derivatives with respect to the distance. Where the cubic is too far from the chord (`SMOOTH`) and the
    slopes are not those of the chord (`AGREEMENT`), the chord is taken. The quaternions of balls are not normalised.
    """
    curve = jax.tree.map(partial(_cubic, width, t), left, left_slope, right, right_slope)
    chord = jax.tree.map(lambda a, b: a + t * (b - a), left, right)
    smooth = difference(curve, chord) <= SMOOTH * difference(left, right)
    return select_poses(smooth | _agree(left, left_slope, right, right_slope, width), curve, chord)


def interpolable(
    left: State, left_slope: State, right: State, right_slope: State, width: Float[Array, " fronts"]
) -> Bool[Array, " fronts"]:
    """Tell whether poses between two states, whose arguments are those of `hermite`, follow its cubic everywhere."""

    def smooth(t: float) -> Bool[Array, " fronts"]:
        curve = jax.tree.map(partial(_cubic, width, t), left, left_slope, right, right_slope)
        chord = jax.tree.map(lambda a, b: a + t * (b - a), left, right)
        return difference(curve, chord) <= SMOOTH * difference(left, right)

    # a cubic is farthest from its chord between a quarter and three quarters, or at two places if it crosses it
    return smooth(0.25) & smooth(0.5) & smooth(0.75) | _agree(left, left_slope, right, right_slope, width)


def _cubic(width: Array, t: Array | float, a: Array, slope_a: Array, b: Array, slope_b: Array) -> Array:
    """Compute the Hermite cubic between two arrays of coordinates at the fraction `t` of the distance `width`."""
    weights = ((1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2 * width, t * t * (3 - 2 * t), t * t * (t - 1) * width)
    return weights[0] * a + weights[1] * slope_a + weights[2] * b + weights[3] * slope_b


def _agree(left: State, left_slope: State, right: State, right_slope: State, width: Array) -> Bool[Array, " poses"]:
    """Tell whether the chord between two states follows the mean of the slopes at its ends (`AGREEMENT`)."""
    by_slopes = jax.tree.map(lambda b, d, e: b - width * (d + e) / 2, right, left_slope, right_slope)
    return difference(by_slopes, left) <= AGREEMENT * difference(right, left)
