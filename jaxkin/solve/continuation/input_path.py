"""The way of several inputs: a smooth curve through all poses in the order in which they are given.

Along a polyline the motion would have to begin anew at every corner; along a curve a step may pass many poses. Each
input is a cubic between any two poses. Its slope at a pose is that of the parabola through three of them, at most three
times that of either chord if both rise or fall: then it is monotone (Fritsch and Carlson 1980). Where an input turns
round it goes on by a seventh of its stride at most.
"""

from __future__ import annotations

from collections.abc import Callable

import jax.numpy as jnp
from jaxtyping import Array, Float

Way = Callable[[Float[Array, " lanes"]], tuple[Float[Array, "driven lanes"], Float[Array, "driven lanes"]]]
"""The inputs so far along the way, and their change from there on per unit of it."""


def curve_through(inputs: Float[Array, "driven poses"]) -> tuple[Float[Array, " poses"], Way]:
    """How far along the way each pose is, from the assembled one, and the way."""
    corners = jnp.concatenate([jnp.zeros_like(inputs[:, :1]), inputs], axis=1)
    change = jnp.diff(corners, axis=1)
    lengths = jnp.sqrt(jnp.sum(change**2, axis=0))
    at = jnp.concatenate([jnp.zeros_like(lengths[:1]), jnp.cumsum(lengths)])
    safe = jnp.where(lengths > 0, lengths, 1.0)
    slopes = _slopes(change / safe, lengths)

    def way(here: Float[Array, " lanes"]) -> tuple[Array, Array]:
        number = jnp.clip(jnp.searchsorted(at, here, side="right") - 1, 0, len(lengths) - 1)
        width, rise = safe[number], change[:, number]
        begin, end = slopes[:, number] * width, slopes[:, number + 1] * width
        t = (here - at[number]) / width
        square, cubic = 3 * rise - 2 * begin - end, begin + end - 2 * rise
        value = corners[:, number] + t * (begin + t * (square + t * cubic))
        return value, (begin + t * (2 * square + 3 * t * cubic)) / width

    return at[1:], way


def _slopes(
    chords: Float[Array, "driven stretches"], lengths: Float[Array, " stretches"]
) -> Float[Array, "driven corners"]:
    """Slopes at the corners, from those of the chords on either side: of stretches of no length there are none."""
    before, behind = lengths[:-1], lengths[1:]
    left = jnp.where(before > 0, chords[:, :-1], chords[:, 1:])
    right = jnp.where(behind > 0, chords[:, 1:], chords[:, :-1])
    still = before + behind == 0
    parabola = (behind * left + before * right) / jnp.where(still, 1.0, before + behind)
    stride = jnp.maximum(jnp.abs(left) * before, jnp.abs(right) * behind)
    turning = stride / jnp.where(still, 1.0, jnp.maximum(before, behind))
    onward = 3 * jnp.minimum(jnp.abs(left), jnp.abs(right))
    most = jnp.where(left * right > 0, onward, turning)
    inner = jnp.clip(parabola, -most, most)
    return jnp.concatenate([chords[:, :1], inner, chords[:, -1:]], axis=1)
