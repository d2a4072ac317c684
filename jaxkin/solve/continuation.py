"""Continuation: from the assembled pose towards a target, in steps as long as they are safe.

A secant predictor carries the motion through change points, where a plain warm start leaves the branch; a step is
taken only if the corrector stays near the prediction. Where the motion ends (a limit of the range) the damped corrector
goes on alone, towards the least residual. Where the loops close again behind such a gap the pose has jumped: no motion
of the input led there. (The sign of the determinant of the Jacobian would not tell: two circuits can share it.) Several
lanes march side by side; each substep evaluates the closure at one place, which keeps the compiled code small.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure import Closure, Geometry
from jaxkin.solve.correct import choose, correct, floor, free_jacobian
from jaxkin.solve.linear import least_norm, scale
from jaxkin.solve.state import State, assembled, difference, drive, driven, retract
from jaxkin.solve.status import Status, classify, is_closed
from jaxkin.solve.system import LoopSystem

FIRST_STEP, LONGEST_STEP, SHORTEST_STEP, GAP_STEP = 1e-3, 0.15, 1e-6, 0.05
"""Radians, or characteristic lengths. A limit of the motion is approached to the shortest step; the damped corrector
settles what lies beyond it."""
CORRECTOR_STEPS, RESCUE_STEPS = 8, 200

START, FOLLOW, GAP = range(3)
"""Stages of a lane: closing the assembled pose, following the motion, beyond its limit."""


class Front(NamedTuple):
    """Where the lanes stand."""

    state: State
    status: Int[Array, " lanes"]
    gap: Float[Array, " lanes"]
    slope: Float[Array, "columns lanes"]
    """Change of the coordinates per unit of a single input (meaningless for several)."""
    secant: State
    """Change of the state per unit of step at the last step taken."""
    has_secant: Bool[Array, " lanes"]
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
        nothing.x,
        nothing,
        jnp.zeros(lanes, bool),
        jnp.full(lanes, FIRST_STEP, dtype),
        jnp.full(lanes, START, jnp.int32),
        jnp.zeros(lanes, bool),
    )


def arrived(system: LoopSystem, front: Front, target: Float[Array, "driven lanes"]) -> Bool[Array, " lanes"]:
    """Whether a lane has dealt with its target."""
    return (_distance(system, front, target) <= 0) & (front.stage != START)


def substep(
    system: LoopSystem, geometry: Geometry, front: Front, target: Float[Array, "driven lanes"]
) -> tuple[Front, Bool[Array, " lanes"]]:
    """One step of every lane that has not arrived, and which lanes now stand at a new pose with its final status."""
    dtype = target.dtype
    left = _distance(system, front, target)
    active = ~arrived(system, front, target)
    stage = jnp.where(active, front.stage, -1)
    starting, following, in_gap = stage == START, stage == FOLLOW, stage == GAP
    moved = jnp.where(following, jnp.minimum(front.step, left), jnp.where(in_gap, jnp.minimum(GAP_STEP, left), 0.0))
    here = driven(system, front.state.x)
    inputs = jnp.where(moved >= left, target, here + (target - here) * (moved / jnp.where(left > 0, left, 1.0)))
    inputs = jnp.where(following | in_gap, inputs, here)

    predicted = jax.tree.map(
        lambda x, d: x + jnp.where(following & front.has_secant, moved, 0.0) * d, front.state, front.secant
    )
    predicted = drive(system, retract(system, predicted, jnp.zeros_like(predicted.x)), inputs)
    hard = jnp.any(starting | in_gap)
    found = correct(system, geometry, predicted, jnp.where(hard, RESCUE_STEPS, CORRECTOR_STEPS))
    status = classify(found.closure.gap, found.stationary, ~front.anchored)
    closed = is_closed(status)

    # following: near the prediction, or, without a secant, within a tiny step
    deviation = difference(found.state, predicted)
    travel = jnp.where(front.has_secant, jnp.maximum(difference(predicted, front.state), moved), 80 * moved)
    slack = 50 * float(jnp.finfo(dtype).eps)
    good = following & closed & (deviation <= 0.25 * travel + slack)
    easy = good & (~front.has_secant | (deviation <= 0.02 * travel + slack))
    step = jnp.where(easy, jnp.minimum(2.0 * front.step, LONGEST_STEP), front.step)
    step = jnp.where(following & ~good, 0.35 * moved, step)
    lost = following & ~good & (moved <= SHORTEST_STEP)

    entered = (starting | in_gap) & closed
    final = good | starting | in_gap
    next_stage = jnp.where(entered, FOLLOW, jnp.where(lost | starting, GAP, front.stage))
    secant = jax.tree.map(lambda new, old: (new - old) / jnp.where(moved > 0, moved, 1.0), found.state, front.state)
    slope = slopes(system, found.closure)
    return (
        Front(
            state=choose(final, found.state, front.state),
            status=jnp.where(starting | in_gap, status, front.status),  # a branch is kept while it is followed
            gap=jnp.where(final, found.closure.gap, front.gap),
            slope=jnp.where(final, slope, front.slope),
            secant=choose(good, secant, front.secant),
            has_secant=(front.has_secant | good) & (next_stage == FOLLOW) & ~entered,
            step=jnp.where(entered, FIRST_STEP, step),
            stage=next_stage.astype(jnp.int32),
            anchored=front.anchored | entered,
        ),
        final,
    )


def visit(
    system: LoopSystem, geometry: Geometry, targets: Float[Array, "targets driven lanes"]
) -> tuple[State, Int[Array, "targets lanes"], Float[Array, "targets lanes"]]:
    """States, status and closure gap at targets that follow one another along a polyline from the assembled pose.

    Behind a target that was not reached the next one is approached from the assembled pose, in a straight line: the
    way around a gap, if there is one, is open to several inputs.
    """
    afresh = start(system, targets.shape[-1], targets.dtype)

    def go(front: Front, target: Float[Array, "driven lanes"]):
        front = choose(front.status == Status.CLOSED.value, front, afresh)
        front = lax.while_loop(
            lambda front: jnp.any(~arrived(system, front, target)),
            lambda front: substep(system, geometry, front, target)[0],
            front,
        )
        return front, (front.state, front.status, front.gap)

    _, reached = lax.scan(go, afresh, targets)
    return reached


def slopes(system: LoopSystem, closed: Closure) -> Float[Array, "columns poses"]:
    """Change of all coordinates per unit of the first that is driven."""
    jacobian, first = free_jacobian(system, closed), system.driven[0]
    given = np.arange(system.columns)[:, None] == first
    return given - least_norm(jacobian, closed.jacobian[:, first], floor(jacobian.dtype) * scale(jacobian))


def _distance(system: LoopSystem, front: Front, target: Float[Array, "driven lanes"]) -> Float[Array, " lanes"]:
    return jnp.max(jnp.abs(target - driven(system, front.state.x)), axis=0, initial=0.0)
