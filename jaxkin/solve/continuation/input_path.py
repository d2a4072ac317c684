"""Lay a smooth curve through several inputs at all poses, in the order in which the poses are given.

Along a polyline the continuation would have to begin anew at every corner; along a smooth curve one step may pass many
poses. Each input is a piecewise cubic of the length of the polyline. Its slope at a pose is that of the parabola
through three neighbouring poses. If both chords at the pose rise, or both fall, the slope is limited to three times the
slope of either chord, which makes the cubic monotone (Fritsch and Carlson 1980). Where an input turns back, the cubic
overshoots by at most a seventh of the chord.
"""

from __future__ import annotations

from collections.abc import Callable

import jax.numpy as jnp
from jaxtyping import Array, Float

InputPath = Callable[[Float[Array, " fronts"]], tuple[Float[Array, "driven fronts"], Float[Array, "driven fronts"]]]
"""A function from distances along the path to the inputs there, and their derivatives with respect to the distance."""


def curve_through(inputs: Float[Array, "driven poses"]) -> tuple[Float[Array, " poses"], InputPath]:
    """Compute the distance of each pose along the path, and the path, which begins at the assembled pose (inputs zero).

    `inputs` are in radians and characteristic lengths. The distance is the sum of the Euclidean lengths of the chords.
    """
    corners = jnp.concatenate([jnp.zeros_like(inputs[:, :1]), inputs], axis=1)
    change = jnp.diff(corners, axis=1)
    lengths = jnp.sqrt(jnp.sum(change**2, axis=0))
    at = jnp.concatenate([jnp.zeros_like(lengths[:1]), jnp.cumsum(lengths)])
    safe_lengths = jnp.where(lengths > 0, lengths, 1.0)
    slopes = _corner_slopes(change / safe_lengths, lengths)

    def path(here: Float[Array, " fronts"]) -> tuple[Array, Array]:
        number = jnp.clip(jnp.searchsorted(at, here, side="right") - 1, 0, len(lengths) - 1)
        width, rise = safe_lengths[number], change[:, number]
        begin, end = slopes[:, number] * width, slopes[:, number + 1] * width
        t = (here - at[number]) / width
        square, cubic = 3 * rise - 2 * begin - end, begin + end - 2 * rise
        value = corners[:, number] + t * (begin + t * (square + t * cubic))
        return value, (begin + t * (2 * square + 3 * t * cubic)) / width

    return at[1:], path


def _corner_slopes(
    chords: Float[Array, "driven chords"], lengths: Float[Array, " chords"]
) -> Float[Array, "driven corners"]:
    """Compute the slopes of the path at its corners from the slopes of the chords on either side.

    A chord of length zero (a repeated pose) has no slope: that of the chord on the other side is taken.
    """
    length_before, length_after = lengths[:-1], lengths[1:]
    left = jnp.where(length_before > 0, chords[:, :-1], chords[:, 1:])
    right = jnp.where(length_after > 0, chords[:, 1:], chords[:, :-1])
    repeated = length_before + length_after == 0
    parabola = (length_after * left + length_before * right) / jnp.where(repeated, 1.0, length_before + length_after)
    stride = jnp.maximum(jnp.abs(left) * length_before, jnp.abs(right) * length_after)
    # where an input turns back, this limit keeps the overshoot to a fraction of the longer of both chords
    at_turning = stride / jnp.where(repeated, 1.0, jnp.maximum(length_before, length_after))
    monotone = 3 * jnp.minimum(jnp.abs(left), jnp.abs(right))
    limit = jnp.where(left * right > 0, monotone, at_turning)
    inner = jnp.clip(parabola, -limit, limit)
    return jnp.concatenate([chords[:, :1], inner, chords[:, -1:]], axis=1)
