"""The way through all inputs, followed once from the assembled pose to either end at as few knots as are safe.

Whatever lies between two knots is predicted by cubic Hermite interpolation with exact slopes. An angle comes back after
a full turn: where the mechanism does so too, which shows where the ways forwards and backwards meet, one turn is all
that is followed; and a value beyond a gap that is a whole number of turns away from where the motion got without one is
that same pose, and no jump.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closure.closure import Geometry
from jaxkin.solve.closure.joint_coordinates import ball_turns
from jaxkin.solve.continuation.input_path import Way
from jaxkin.solve.continuation.step import AT_LIMIT, Front, arrived, given_up, start, substep
from jaxkin.solve.correctors.levenberg_marquardt import choose
from jaxkin.solve.execution.lockstep import any_lane, write_row
from jaxkin.solve.linear.least_norm import placed
from jaxkin.solve.status import Status, is_closed
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, difference, rate, retract, turning

ROOM, MOST_POSES, ONE_INPUT, SEVERAL_INPUTS = 1024, 1024, 2, 12
"""Steps to either side of the assembled pose: at least so many, and some a pose for so many poses. What they do not
reach is STALLED. A full turn takes some twenty-five, and some fifty for each of its limits, several inputs in any order
some eight a pose."""
IMPATIENT = 48
"""Steps after which the impatient leave a range: nine of ten that have no limit take no more."""
BEYOND = 1e-3
"""So far the last knots are extrapolated."""
SAME = 1e-9
"""Coordinates that differ by less where the two ways meet are the same (1e-4 in float32)."""
MEETING = (3.0 - TURN, 3.0)
"""Where the ways backwards and forwards meet: a full turn apart, and half a turn from the assembled pose, but where no
designer puts a change point."""


class Knot(NamedTuple):
    """Poses along the range, with their change per unit of the input."""

    at: Float[Array, " knots"]
    state: State
    slope: State
    status: Int[Array, " knots"]


class Knots(NamedTuple):
    """Knots in rising order of the input, in the middle the assembled pose."""

    at: Float[Array, " knots"]
    """Values of the input; those before the first knot and behind the last are infinite."""
    table: Float[Array, "knots entries"]
    """All of a knot in one row, so that it is written, and read, at one stroke."""
    first: Int[Array, ""]
    last: Int[Array, ""]
    repeats: Bool[Array, ""]
    """Whether after a full turn the mechanism is where it began."""
    winding: Float[Array, " columns"]
    """By how much its coordinates are then larger."""
    whole: Bool[Array, ""]
    """Whether the whole range was followed, and has no limit."""


class Guess(NamedTuple):
    """Where the search for a pose begins, and what the pose is if the search ends nearby."""

    state: State
    status: Int[Array, " poses"]
    covered: Bool[Array, " poses"]
    """Whether the knots reach as far as the input."""


def follow(
    system: LoopSystem,
    geometry: Geometry,
    way: Way,
    values: Float[Array, " poses"],
    patient: Bool[Array, ""] | bool = True,
) -> Knots:
    """Knots from the assembled pose to the least and the greatest of the values, which say how far along the way.

    Where the input is an angle and one end is not reached, the other is extended to a full turn from there: a range of
    a full turn may come back, behind a gap, to poses on the other side of the assembled one. Who is not patient ends
    at limits, and after a few steps.
    """
    dtype, each = values.dtype, ONE_INPUT if len(system.driven) == 1 else SEVERAL_INPUTS
    room = max(ROOM, each * min(values.shape[0], MOST_POSES))
    ends = jnp.stack([jnp.min(values, initial=0.0), jnp.max(values, initial=0.0)])
    turn, meeting = jnp.array([-TURN, TURN], dtype), jnp.array(MEETING, dtype)
    beyond = (ends[0] < meeting[0]) | (ends[1] > meeting[1])
    front = start(system, 2, dtype)
    table = jnp.zeros((2 * room + 2, _row(system, front).shape[1]), dtype)
    nowhere, no = jnp.array([-jnp.inf, jnp.inf], dtype), jnp.asarray(False)

    def target(front: Front, limits: Float[Array, "2"], parted: Array) -> Float[Array, "2"]:
        if not system.periodic:
            return ends
        around = (limits - turn)[::-1]
        outer = jnp.where(jnp.isfinite(around), around, ends)
        wider = jnp.stack([jnp.minimum(ends[0], outer[0]), jnp.maximum(ends[1], outer[1])])
        goal = jnp.where(beyond & ~parted & ~jnp.any(jnp.isfinite(limits)), meeting, wider)
        return jnp.stack([jnp.minimum(goal[0], front.at[0]), jnp.maximum(goal[1], front.at[1])])  # nobody turns back

    def running(carry) -> Array:
        front, count, limits, parted, _ = carry
        most = jnp.where(patient, room, IMPATIENT)
        return (count < most) & any_lane(~arrived(front, target(front, limits, parted)) & ~given_up(front, patient))

    def step(carry):
        front, count, limits, parted, table = carry
        front = substep(system, geometry, way, front, target(front, limits, parted), patient)
        # falling knots before the middle, rising ones behind it; after a step that was refused the same knot again,
        # so that all lanes, those of other designs too, write at one place
        row = _row(system, front)
        table = write_row(write_row(table, row[0], room - count), row[1], room + 1 + count)
        ended = front.anchored & (front.status != Status.CLOSED.value) & ~jnp.isfinite(limits)
        if system.periodic:
            there = jnp.all(front.at == meeting)
            apart = lax.cond(any_lane(there), lambda: ~_same(system, geometry, front.state), lambda: no)
            parted |= there & apart
        return front, count + 1, jnp.where(ended, front.at, limits), parted, table

    front, count, limits, parted, table = lax.while_loop(running, step, (front, jnp.asarray(0), nowhere, no, table))
    number, first, last = jnp.arange(2 * room + 2), room + 1 - count, room + count
    at = jnp.where(number < first, -jnp.inf, jnp.where(number > last, jnp.inf, table[:, 0]))
    whole = jnp.all(arrived(front, target(front, limits, parted)) & ~jnp.isfinite(limits))
    repeats = ~parted & jnp.all(front.at == meeting) & ~jnp.any(jnp.isfinite(limits)) & system.periodic
    return Knots(at, table, first, last, repeats, _winding(system, front.state), whole)


def _winding(system: LoopSystem, state: State) -> Float[Array, " columns"]:
    """The full turns in the coordinates between the two lanes."""
    return jnp.where(np.array(system.is_length), 0.0, TURN * jnp.round((state.x[:, 1] - state.x[:, 0]) / TURN))


def _same(system: LoopSystem, geometry: Geometry, state: State) -> Bool[Array, ""]:
    """Whether the two lanes are in one pose, but for full turns, and for spins of rods."""
    same = SAME if jnp.finfo(state.x.dtype).bits == 64 else 1e-4
    rest = jnp.max(jnp.abs(state.x[:, 1] - state.x[:, 0] - _winding(system, state)))
    for turn in ball_turns(system, geometry, state).values():
        rest = jnp.maximum(rest, jnp.max(jnp.abs(turn[..., 1] - turn[..., 0])))
    return rest <= same


def _row(system: LoopSystem, front: Front) -> Float[Array, "lanes entries"]:
    """All numbers of a knot: where it is, coordinates, turns of the balls, the slopes of both, and the status."""
    slope = rate(system, front.state, front.slope)
    which = _coordinates(system)
    states = [part for x, turns in (front.state, slope) for part in (x[which], turns)]
    entries = [part.reshape(-1, part.shape[-1]) for part in (front.at, *states)]
    return jnp.concatenate([*entries, front.status[None].astype(front.gap.dtype)]).T


def _coordinates(system: LoopSystem) -> np.ndarray:
    """The columns that hold something: those of balls that turn as unknowns do not, and may be many."""
    return np.flatnonzero(~turning(system))


def _knot(system: LoopSystem, knots: Knots, number: Int[Array, " poses"]) -> Knot:
    """The knots of these numbers, which are within bounds."""
    at, column = jnp.split(knots.table.at[number].get(mode="promise_in_bounds").T, [1])
    which, balls = _coordinates(system), len(system.turned_balls)
    half = len(which) + 4 * balls
    state, slope = (
        State(
            placed(part[: len(which)], which, system.columns),
            part[len(which) : half].reshape(balls, 4, number.shape[0]),
        )
        for part in (column, column[half:])
    )
    return Knot(at[0], state, slope, column[-1].astype(jnp.int32))


def guess(system: LoopSystem, knots: Knots, values: Float[Array, " poses"]) -> Guess:
    """The poses for these inputs as far as the knots tell; the driven coordinates are not set to the inputs."""
    if system.periodic:
        values = _unturned(knots, values)
        turns = jnp.where(knots.repeats, jnp.ceil((values - MEETING[1]) / TURN), 0.0)
        values = values - TURN * turns
    number = jnp.clip(jnp.searchsorted(knots.at, values, side="left") - 1, knots.first, knots.last - 1)
    left, right = _knot(system, knots, number), _knot(system, knots, number + 1)
    left_closed, right_closed = is_closed(left.status), is_closed(right.status)
    between = left_closed & (left.status == right.status)
    # elsewhere there is a limit: up to the inner knot the motion was followed, at the outer one the loops close again
    rising = values >= 0
    outer_closed = jnp.where(rising, right_closed, left_closed)
    near_inner = jnp.abs(values - jnp.where(rising, left.at, right.at)) <= AT_LIMIT
    at_limit = near_inner | ~outer_closed
    from_left = at_limit == rising
    nearest_closed = jnp.where(from_left, left_closed, right_closed)
    trusted = between | (near_inner | ~at_limit) & nearest_closed
    state = choose(between, _hermite(system, left, right, values), choose(from_left, left.state, right.state))
    status = jnp.where(trusted, jnp.where(from_left, left.status, right.status), Status.JUMPED.value)
    if system.periodic:
        state = State(state.x + turns * knots.winding[:, None], state.turns)
    least, most = (knots.at.at[end].get(mode="promise_in_bounds") for end in (knots.first, knots.last))
    return Guess(state, status, (values >= least - BEYOND) & (values <= most + BEYOND))


def _unturned(knots: Knots, values: Float[Array, " poses"]) -> Float[Array, " poses"]:
    """Values less as many full turns as bring them to where the motion got without a gap; others as they are."""
    reached = (knots.table[:, -1] == Status.CLOSED.value) & jnp.isfinite(knots.at)
    least = jnp.min(jnp.where(reached, knots.at, jnp.inf))
    most = jnp.max(jnp.where(reached, knots.at, -jnp.inf))
    # an end of the range that was reached is no limit
    least = jnp.where(least <= knots.at[knots.first], -jnp.inf, least - AT_LIMIT)
    most = jnp.where(most >= knots.at[knots.last], jnp.inf, most + AT_LIMIT)
    down = values - TURN * jnp.ceil(jnp.maximum(values - most, 0.0) / TURN)
    back = down + TURN * jnp.ceil(jnp.maximum(least - down, 0.0) / TURN)
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
