"""Newton's method for poses that begin near closure: block after block, undamped, without step control.

An iteration costs a fraction of one of the damped corrector (`levenberg_marquardt`), and a few are all that most poses
need; the poses that they do not close are left to that one.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.closure.closure import Closure, closure
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.linear.blocks import is_costly, solve_blocks
from jaxkin.solve.linear.least_norm import damping_floor
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.status import CLOSED_ROUNDINGS, Scalar, default_tolerance, rounding_residual
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.state import State, retract, select_poses

MAX_QUADRATIC_RATIO = 1e-2
"""Ratio of two residual norms below which convergence counts as quadratic. At a limit of the motion, where the Jacobian
is singular, convergence is linear and the ratio a quarter at best."""


class _Iterate(NamedTuple):
    """The carry of the iteration: the last state whose closure is known, and the next one."""

    count: Array
    """Number of closures that were evaluated."""
    state: State
    """The last state whose closure is known."""
    closure: Closure
    """That of `state`; its norms are infinite before the first step."""
    extrapolated: Float[Array, " poses"]
    """Residual norm of `trial`, extrapolated from those of the last two states whose closure is known; infinite where
    convergence is not quadratic, or where nothing is extrapolated."""
    trial: State
    """The next state: a step from `state`."""
    led_away: Bool[Array, " poses"]
    """Whether a step has raised the residual norm of a pose that was closed: the pose is singular."""


def newton(
    problem: ClosureProblem,
    state: State,
    target_residual: Scalar | float,
    *,
    extrapolate_residual: bool = False,
) -> tuple[State, Closure, Float[Array, " poses"]]:
    """Take `newton_iterations` of the options, or fewer if all residual norms get to at most `target_residual`.

    Each step solves J delta = -r (Eq. 10, linearised) block after block. Returns the states, their closure and their
    residual norms (square root of Eq. 12). At a singular pose rounding makes a long step, from which the next ones come
    back by halves and stop at the square root of rounding: such poses have a residual norm of infinity.

    With `extrapolate_residual`, the last step is not evaluated where convergence is quadratic: its residual norm is
    extrapolated, and its state is one step ahead of the closure; and there is no test for singular poses.
    """
    system, geometry = problem.system, problem.geometry
    poses, dtype = state.x.shape[-1], state.x.dtype
    infinite = jnp.full(poses, jnp.inf, dtype)
    costly = is_costly(equation_blocks(system))

    def running(at: _Iterate) -> Array:
        return (at.count <= problem.options.newton_iterations) & any_in_lockstep(
            (at.closure.residual_norm > target_residual) & (at.extrapolated > target_residual) & ~at.led_away
        )

    def step(at: _Iterate) -> _Iterate:
        # the closure is evaluated at one place only: the compiled program holds its code once
        evaluation = closure(system, geometry, at.trial)
        led_away = at.led_away
        if not extrapolate_residual:
            before = at.closure.residual_norm
            raised = evaluation.residual_norm > jnp.maximum(before, rounding_residual(dtype, CLOSED_ROUNDINGS))
            led_away |= (before <= default_tolerance(dtype)) & raised

        def solved() -> Array:
            return solve_blocks(
                evaluation.jacobian, evaluation.residual, damping_floor(dtype), equation_blocks(system), regular=True
            )

        if costly:  # skip the elimination once all poses are closed; for small systems the test costs as much
            delta = lax.cond(
                any_in_lockstep(evaluation.residual_norm > target_residual), solved, lambda: jnp.zeros_like(at.trial.x)
            )
        else:
            delta = solved()
        extrapolated = infinite
        if extrapolate_residual:
            # quadratic convergence squares the ratio of residual norms: the next one is ratio^2 times the present one
            ratio = evaluation.residual_norm / at.closure.residual_norm
            extrapolated = jnp.where(
                (ratio < MAX_QUADRATIC_RATIO) & (at.count > 0), ratio**2 * evaluation.residual_norm, jnp.inf
            )
        # a closed pose takes no further step: near a singular pose it would lead away; poses must not depend on others
        delta = jnp.where(evaluation.residual_norm > target_residual, -delta, 0.0)
        return _Iterate(at.count + 1, at.trial, evaluation, extrapolated, retract(system, at.trial, delta), led_away)

    nothing = jnp.zeros((system.equations, system.columns, poses), dtype)
    start = Closure(nothing[:, 0], nothing, infinite, infinite)
    last = lax.while_loop(running, step, _Iterate(jnp.asarray(0), state, start, infinite, state, infinite < 0))
    state, residual_norm = last.state, jnp.where(last.led_away, jnp.inf, last.closure.residual_norm)
    if extrapolate_residual:
        ahead = (residual_norm > target_residual) & (last.extrapolated <= target_residual)
        state, residual_norm = select_poses(ahead, (last.trial, last.extrapolated), (state, residual_norm))
    return state, last.closure, residual_norm
