"""Many poses of several inputs: neighbours share the inverse Jacobian of the pose in their middle.

Their way has corners at every pose, so that nothing smooth can be laid through many of them; but neighbours are so near
that a step with their common inverse (a chord step) leaves about a thousandth of the gap, and needs no derivatives.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import Geometry, closure
from jaxkin.solve.correctors.levenberg_marquardt import floor
from jaxkin.solve.execution.lockstep import any_in_lockstep
from jaxkin.solve.linear.least_norm import inverse
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, retract

NEIGHBOURS, TOGETHER, STEPS = 32, 256, 6
"""Poses that share an inverse, poses that are computed together, and steps at most."""


def shared_steps(
    system: LoopSystem, geometry: Geometry, state: State, enough: float
) -> tuple[State, Float[Array, " poses"]]:
    """States of many poses after as many chord steps as bring all of them to the gap `enough`, and their gaps."""
    poses = state.x.shape[-1]
    groups = -(-poses // NEIGHBOURS)
    middles = np.minimum(np.arange(groups) * NEIGHBOURS + NEIGHBOURS // 2, poses - 1)
    jacobian = closure(system, geometry, State(*(part[..., middles] for part in state))).jacobian
    back = inverse(jacobian, floor(jacobian.dtype), equation_blocks(system))

    def moved(residual: Float[Array, "equations poses"]) -> Float[Array, "columns poses"]:
        filled = jnp.pad(residual, ((0, 0), (0, groups * NEIGHBOURS - poses))).reshape(-1, groups, NEIGHBOURS)
        return jnp.einsum("gce,egn->cgn", back, filled).reshape(system.columns, -1)[:, :poses]

    def running(at: tuple[Array, State, Array, Array]) -> Array:
        count, _, _, gap = at
        return (count < STEPS) & any_in_lockstep(gap > enough)

    def step(at: tuple[Array, State, Array, Array]) -> tuple[Array, State, Array, Array]:
        count, state, residual, _ = at
        state = retract(system, state, -moved(residual))
        closed = closure(system, geometry, state)
        return count + 1, state, closed.residual, closed.gap

    begun = closure(system, geometry, state)
    _, state, _, gap = lax.while_loop(running, step, (jnp.asarray(0), state, begun.residual, begun.gap))
    return state, gap
