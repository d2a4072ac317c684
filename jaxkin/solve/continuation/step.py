"""Continuation: from the assembled pose towards a target, in steps as long as they are safe.

A step is predicted by the cubic through the last two states with their slopes, or by the secant through them where a
slope says nothing: it carries the motion through change points, where a plain warm start leaves the branch and no
tangent is unique. Where that fails, as it does near a limit behind a long step, the tangent is tried, by turns with
it. A step is taken only if the corrector stays near the prediction, and if the Jacobian keeps its orientation: where
two branches nearly meet, a long step would go straight on to the other one. Where the motion ends (a limit of the
range) the damped corrector goes on alone, towards the least residual. Where the loops close again behind such a gap
the pose has jumped: no motion of the input led there. (The orientation would not tell: two circuits can share it.)
Several lanes march side by side; each substep evaluates the closure at one place, which keeps the compiled code small.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure.closure import Closure, Geometry, closure
from jaxkin.solve.continuation.determinant_sign import turned
from jaxkin.solve.continuation.input_path import Way
from jaxkin.solve.correctors.levenberg_marquardt import Corrected, choose, correct, floor
from jaxkin.solve.correctors.newton import newton
from jaxkin.solve.execution.lockstep import any_lane
from jaxkin.solve.linear.least_norm import solve_blocks
from jaxkin.solve.status import Status, classify, is_closed, roundings
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, assembled, difference, drive, driven_rate, rate, retract

FIRST_STEP, LONGEST_STEP, SHORTEST_STEP, GAP_STEP = 1e-3, 0.3, 1e-6, 0.15
"""Radians, or characteristic lengths. A limit of the motion is approached to the shortest step; the damped corrector
settles what lies beyond it."""
SHORTEST_FIRST_STEP = 1e-10
"""Of a mechanism that is assembled so near to a limit."""
AT_LIMIT = 4 * SHORTEST_STEP
"""As near as this to a limit the motion is followed at least."""
CROSSING = 1e-3
"""A step that is no longer may pass from one branch to another that crosses it: at a change point, or where two
branches miss each other by less than this, as they do for lengths that are off by 1e-6."""
CORRECTOR_STEPS, GAP_STEPS, RESCUE_STEPS = 8, 16, 200
"""Of the corrector at most: following, crossing a gap, and where a pose is to be closed or to have least residual."""

WANTED, MOST, FARTHEST = 0.1, 0.25, 1.0
"""By how much of the way travelled a prediction is to be off, and may be; and that way at most, in radians or
characteristic lengths: beside a limit the tangent leads anywhere."""

ENOUGH = 64
"""Times the unit of rounding: the gap of a pose on the way, which is only a place to begin from."""
START_NEAR = 0.1
"""An assembled pose that is closed farther away than this is closed with care."""

START, FOLLOW, GAP, ARRIVED = range(4)
"""Stages of a lane: closing the assembled pose, following the motion, beyond its limit; none of these any more."""


class Front(NamedTuple):
    """Where the lanes stand."""

    state: State
    status: Int[Array, " lanes"]
    gap: Float[Array, " lanes"]
    jacobian: Float[Array, "equations columns lanes"]
    at: Float[Array, " lanes"]
    """How far along the way: the input itself if it is a single one."""
    slope: Float[Array, "columns lanes"]
    """Change of the coordinates per unit of that."""
    before: State
    """The state one step back."""
    before_rate: State
    """Its change per unit of the way."""
    width: Float[Array, " lanes"]
    """How far back that was."""
    turned: Float[Array, "blocks lanes"]
    """How the Jacobian has turned since."""
    has_before: Bool[Array, " lanes"]
    tangent: Bool[Array, " lanes"]
    """Whether the next step is predicted with the slope alone: where the curve through two states failed."""
    step: Float[Array, " lanes"]
    stage: Int[Array, " lanes"]
    anchored: Bool[Array, " lanes"]
    """Whether the loops have been closed at all: what closes first is the branch of the assembled pose."""


def start(system: LoopSystem, lanes: int, dtype) -> Front:
    """All lanes at the assembled pose, yet to be closed."""
    state = assembled(system, lanes, dtype)
    nothing = jax.tree.map(jnp.zeros_like, state)
    return Front(
        state,
        jnp.full(lanes, Status.STALLED.value, jnp.int32),
        jnp.full(lanes, jnp.inf, dtype),
        jnp.zeros((system.equations, system.columns, lanes), dtype),
        jnp.zeros(lanes, dtype),
        nothing.x,
        nothing,
        nothing,
        jnp.ones(lanes, dtype),
        jnp.ones((len(equation_blocks(system)), lanes), dtype),
        jnp.zeros(lanes, bool),
        jnp.zeros(lanes, bool),
        jnp.full(lanes, FIRST_STEP, dtype),
        jnp.full(lanes, START, jnp.int32),
        jnp.zeros(lanes, bool),
    )


def arrived(front: Front, target: Float[Array, " lanes"]) -> Bool[Array, " lanes"]:
    """Whether a lane has dealt with its target."""
    return (front.at == target) & (front.stage != START)


def given_up(front: Front, patient: Bool[Array, ""] | bool) -> Bool[Array, " lanes"]:
    """Lanes that only the patient follow any further: beyond a limit."""
    return (front.stage == GAP) & ~jnp.asarray(patient)


def substep(
    system: LoopSystem,
    geometry: Geometry,
    way: Way,
    front: Front,
    target: Float[Array, " lanes"],
    patient: Bool[Array, ""] | bool = True,
) -> Front:
    """One step of every lane that has not arrived; a lane whose step was refused stands where it stood.

    A lane is closed to some roundings, no better; its gap may be foreseen, not measured. Who is not patient does
    without the damped corrector, and leaves lanes at their limit.
    """
    dtype = target.dtype
    left = jnp.abs(target - front.at)
    stage = jnp.where(arrived(front, target) | given_up(front, patient), ARRIVED, front.stage)
    starting, following, in_gap = stage == START, stage == FOLLOW, stage == GAP
    moved = jnp.where(following, jnp.minimum(front.step, left), jnp.where(in_gap, jnp.minimum(GAP_STEP, left), 0.0))
    moved = jnp.where(target < front.at, -moved, moved)
    at = jnp.where((jnp.abs(moved) >= left) & (following | in_gap), target, front.at + moved)
    inputs, direction = way(at)

    sloped = front.has_before | front.tangent
    tangent = rate(system, front.state, front.slope)
    predicted = _predicted(front, tangent, jnp.where(following & sloped, moved, 0.0))
    predicted = drive(system, retract(system, predicted, jnp.zeros_like(predicted.x)), inputs)
    distance = jnp.abs(moved)
    travel = jnp.where(sloped, jnp.maximum(difference(predicted, front.state), distance), 80 * distance)
    slack = 50 * float(jnp.finfo(dtype).eps)
    found = _corrected(system, geometry, predicted, stage, patient)
    # a target so near that no step was short enough, just inside a limit
    beside = in_gap & (front.status == Status.CLOSED.value) & (distance <= AT_LIMIT)
    status = classify(found.gap, found.stationary, ~front.anchored | beside)
    closed = is_closed(status)

    # following: near the prediction, or, without one, within a tiny step
    deviation = difference(found.state, predicted)
    jacobian = found.closure.jacobian
    turn = turned(front.jacobian, jacobian, equation_blocks(system))
    # a determinant that falls to zero on the way, but has kept its sign, may have passed a gap
    falls = front.has_before & (1 + (1 - 1 / front.turned) * moved / front.width < 0)
    crossed = jnp.any((turn < 0) | falls, axis=0) & (distance > CROSSING)
    good = following & closed & (deviation <= MOST * travel + slack) & (travel <= FARTHEST) & ~crossed
    # a cubic is off by the fourth power of the step
    growth = jnp.where(sloped, jnp.cbrt(WANTED * travel / jnp.maximum(deviation - slack, 1e-30)), 2.0)
    step = jnp.where(good, jnp.minimum(jnp.clip(growth, 0.5, 4.0) * front.step, LONGEST_STEP), front.step)
    step = jnp.where(following & ~good, 0.35 * distance, step)
    shortest = jnp.where(front.at == 0, SHORTEST_FIRST_STEP, SHORTEST_STEP)
    lost = following & ~good & front.tangent & (distance <= shortest)

    entered = (starting | in_gap) & closed
    final = good | starting | in_gap
    next_stage = jnp.where(entered, FOLLOW, jnp.where(lost | starting, GAP, front.stage))
    slope = slopes(system, found.state, found.closure, direction)
    return Front(
        state=choose(final, found.state, front.state),
        status=jnp.where(starting | in_gap, status, front.status),  # a branch is kept while it is followed
        gap=jnp.where(final, found.gap, front.gap),
        jacobian=jnp.where(final, jacobian, front.jacobian),
        at=jnp.where(final, at, front.at),
        slope=jnp.where(final, slope, front.slope),
        before=choose(good, front.state, front.before),
        before_rate=choose(good, tangent, front.before_rate),
        width=jnp.where(good & (moved != 0), moved, front.width),
        turned=jnp.where(good, turn, front.turned),
        has_before=(front.has_before | good) & (next_stage == FOLLOW) & ~entered,
        tangent=following & ~good & ~front.tangent,
        step=jnp.where(entered, FIRST_STEP, step),
        stage=next_stage.astype(jnp.int32),
        anchored=front.anchored | entered,
    )


def _corrected(
    system: LoopSystem,
    geometry: Geometry,
    predicted: State,
    stage: Int[Array, " lanes"],
    patient: Bool[Array, ""] | bool,
) -> Corrected:
    """Lanes brought to closure by Newton's method; where that fails, and beyond a limit, by the damped corrector."""
    enough = roundings(predicted.x.dtype, ENOUGH)
    state, closed, gap = newton(system, geometry, predicted, enough, foresee=True)
    quick = Corrected(state, closed, gap, jnp.zeros(gap.shape, bool))
    near = (gap <= enough) & (difference(state, predicted) <= START_NEAR)
    hard = (stage == GAP) | (stage == START) & ~near | (stage == FOLLOW) & ~(gap <= enough)

    def with_care() -> Corrected:
        steps = jnp.where(stage == START, RESCUE_STEPS, jnp.where(stage == GAP, GAP_STEPS, CORRECTOR_STEPS))
        return choose(hard, correct(system, geometry, predicted, steps, enough), quick)

    return lax.cond(any_lane(hard) & patient, with_care, lambda: quick)


def _predicted(front: Front, tangent: State, moved: Float[Array, " lanes"]) -> State:
    """Where the motion is expected: on the cubic through two states with their slopes, or along secant or tangent."""
    s, w = moved / front.width, front.width

    def chord(x: Array, x_before: Array) -> Array:
        return x + s * (x - x_before)

    def cubic(x: Array, d: Array, x_before: Array, d_before: Array) -> Array:
        back, d, d_before = x_before - x, w * d, w * d_before
        return x + s * (d + s * (3 * back + 2 * d + d_before + s * (2 * back + d + d_before)))

    straight = jax.tree.map(chord, front.state, front.before)
    curve = jax.tree.map(cubic, front.state, tangent, front.before, front.before_rate)
    # at a change point the tangent is not unique and a slope says nothing
    smooth = difference(curve, straight) <= 0.25 * difference(straight, front.state)
    along = jax.tree.map(lambda x, d: x + moved * d, front.state, tangent)
    return choose(front.tangent | ~front.has_before, along, choose(smooth, curve, straight))


def reach(
    system: LoopSystem, geometry: Geometry, targets: Float[Array, "driven lanes"]
) -> tuple[State, Int[Array, " lanes"], Float[Array, " lanes"]]:
    """States, status and closure gap at targets that are reached from the assembled pose, each in a straight line."""
    distance = jnp.max(jnp.abs(targets), axis=0, initial=0.0)
    direction = targets / jnp.where(distance > 0, distance, 1.0)

    def way(at: Float[Array, " lanes"]) -> tuple[Array, Array]:
        return jnp.where(at == distance, targets, at * direction), direction

    front = lax.while_loop(
        lambda front: any_lane(~arrived(front, distance)),
        lambda front: substep(system, geometry, way, front, distance),
        start(system, targets.shape[-1], targets.dtype),
    )
    return front.state, front.status, closure(system, geometry, front.state).gap


def slopes(
    system: LoopSystem, state: State, closed: Closure, direction: Float[Array, "driven poses"]
) -> Float[Array, "columns poses"]:
    """Change of all coordinates while the inputs change in a direction."""
    change, columns = driven_rate(system, state, direction)
    right = jnp.sum(closed.jacobian * columns[None], axis=1)
    return change - solve_blocks(closed.jacobian, right, floor(right.dtype), equation_blocks(system))
