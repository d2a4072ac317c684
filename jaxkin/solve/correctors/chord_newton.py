"""Correct many poses of several inputs by chord steps (Newton's method with an inverse Jacobian that is kept).

A path through poses of several inputs has a corner at every pose, so that no smooth curve can be laid through many of
them. But neighbours are so near that one step with the inverse Jacobian of the pose in their middle leaves about a
thousandth of the residual, and needs neither a Jacobian nor an elimination of its own.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import closure
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.linear.blocks import inverse_jacobian
from jaxkin.solve.linear.least_norm import damping_floor
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.state import State, retract

POSES_PER_INVERSE = 32
"""Neighbouring poses that share the inverse Jacobian of the one in their middle."""
CHORD_BATCH = 256
"""Poses that are corrected together: they take as many steps as the slowest of them."""
MAX_CHORD_STEPS = 6
"""Chord steps at most: each leaves about a thousandth of the residual."""


def chord_newton(problem: ClosureProblem, state: State, target_residual: float) -> tuple[State, Float[Array, " poses"]]:
    """Take chord steps until the residual norms of all poses are at most `target_residual`, or `MAX_CHORD_STEPS`.

    Returns the states and their residual norms (square root of Eq. 12).
    """
    system, geometry = problem.system, problem.geometry
    poses = state.x.shape[-1]
    groups = -(-poses // POSES_PER_INVERSE)
    middles = np.minimum(np.arange(groups) * POSES_PER_INVERSE + POSES_PER_INVERSE // 2, poses - 1)
    jacobian = closure(system, geometry, State(*(part[..., middles] for part in state))).jacobian
    inverses = inverse_jacobian(jacobian, damping_floor(jacobian.dtype), equation_blocks(system))

    def chord_step(residual: Float[Array, "equations poses"]) -> Float[Array, "columns poses"]:
        filled = jnp.pad(residual, ((0, 0), (0, groups * POSES_PER_INVERSE - poses))).reshape(
            -1, groups, POSES_PER_INVERSE
        )
        return jnp.einsum("gce,egn->cgn", inverses, filled).reshape(system.columns, -1)[:, :poses]

    def running(at: tuple[Array, State, Array, Array]) -> Array:
        count, _, _, residual_norm = at
        return (count < MAX_CHORD_STEPS) & any_in_lockstep(residual_norm > target_residual)

    def step(at: tuple[Array, State, Array, Array]) -> tuple[Array, State, Array, Array]:
        count, state, residual, _ = at
        state = retract(system, state, -chord_step(residual))
        evaluation = closure(system, geometry, state)
        return count + 1, state, evaluation.residual, evaluation.residual_norm

    begun = closure(system, geometry, state)
    _, state, _, residual_norm = lax.while_loop(
        running, step, (jnp.asarray(0), state, begun.residual, begun.residual_norm)
    )
    return state, residual_norm
