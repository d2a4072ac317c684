"""Continuation: from the assembled pose towards a target, in steps as long as they are safe.

A secant predictor carries the motion through change points, where a plain warm start leaves the branch; a step is taken
only if the corrector stays near the prediction. Where the motion ends (a limit of the range) the damped corrector goes
on alone, towards the least residual; when the loops close again the branch is told by the sign of the determinant of
the Jacobian, which changes where two assembly modes meet, and the pose is mirrored at the limit if it is the wrong one.
Several lanes march side by side; each substep evaluates the closure at one place, which keeps the compiled code small.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure import Geometry
from jaxkin.solve.correct import choose, correct, free_jacobian, spread
from jaxkin.solve.linear import least_norm, scale
from jaxkin.solve.state import State, assembled, difference, drive, retract
from jaxkin.solve.status import Status, classify, is_closed
from jaxkin.solve.system import LoopSystem

FIRST_STEP, LONGEST_STEP, SHORTEST_STEP, GAP_STEP = 1e-3, 0.15, 1e-6, 0.05
"""Radians, or characteristic lengths. A limit of the motion is approached to the shortest step; the damped corrector
settles what lies beyond it."""
CORRECTOR_STEPS, RESCUE_STEPS = 8, 80

START, FOLLOW, GAP, MIRROR = range(4)
"""Stages of a lane: closing the assembled pose, following the motion, beyond its limit, trying the other branch."""


class Orientation(NamedTuple):
    """Bases in which the sign of the determinant of the Jacobian tells assembly modes apart."""

    left: Float[Array, "equations rank"]
    right: Float[Array, "free rank"]
    kept: Float[Array, " rank"]
    """1 for the singular directions that the assembled pose has, 0 for those that are redundant there."""


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
    before_gap: State
    """The last pose before the loops closed again: what a pose of the wrong branch is mirrored at."""
    step: Float[Array, " lanes"]
    stage: Int[Array, " lanes"]
    bases: Orientation


def start(system: LoopSystem, lanes: int, dtype) -> Front:
    """All lanes at the assembled pose, yet to be closed."""
    state = assembled(system, lanes, dtype)
    nothing = jax.tree.map(jnp.zeros_like, state)
    rank = min(system.equations, len(system.free))
    bases = Orientation(
        jnp.zeros((system.equations, rank), dtype), jnp.zeros((len(system.free), rank), dtype), jnp.zeros(rank, dtype)
    )
    return Front(
        state,
        jnp.full(lanes, Status.STALLED.value, jnp.int32),
        jnp.full(lanes, jnp.inf, dtype),
        nothing.x,
        nothing,
        jnp.zeros(lanes, bool),
        state,
        jnp.full(lanes, FIRST_STEP, dtype),
        jnp.full(lanes, START, jnp.int32),
        bases,
    )


def arrived(system: LoopSystem, front: Front, target: Float[Array, "driven lanes"]) -> Bool[Array, " lanes"]:
    """Whether a lane has dealt with its target."""
    return (_distance(system, front, target) <= 0) & ((front.stage == FOLLOW) | (front.stage == GAP))


def substep(
    system: LoopSystem, geometry: Geometry, front: Front, target: Float[Array, "driven lanes"]
) -> tuple[Front, Bool[Array, " lanes"]]:
    """One step of every lane that has not arrived, and which lanes now stand at a new pose with its final status."""
    dtype = target.dtype
    left = _distance(system, front, target)
    active = ~arrived(system, front, target)
    stage = jnp.where(active, front.stage, -1)
    following, in_gap, mirroring = stage == FOLLOW, stage == GAP, stage == MIRROR
    moved = jnp.where(following, jnp.minimum(front.step, left), jnp.where(in_gap, jnp.minimum(GAP_STEP, left), 0.0))
    here = front.state.x[jnp.array(system.driven, int)]
    inputs = jnp.where(moved >= left, target, here + (target - here) * (moved / jnp.where(left > 0, left, 1.0)))
    inputs = jnp.where(following | in_gap, inputs, here)

    along = jax.tree.map(
        lambda x, d: x + jnp.where(following & front.has_secant, moved, 0.0) * d, front.state, front.secant
    )
    across = jax.tree.map(lambda x, b: 2 * b - x, front.state, front.before_gap)
    predicted = choose(mirroring, across, along)
    predicted = drive(system, retract(system, predicted, jnp.zeros_like(predicted.x)), inputs)
    hard = jnp.any(active & ~following)
    found = correct(system, geometry, predicted, jnp.where(hard, RESCUE_STEPS, CORRECTOR_STEPS))

    jacobian = free_jacobian(system, found.closure)
    bases = lax.cond(jnp.any(stage == START), _orientation, lambda _: front.bases, jacobian[..., 0])
    sign = lax.cond(hard, orientation_sign, lambda _, __: jnp.ones_like(left), bases, jacobian)
    status = classify(found.closure.gap, found.stationary, sign >= 0)
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

    reentered = (in_gap | (stage == START)) & closed
    wrong = in_gap & (status == Status.JUMPED.value)
    righted = mirroring & (status == Status.CLOSED.value)
    taken = good | in_gap | (stage == START) | righted
    kept_status = jnp.where(good | mirroring, front.status, status)  # a branch is kept while it is followed
    new_status = jnp.where(righted, Status.CLOSED.value, kept_status).astype(jnp.int32)

    next_stage = jnp.where(lost | ((stage == START) & ~closed), GAP, front.stage)
    next_stage = jnp.where(reentered | mirroring, FOLLOW, next_stage)
    next_stage = jnp.where(wrong, MIRROR, next_stage)
    secant = jax.tree.map(lambda new, old: (new - old) / jnp.where(moved > 0, moved, 1.0), found.state, front.state)
    first = jnp.array(system.driven[:1], int)
    driven = jnp.sum(found.closure.jacobian[:, first], axis=1)
    slope = spread(system, -least_norm(jacobian, driven, 1e-10 * scale(jacobian))).at[first].set(1.0)
    final = good | (in_gap & ~wrong) | (stage == START) | mirroring
    return (
        Front(
            state=choose(taken, found.state, front.state),
            status=jnp.where(taken | mirroring, new_status, front.status),
            gap=jnp.where(taken, found.closure.gap, front.gap),
            slope=jnp.where(taken, slope, front.slope),
            secant=choose(good, secant, front.secant),
            has_secant=(front.has_secant | good) & (next_stage == FOLLOW) & ~mirroring & ~reentered,
            before_gap=choose(in_gap, front.state, front.before_gap),
            step=jnp.where(reentered | mirroring, FIRST_STEP, step),
            stage=next_stage.astype(jnp.int32),
            bases=bases,
        ),
        final & active,
    )


def visit(
    system: LoopSystem, geometry: Geometry, targets: Float[Array, "targets driven lanes"]
) -> tuple[State, Int[Array, "targets lanes"], Float[Array, "targets lanes"]]:
    """States, status and closure gap at targets that follow one another along a polyline from the assembled pose."""

    def go(front: Front, target: Float[Array, "driven lanes"]):
        front = lax.while_loop(
            lambda front: jnp.any(~arrived(system, front, target)),
            lambda front: substep(system, geometry, front, target)[0],
            front,
        )
        return front, (front.state, front.status, front.gap)

    _, reached = lax.scan(go, start(system, targets.shape[-1], targets.dtype), targets)
    return reached


def orientation_sign(bases: Orientation, jacobian: Float[Array, "equations free poses"]) -> Float[Array, " poses"]:
    """Sign of the determinant of the Jacobian in the bases: 1 on the branch of the assembled pose."""
    inner = jnp.einsum("ir,ijp,js->prs", bases.left, jacobian, bases.right)
    inner = inner * bases.kept[:, None] * bases.kept + jnp.diag(1.0 - bases.kept)
    return jnp.sign(jnp.linalg.det(inner))


def _orientation(jacobian: Float[Array, "equations free"]) -> Orientation:
    left, values, right = jnp.linalg.svd(jacobian, full_matrices=False)
    least = 1e-7 if jnp.finfo(values.dtype).bits == 64 else 1e-3
    return Orientation(left, right.T, (values > least * values[0]).astype(values.dtype))


def _distance(system: LoopSystem, front: Front, target: Float[Array, "driven lanes"]) -> Float[Array, " lanes"]:
    return jnp.max(jnp.abs(target - front.state.x[jnp.array(system.driven, int)]), axis=0, initial=0.0)
