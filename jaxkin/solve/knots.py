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
from jaxkin.solve.continuation import SHORTEST_STEP, Front, arrived, start, substep
from jaxkin.solve.correct import choose
from jaxkin.solve.state import State, difference, driven, rate, retract
from jaxkin.solve.status import Status, is_closed
from jaxkin.solve.system import LoopSystem


def _room(poses: int) -> int:
    """Room for the knots to either side of the assembled pose, of which a full turn takes about fifty."""
    return min(max(512, 2 * poses), max(8192, poses // 4), 65536)


BEYOND = 1e-3
"""So far the last knots are extrapolated."""
AT_LIMIT = 2 * SHORTEST_STEP
"""Farther than this from the last knot before a limit nothing closes on the branch that was followed."""


class Knot(NamedTuple):
    """Poses along the range, with their change per unit of the input."""

    at: Float[Array, " knots"]
    state: State
    slope: State
    closed: Bool[Array, " knots"]
    status: Int[Array, " knots"]


class Knots(NamedTuple):
    """Knots in rising order of the input, in the middle the assembled pose."""

    at: Float[Array, " knots"]
    """Values of the input; those before the first knot and behind the last are infinite."""
    table: Float[Array, "entries knots"]
    """All of a knot in one column, so that it is written, and read, at one stroke."""
    first: Int[Array, ""]
    last: Int[Array, ""]


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
    table = jnp.zeros((_column(system, front).shape[0], 2 * room + 2), values.dtype)
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
        front, count, limits, table = carry
        front, final = substep(system, geometry, front, target(limits))
        # falling knots to the left of the middle, rising ones to the right; what is not final is written over
        column = _column(system, front)
        table = lax.dynamic_update_slice(table, column[:, :1], (0, room - count[0]))
        table = lax.dynamic_update_slice(table, column[:, 1:], (0, room + 1 + count[1]))
        ended = front.anchored & (front.status != Status.CLOSED.value) & ~jnp.isfinite(limits)
        limits = jnp.where(ended, driven(system, front.state.x)[0], limits)
        return front, jnp.minimum(count + final, room), limits, table

    _, count, _, table = lax.while_loop(running, step, (front, jnp.zeros(2, int), nowhere, table))
    number, first, last = jnp.arange(2 * room + 2), room + 1 - count[0], room + count[1]
    at = jnp.where(number < first, -jnp.inf, jnp.where(number > last, jnp.inf, table[system.driven[0]]))
    return Knots(at, table, first, last)


def _column(system: LoopSystem, front: Front) -> Float[Array, "entries lanes"]:
    """All numbers of a knot: coordinates, turns of the balls, the slopes of both, and the status."""
    slope = rate(system, front.state, front.slope)
    entries = [part.reshape(-1, part.shape[-1]) for part in (*front.state, *slope)]
    return jnp.concatenate([*entries, front.status[None].astype(front.gap.dtype)])


def _knot(system: LoopSystem, knots: Knots, number: Int[Array, " poses"]) -> Knot:
    """The knots of these numbers, which are within bounds."""
    column = knots.table.at[:, number].get(mode="promise_in_bounds")
    coordinates, balls = system.columns, len(system.balls)
    half = coordinates + 4 * balls
    state, slope = (
        State(part[:coordinates], part[coordinates:half].reshape(balls, 4, number.shape[0]))
        for part in (column, column[half:])
    )
    status = column[-1].astype(jnp.int32)
    return Knot(column[system.driven[0]], state, slope, is_closed(status), status)


def guess(system: LoopSystem, knots: Knots, values: Float[Array, " poses"]) -> Guess:
    """The poses for these inputs as far as the knots tell; the driven coordinates are not set to the inputs."""
    values = _unturned(knots, values) if system.periodic else values
    number = jnp.clip(jnp.searchsorted(knots.at, values, side="right") - 1, knots.first, knots.last - 1)
    left, right = _knot(system, knots, number), _knot(system, knots, number + 1)
    between = left.closed & (left.status == right.status)
    # elsewhere there is a limit: up to the inner knot the motion was followed, at the outer one the loops close again
    rising = values >= 0
    outer_closed = jnp.where(rising, right.closed, left.closed)
    near_inner = jnp.abs(values - jnp.where(rising, left.at, right.at)) <= AT_LIMIT
    at_limit = near_inner | ~outer_closed
    from_left = at_limit == rising
    nearest_closed = jnp.where(from_left, left.closed, right.closed)
    trusted = between | (near_inner | ~at_limit) & nearest_closed
    state = choose(between, _hermite(system, left, right, values), choose(from_left, left.state, right.state))
    status = jnp.where(trusted, jnp.where(from_left, left.status, right.status), Status.JUMPED.value)
    least, most = (knots.at.at[end].get(mode="promise_in_bounds") for end in (knots.first, knots.last))
    return Guess(state, status, (values >= least - BEYOND) & (values <= most + BEYOND))


def _unturned(knots: Knots, values: Float[Array, " poses"]) -> Float[Array, " poses"]:
    """Values less as many full turns as bring them to where the motion got without a gap; others as they are."""
    reached = (knots.table[-1] == Status.CLOSED.value) & jnp.isfinite(knots.at)
    least = jnp.min(jnp.where(reached, knots.at, jnp.inf))
    most = jnp.max(jnp.where(reached, knots.at, -jnp.inf))
    # an end of the range that was reached is no limit
    least = jnp.where(least <= knots.at[knots.first], -jnp.inf, least - AT_LIMIT)
    most = jnp.where(most >= knots.at[knots.last], jnp.inf, most + AT_LIMIT)
    turn = 2 * jnp.pi
    down = values - turn * jnp.ceil(jnp.maximum(values - most, 0.0) / turn)
    back = down + turn * jnp.ceil(jnp.maximum(least - down, 0.0) / turn)
    return jnp.where((back >= least) & (back <= most), back, values)


def _hermite(system: LoopSystem, left: Knot, right: Knot, values: Float[Array, " poses"]) -> State:
    """Cubic Hermite interpolation of the knots' states, turns of balls brought back to unit quaternions."""
    width = right.at - left.at
    t = (values - left.at) / jnp.where(width > 0, width, 1.0)
    weights = ((1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2 * width, t * t * (3 - 2 * t), t * t * (t - 1) * width)

    def blend(a: Array, slope_a: Array, b: Array, slope_b: Array) -> Array:
        return weights[0] * a + weights[1] * slope_a + weights[2] * b + weights[3] * slope_b

    curve = jax.tree.map(blend, left.state, left.slope, right.state, right.slope)
    chord = jax.tree.map(lambda a, b: a + t * (b - a), left.state, right.state)
    # at a change point the tangent is not unique and the slope of its knot says nothing: keep to the chord there
    smooth = difference(curve, chord) <= 0.25 * difference(left.state, right.state)
    state = choose(smooth, curve, chord)
    return retract(system, state, jnp.zeros_like(state.x))
