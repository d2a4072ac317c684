"""Move the inputs from the assembled pose to targets, each along a path of its own."""

from __future__ import annotations

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin.solve.closure.closure import closure
from jaxkin.solve.continuation.fronts import ContinuationProblem, Fronts, arrived, assembled_fronts
from jaxkin.solve.continuation.step import BEYOND_LIMIT_STEP, substep
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.status import Status
from jaxkin.solve.system.state import State, drive, select_poses

STAYS = 4 * BEYOND_LIMIT_STEP
"""Distance, at the end of a path, over which inputs stay where they are while a pose is STALLED: four times the steps
of the damped corrector, which has few for each step of the continuation."""

FINE_PATH = 1024 * BEYOND_LIMIT_STEP
"""Distance, radians or characteristic lengths, up to which steps beyond a limit are no longer than elsewhere. Along a
longer path they are longer in proportion, so that inputs however far beyond a limit are reached in so many steps."""
MAX_PATH_STEPS = 2**20
"""Steps along a path, at most: 50,000 turns of two inputs, in some ten seconds."""


def reach(
    problem: ClosureProblem, targets: Float[Array, "driven paths"], bends: Float[Array, "driven paths"]
) -> tuple[State, Int[Array, " paths"], Float[Array, " paths"]]:
    """Move the inputs from the assembled pose to each target along the parabola with control point `bends`.

    The parabola is straight where `bends` is half the target. Inputs are in radians and characteristic lengths. Returns
    the states, their statuses, and their residual norms (square root of Eq. 12 over all twelve equations, lengths over
    the characteristic length), measured at these states. Targets that are not reached in so many steps are STALLED.
    """
    system, options = problem.system, problem.options
    distance = jnp.max(jnp.abs(bends), axis=0, initial=0.0) + jnp.max(jnp.abs(targets - bends), axis=0, initial=0.0)
    whole = jnp.where(distance > 0, distance, 1.0)

    def path(at: Float[Array, " paths"]) -> tuple[Array, Array]:
        share = at / whole
        inputs = 2 * share * (1 - share) * bends + share**2 * targets
        direction = 2 * ((1 - 2 * share) * bends + share * targets) / whole
        return jnp.where(at >= distance, targets, inputs), jnp.where(at > distance, 0.0, direction)

    def end(fronts: Fronts) -> Float[Array, " paths"]:
        last = distance + STAYS * stride
        stays = (fronts.status == Status.STALLED.value) & (fronts.at < last)
        return jnp.where(fronts.at < distance, distance, jnp.where(stays, last, fronts.at))

    stride = jnp.maximum(1.0, distance / FINE_PATH)
    along = ContinuationProblem(system, problem.geometry, options, path, stride=stride)
    _, fronts = lax.while_loop(
        lambda now: (now[0] < MAX_PATH_STEPS) & any_in_lockstep(~arrived(now[1], end(now[1]))),
        lambda now: (now[0] + 1, substep(along, now[1], end(now[1]))),
        (jnp.asarray(0), assembled_fronts(system, targets.shape[-1], targets.dtype)),
    )
    there = arrived(fronts, end(fronts))
    state = select_poses(there, fronts.state, drive(system, fronts.state, targets))
    status = jnp.where(there, fronts.status, Status.STALLED.value)
    return state, status, closure(system, problem.geometry, state).residual_norm
