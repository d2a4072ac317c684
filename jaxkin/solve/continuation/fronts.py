"""Hold the fronts of the continuation: the ends of the branch traced so far, which advance in lockstep.

Two fronts trace a range, one backwards and one forwards from the assembled pose; `reach.reach` has one front a target.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.continuation.input_path import InputPath
from jaxkin.solve.continuation.predictor import History
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.status import Status
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, assembled

FIRST_STEP = 1e-3
"""Length of the first step from the assembled pose, and from the far side of an unreachable interval, radians or
characteristic lengths: short, since there is no slope yet from which to predict."""

CLOSING = 0
"""Stage of a front at the assembled pose before its loops are closed."""
FOLLOWING = 1
"""Stage of a front that follows a branch."""
BEYOND_LIMIT = 2
"""Stage of a front in an unreachable interval."""
RESTING = 3
"""What stands in place of the stage of a front that takes no part in a step, while that is computed: never stored."""


@dataclass(frozen=True, eq=False)
class ContinuationProblem(ClosureProblem):
    """The problem of the continuation: keep loops closed while their inputs follow a path."""

    path: InputPath
    """Inputs as a function of the distance along the path."""
    follow_limits: Bool[Array, ""] | bool = True
    """Whether fronts go on beyond limits, with the damped corrector; if not, they stop there."""
    stride: Float[Array, " fronts"] | float = 1.0
    """How many times `step.BEYOND_LIMIT_STEP` the steps beyond limits are long."""


class Fronts(NamedTuple):
    """The ends of the branch that has been traced so far, one entry a front."""

    state: State
    status: Int[Array, " fronts"]
    residual_norm: Float[Array, " fronts"]
    """Square root of Eq. 12, lengths over the characteristic length; perhaps extrapolated (see `step.substep`)."""
    jacobian: Float[Array, "equations columns fronts"]
    """Closure Jacobian at `state`, or one Newton step before it where the residual norm is extrapolated."""
    at: Float[Array, " fronts"]
    """Distance along the path: the input itself if it is a single one."""
    slope: Float[Array, "columns fronts"]
    """Derivative of the coordinates with respect to the distance along the path."""
    history: History
    """The states before, from which the next one is predicted."""
    determinant_ratio: Float[Array, "blocks fronts"]
    """Determinant of each block of the Jacobian at `state` over that one accepted step back."""
    has_before: Bool[Array, " fronts"]
    """Whether the state one step back is a pose of the same branch, from which to predict."""
    refusals: Int[Array, " fronts"]
    """How many steps have been refused since the last one that was accepted."""
    step: Float[Array, " fronts"]
    """Length of the next step."""
    stage: Int[Array, " fronts"]
    """CLOSING, FOLLOWING or BEYOND_LIMIT; which fronts are RESTING each step decides anew."""
    anchored: Bool[Array, " fronts"]
    """Whether the loops have been closed before: the first pose that closes is on the branch of the assembled pose."""


def assembled_fronts(system: LoopSystem, fronts: int, dtype) -> Fronts:
    """Make fronts that are all at the assembled pose, whose loops are still to be closed."""
    state = assembled(system, fronts, dtype)
    zeros = jax.tree.map(jnp.zeros_like, state)
    return Fronts(
        state=state,
        status=jnp.full(fronts, Status.STALLED.value, jnp.int32),
        residual_norm=jnp.full(fronts, jnp.inf, dtype),
        jacobian=jnp.zeros((system.equations, system.columns, fronts), dtype),
        at=jnp.zeros(fronts, dtype),
        slope=zeros.x,
        history=History(zeros, zeros, jnp.ones(fronts, dtype), zeros, jnp.full(fronts, jnp.inf, dtype)),
        determinant_ratio=jnp.ones((len(equation_blocks(system)), fronts), dtype),
        has_before=jnp.zeros(fronts, bool),
        refusals=jnp.zeros(fronts, jnp.int32),
        step=jnp.full(fronts, FIRST_STEP, dtype),
        stage=jnp.full(fronts, CLOSING, jnp.int32),
        anchored=jnp.zeros(fronts, bool),
    )


def arrived(fronts: Fronts, target: Float[Array, " fronts"]) -> Bool[Array, " fronts"]:
    """Tell which fronts are at their target and have left the stage CLOSING."""
    return (fronts.at == target) & (fronts.stage != CLOSING)


def stopped_at_limit(fronts: Fronts, follow_limits: Bool[Array, ""] | bool) -> Bool[Array, " fronts"]:
    """Tell which fronts stop because they have met a limit and limits are not to be followed."""
    return (fronts.stage == BEYOND_LIMIT) & ~jnp.asarray(follow_limits)
