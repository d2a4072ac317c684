"""The range of a single input, followed once from the assembled pose to either end at as few knots as are safe.

Whatever lies between two knots is predicted by cubic Hermite interpolation with exact slopes. An angle comes back after
a full turn: a value beyond a gap that is a whole number of turns away from where the motion got without one is that
same pose, and no jump.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure import Geometry
from jaxkin.solve.continuation import SHORTEST_STEP, arrived, start, substep
from jaxkin.solve.correct import choose
from jaxkin.solve.state import State, difference, rate, retract
from jaxkin.solve.status import Status, is_closed
from jaxkin.solve.system import LoopSystem


def _room(poses: int) -> int:
    """Room for the knots to either side of the assembled pose, of which a full turn takes about fifty."""
    return min(max(512, 2 * poses), max(8192, poses // 4), 65536)


BEYOND = 1e-3
"""So far the last knots are extrapolated."""
AT_LIMIT = 2 * SHORTEST_STEP
"""Farther than this from the last knot before a limit nothing closes on the branch that was followed."""


class Knots(NamedTuple):
    """Poses along the range in rising order of the input; both halves start with the assembled pose."""

    at: Float[Array, " knots"]
    state: State
    slope: State
    status: Int[Array, " knots"]
    least: Int[Array, ""]
    """Number of the first knot; those before it and behind the last are empty."""
    most: Int[Array, ""]


class Guess(NamedTuple):
    """Where the search for a pose begins, and what the pose is if the search ends nearby."""

    state: State
    status: Int[Array, " poses"]
    covered: Bool[Array, " poses"]
    """Whether the knots reach as far as the input."""


def follow(system: LoopSystem, geometry: Geometry, values: Float[Array, " poses"]) -> Knots:
    """Knots from the assembled pose to the least and the greatest of the values.

    Where the input is an angle and one end is not reached, the other is extended to a full turn from there: a range of
    a full turn may come back, behind a gap, to poses on the other side of the assembled one.
    """
    room = _room(values.shape[0])
    ends = jnp.stack([jnp.min(values, initial=0.0), jnp.max(values, initial=0.0)])
    turn = jnp.array([2 * jnp.pi, -2 * jnp.pi], values.dtype)
    front = start(system, 2, values.dtype)
    entry = (front.state, front.slope, front.status)
    kept = jax.tree.map(lambda array: jnp.zeros((*array.shape[:-1], 2 * room), array.dtype), entry)
    nowhere = jnp.array([-jnp.inf, jnp.inf], values.dtype)

    def target(limits: Float[Array, "2"]) -> Float[Array, "1 2"]:
        around = (limits + turn)[::-1]
        lowest, highest = jnp.minimum(ends[0], around[0]), jnp.maximum(ends[1], around[1])
        around = jnp.stack([lowest, highest])
        return jnp.where(system.periodic & jnp.isfinite(around), around, ends)[None]

    def running(carry) -> Array:
        front, count, limits, _ = carry
        return jnp.any(~arrived(system, front, target(limits)) & (count < room))

    def step(carry):
        front, count, limits, kept = carry
        front, final = substep(system, geometry, front, target(limits))
        # falling knots to the left of the middle, rising ones to the right; what is out of bounds is dropped
        place = jnp.where(final & (count < room), jnp.array([room - 1, room]) + jnp.array([-1, 1]) * count, 2 * room)
        entry = (front.state, front.slope, front.status)
        kept = jax.tree.map(lambda store, new: store.at[..., place].set(new, mode="drop"), kept, entry)
        ended = front.anchored & (front.status != Status.CLOSED.value) & ~jnp.isfinite(limits)
        return front, count + final, jnp.where(ended, front.state.x[system.driven[0]], limits), kept

    front, count, _, kept = lax.while_loop(running, step, (front, jnp.zeros(2, int), nowhere, kept))
    state, slope, status = kept
    at = state.x[system.driven[0]]
    number, least = jnp.arange(2 * room), room - jnp.minimum(count[0], room)
    most = room - 1 + jnp.minimum(count[1], room)
    at = jnp.where(number < least, -jnp.inf, jnp.where(number > most, jnp.inf, at))
    return Knots(at, state, rate(system, state, slope), status, least, most)


def guess(system: LoopSystem, knots: Knots, values: Float[Array, " poses"]) -> Guess:
    """The poses for these inputs as far as the knots tell; the driven coordinates are not set to the inputs."""
    values = _unturned(knots, values) if system.periodic else values
    left = jnp.clip(jnp.searchsorted(knots.at, values, side="right") - 1, knots.least, knots.most - 1)
    closed = is_closed(knots.status)
    between = closed[left] & (knots.status[left] == knots.status[left + 1])
    # elsewhere there is a limit: up to the inner knot the motion was followed, at the outer one the loops close again
    inner, outer = jnp.where(values >= 0, left, left + 1), jnp.where(values >= 0, left + 1, left)
    at_limit = (jnp.abs(values - knots.at[inner]) <= AT_LIMIT) | ~closed[outer]
    nearest = jnp.where(at_limit, inner, outer)
    trusted = between | ((jnp.abs(values - knots.at[inner]) <= AT_LIMIT) | ~at_limit) & closed[nearest]
    state = choose(between, _hermite(system, knots, left, values), jax.tree.map(lambda x: x[..., nearest], knots.state))
    status = jnp.where(trusted, knots.status[nearest], Status.JUMPED.value)
    return Guess(state, status, (values >= knots.at[knots.least] - BEYOND) & (values <= knots.at[knots.most] + BEYOND))


def _unturned(knots: Knots, values: Float[Array, " poses"]) -> Float[Array, " poses"]:
    """Values less as many full turns as bring them to where the motion got without a gap; others as they are."""
    reached = (knots.status == Status.CLOSED.value) & jnp.isfinite(knots.at)
    least = jnp.min(jnp.where(reached, knots.at, jnp.inf)) - AT_LIMIT
    most = jnp.max(jnp.where(reached, knots.at, -jnp.inf)) + AT_LIMIT
    # an end of the range that was reached is no limit
    least = jnp.where(reached[knots.least], -jnp.inf, least)
    most = jnp.where(reached[knots.most], jnp.inf, most)
    turn = 2 * jnp.pi
    down = values - turn * jnp.ceil(jnp.maximum(values - most, 0.0) / turn)
    back = down + turn * jnp.ceil(jnp.maximum(least - down, 0.0) / turn)
    return jnp.where((back >= least) & (back <= most), back, values)


def _hermite(system: LoopSystem, knots: Knots, left: Int[Array, " poses"], values: Float[Array, " poses"]) -> State:
    """Cubic Hermite interpolation of the knots' states, turns of balls brought back to unit quaternions."""
    width = knots.at[left + 1] - knots.at[left]
    t = (values - knots.at[left]) / jnp.where(width > 0, width, 1.0)
    weights = ((1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2 * width, t * t * (3 - 2 * t), t * t * (t - 1) * width)

    def blend(x: Array, d: Array) -> Array:
        start, end = weights[0] * x[..., left] + weights[1] * d[..., left], weights[2] * x[..., left + 1]
        return start + end + weights[3] * d[..., left + 1]

    curve = jax.tree.map(blend, knots.state, knots.slope)
    first = jax.tree.map(lambda x: x[..., left], knots.state)
    last = jax.tree.map(lambda x: x[..., left + 1], knots.state)
    chord = jax.tree.map(lambda a, b: a + t * (b - a), first, last)
    # at a change point the tangent is not unique and the slope of its knot says nothing: keep to the chord there
    smooth = difference(curve, chord) <= 0.25 * difference(first, last)
    state = choose(smooth, curve, chord)
    return retract(system, state, jnp.zeros_like(state.x))
