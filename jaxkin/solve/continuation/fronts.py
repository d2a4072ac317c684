"""The fronts of the continuation: the ends of the branch that has been traced so far, which advance in lockstep.

Two fronts, forwards and backwards, trace a range; `reach` has one for every target.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.continuation.input_path import InputPath
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.status import Status
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, assembled

FIRST_STEP = 1e-3
"""Step from the assembled pose, and from the far side of an unreachable interval, radians or characteristic lengths:
nothing is known there of how the slope changes."""

CLOSING = 0
"""Stage of a front that is at the assembled pose, yet to be closed."""
FOLLOWING = 1
"""Stage of a front that follows the motion."""
BEYOND_LIMIT = 2
"""Stage of a front in an unreachable interval."""
RESTING = 3
"""Stage of a front that takes no part in a step."""


@dataclass(frozen=True, eq=False)
class ContinuationProblem(ClosureProblem):
    """What is traced: loops that stay closed while their inputs follow a path."""

    path: InputPath
    follow_limits: Bool[Array, ""] | bool = True
    """Whether fronts go on beyond limits, with the damped corrector; if not, they stop there."""


class Fronts(NamedTuple):
    """The ends of the branch that has been traced so far."""

    state: State
    status: Int[Array, " fronts"]
    residual_norm: Float[Array, " fronts"]
    jacobian: Float[Array, "equations columns fronts"]
    at: Float[Array, " fronts"]
    """Distance along the path: the input itself if it is a single one."""
    slope: Float[Array, "columns fronts"]
    """Derivative of the coordinates with respect to the distance."""
    before: State
    """The state one step back."""
    before_tangent: State
    """Derivative of that state with respect to the distance."""
    width: Float[Array, " fronts"]
    """Distance, with its sign, from that state to this."""
    determinant_ratio: Float[Array, "blocks fronts"]
    """Determinants of the Jacobian here over those one step back."""
    has_before: Bool[Array, " fronts"]
    along_tangent: Bool[Array, " fronts"]
    """Whether the next step is predicted by the tangent alone: the curve through two states failed."""
    step: Float[Array, " fronts"]
    """Length of the next step."""
    stage: Int[Array, " fronts"]
    anchored: Bool[Array, " fronts"]
    """Whether the loops have been closed at all: the pose that closes first is on the branch of the assembled pose."""


def assembled_fronts(system: LoopSystem, fronts: int, dtype) -> Fronts:
    """Make a number of fronts that are all at the assembled pose, yet to be closed."""
    state = assembled(system, fronts, dtype)
    zeros = jax.tree.map(jnp.zeros_like, state)
    return Fronts(
        state=state,
        status=jnp.full(fronts, Status.STALLED.value, jnp.int32),
        residual_norm=jnp.full(fronts, jnp.inf, dtype),
        jacobian=jnp.zeros((system.equations, system.columns, fronts), dtype),
        at=jnp.zeros(fronts, dtype),
        slope=zeros.x,
        before=zeros,
        before_tangent=zeros,
        width=jnp.ones(fronts, dtype),
        determinant_ratio=jnp.ones((len(equation_blocks(system)), fronts), dtype),
        has_before=jnp.zeros(fronts, bool),
        along_tangent=jnp.zeros(fronts, bool),
        step=jnp.full(fronts, FIRST_STEP, dtype),
        stage=jnp.full(fronts, CLOSING, jnp.int32),
        anchored=jnp.zeros(fronts, bool),
    )


def arrived(fronts: Fronts, target: Float[Array, " fronts"]) -> Bool[Array, " fronts"]:
    """Tell which fronts are at their target, with the assembled pose closed before."""
    return (fronts.at == target) & (fronts.stage != CLOSING)


def stopped_at_limit(fronts: Fronts, follow_limits: Bool[Array, ""] | bool) -> Bool[Array, " fronts"]:
    """Tell which fronts have met a limit that is not to be followed."""
    return (fronts.stage == BEYOND_LIMIT) & ~jnp.asarray(follow_limits)
