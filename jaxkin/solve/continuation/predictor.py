"""Predict the next pose of a branch: by the cubic through the last two poses, their secant, or the tangent.

The cubic, through two poses with their slopes, has an error of the fourth power of the step. The secant leads through
change points, where the tangent is not unique and a start from the last pose itself leaves the branch. The tangent is
for branches of which one pose is known, and for places where a prediction from two poses was refused.
"""

from __future__ import annotations

import jax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.correctors.levenberg_marquardt import select_poses
from jaxkin.solve.system.state import State, difference

SMOOTH = 0.25
"""Distance of a cubic from its chord, over the length of the chord, above which the chord replaces the cubic. At a
change point the tangent is not unique, and the slope computed there may be that of the other branch."""


def predict_state(
    state: State,
    tangent: State,
    before: State,
    before_tangent: State,
    width: Float[Array, " fronts"],
    moved: Float[Array, " fronts"],
    along_tangent: Bool[Array, " fronts"],
) -> State:
    """Extrapolate from `state` by the distance `moved` along the path.

    `before` is the state at a distance `width` back along the path; both tangents are derivatives with respect to that
    distance. Where `along_tangent` holds, `before` is not used. The quaternions of balls are not normalised.
    """
    s = moved / width

    def chord(x: Array, x_before: Array) -> Array:
        return x + s * (x - x_before)

    def cubic(x: Array, d: Array, x_before: Array, d_before: Array) -> Array:
        back, d, d_before = x_before - x, width * d, width * d_before
        return x + s * (d + s * (3 * back + 2 * d + d_before + s * (2 * back + d + d_before)))

    straight = jax.tree.map(chord, state, before)
    curve = jax.tree.map(cubic, state, tangent, before, before_tangent)
    smooth = difference(curve, straight) <= SMOOTH * difference(straight, state)
    linear = jax.tree.map(lambda x, d: x + moved * d, state, tangent)
    return select_poses(along_tangent, linear, select_poses(smooth, curve, straight))


def hermite(
    left: State,
    left_slope: State,
    right: State,
    right_slope: State,
    width: Float[Array, " poses"],
    t: Float[Array, " poses"],
) -> State:
    """Interpolate between two states, a distance `width` apart, at the fraction `t` of it, by a Hermite cubic.

    Slopes are derivatives with respect to the distance. Where the cubic is too far from the chord (`SMOOTH`), the chord
    is taken. The quaternions of balls are not normalised.
    """
    weights = ((1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2 * width, t * t * (3 - 2 * t), t * t * (t - 1) * width)

    def blend(a: Array, slope_a: Array, b: Array, slope_b: Array) -> Array:
        return weights[0] * a + weights[1] * slope_a + weights[2] * b + weights[3] * slope_b

    curve = jax.tree.map(blend, left, left_slope, right, right_slope)
    chord = jax.tree.map(lambda a, b: a + t * (b - a), left, right)
    smooth = difference(curve, chord) <= SMOOTH * difference(left, right)
    return select_poses(smooth, curve, chord)
