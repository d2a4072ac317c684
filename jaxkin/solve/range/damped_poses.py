"""Correct poses that Newton's method leaves open by damped steps, in small groups that others do not wait for.

Beyond a limit the damped corrector converges linearly to the least residual, in ten steps or so. But the pose of least
residual is a smooth function of the input: of many poses a few are corrected first, and the others begin on cubics
through these, where one or two steps are enough.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.continuation.fronts import ContinuationProblem
from jaxkin.solve.correctors.levenberg_marquardt import levenberg_marquardt
from jaxkin.solve.device import group_for_device
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.range.poses import MAX_CORRECTION
from jaxkin.solve.status import Scalar, default_tolerance
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, difference, is_driven, retract, select_poses

DAMPED_GROUP = 32
"""Number of poses that the damped corrector works on at once on CPUs: in most groups Newton's method leaves no more
open."""

VALLEY = 10
"""Steps to a least residual, at most, over `rescue_steps`: far beyond a limit the residual may have a long bent valley,
as of a crank longer than all other bars together, along which 200 steps are not enough."""


def correct_damped(
    problem: ContinuationProblem,
    at: Float[Array, " poses"],
    state: State,
    chosen: Bool[Array, " poses"],
    target_residual: Scalar | float,
) -> tuple[State, Float[Array, " poses"], Bool[Array, " poses"]]:
    """Correct the `chosen` poses by damped steps, `DAMPED_GROUP` poses at a time on CPUs.

    `at` are the distances of the poses along the path, and `state` those from which they are corrected. Where more than
    one group is chosen, the first one is spread over all of them, and the others begin between its poses of least
    residual. Returns states, residual norms and which poses are stationary; the entries of poses that are not chosen
    are undefined.
    """
    poses, count = chosen.shape[0], jnp.sum(chosen)
    size = min(group_for_device(DAMPED_GROUP), poses)
    in_order, order = lax.sort_key_val(jnp.where(chosen, at, jnp.inf), jnp.arange(poses))
    spread = jnp.arange(size) * (jnp.maximum(count, size) - 1) // max(size - 1, 1)

    def running(carry) -> Array:
        return any_in_lockstep(carry[0] < count + jnp.where(count > size, size, 0))

    def step(carry):
        begun, found = carry
        ranks = jnp.minimum(begun - size, poses - size) + jnp.arange(size)
        ranks = jnp.where(begun == 0, spread, ranks)
        which = order[ranks]
        start = jax.tree.map(lambda array: array[..., which], state)
        if poses > size:
            nodes = jax.tree.map(lambda array: array[..., order[spread]], found)
            between, usable = _between(problem.system, nodes, in_order[spread], start, in_order[ranks])
            start = select_poses(usable & (begun > 0), between, start)
        here = levenberg_marquardt(problem, start, VALLEY * problem.options.rescue_steps, target_residual)
        found = jax.tree.map(
            lambda whole, part: whole.at[..., which].set(part),
            found,
            (here.state, here.residual_norm, here.stationary),
        )
        return begun + size, found

    nothing = state, jnp.zeros(poses, state.x.dtype), jnp.zeros(poses, bool)
    return lax.while_loop(running, step, (jnp.asarray(0), nothing))[1]


def _between(
    system: LoopSystem,
    nodes: tuple[State, Float[Array, " nodes"], Bool[Array, " nodes"]],
    nodes_at: Float[Array, " nodes"],
    start: State,
    at: Float[Array, " poses"],
) -> tuple[State, Bool[Array, " poses"]]:
    """Interpolate states of least residual at distances `at` by cubics through the four nearest nodes.

    `nodes` are states, residual norms, and whether these are stationary. Driven coordinates are those of `start`.
    Returns also at which poses all four nodes are open and stationary, and near each other.
    """
    state, residual_norm, stationary = nodes
    least = jnp.clip(jnp.sum(nodes_at[:, None] < at, axis=0) - 2, 0, len(nodes_at) - 4)
    four = least + jnp.arange(4)[:, None]
    places = nodes_at[four]
    ratios = (at - places) / (places[:, None] - places)
    weights = jnp.prod(jnp.where(np.eye(4, dtype=bool)[..., None], 1.0, ratios), axis=1)
    found = jax.tree.map(lambda array: jnp.sum(weights * array[..., four], axis=-2), state)
    found = State(jnp.where(is_driven(system), start.x, found.x), found.turns)
    ends = (jax.tree.map(lambda array, end=end: array[..., least + end], state) for end in (0, 3))
    open_there = stationary & (residual_norm > default_tolerance(at.dtype))
    usable = jnp.all(open_there[four], axis=0) & (difference(*ends) <= 3 * MAX_CORRECTION)
    usable &= jnp.all(jnp.isfinite(weights), axis=0)  # repeated inputs have no cubic
    return retract(system, found, jnp.zeros_like(found.x)), usable
