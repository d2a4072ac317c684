"""The damped corrector: close poses by least-norm Gauss-Newton steps, many poses at once (Levenberg-Marquardt).

The damping vanishes with the residual (Fan and Yuan 2005), so that convergence stays quadratic where the Jacobian is
singular but the equations are consistent. A step that does not lower the merit is refused and the damping raised. Each
pose accepts, refuses and ends its iteration on its own.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure.closure import Closure, closure, free_jacobian
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.linear.least_norm import damping_floor, solve_least_norm
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.status import CLOSED_ROUNDINGS, Scalar
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, retract, select_poses

MAX_DAMPED_STEP = 0.5
"""Longest step, in radians or characteristic lengths: farther away the linear model of a rotation is no longer good."""
STAGNANT_DECREASE = 1e-9
"""Relative decrease of the merit in one step below which the merit has reached its minimum."""
LEAST_MEAN_SQUARE = 1e-2
"""Mean square of the rows of J below which damping is no longer relative to it, but to this. Of loops of rods beyond a
limit, J vanishes at the least residual, and steps with relative damping grow as its inverse: an RSSR linkage took all
200 of its steps there, most of them refused, and takes twenty from the limit."""
AFTER_GAIN = 0.3
"""What the factor of the damping is multiplied by after a step that lowers the merit."""
OVERSHOT = 0.25
"""Slope of the merit along a step at its end, over that at its beginning with the other sign, from which on the step
went too far. Steps from side to side of a valley lower the merit, but little: where much of the residual is left,
Gauss-Newton takes the valley for wider than it is."""
AFTER_OVERSHOT = 3.0
"""What the factor is multiplied by after a step that went too far, though it lowers the merit."""
AFTER_REFUSAL = 8.0
"""What it is multiplied by after a refused step: more than one gain takes back, or every other step would be refused.
"""
LEAST_FACTOR = 1e-2
"""Least factor of the damping, which vanishes with the residual all the same: three refusals bring it to 1 again."""
MOST_FACTOR = 1e12
"""Largest factor of the damping: steps are shorter than rounding long before."""
SMALL_FACTOR = 1.0
"""Factor of the damping, with which iterations begin, up to which steps are not short because of it."""
SHORTEST_STEP_ROUNDINGS = 4
"""Length of a step in units of rounding, radians or characteristic lengths, below which angles of a turn lose it."""
NOTHING_LEFT_ROUNDINGS = 8
"""Residual norm in units of rounding below which nothing else is left of it, in loops of any length."""
STATIONARY_COSINE = 1e-3
"""Cosine between residual and range of J below which a pose counts as stationary: see `_range_cosine`."""
SETTLED_COSINE = 1e-5
"""Cosine between residual and range of J below which a pose of an open loop is improved no further: its residual is the
least to 1e-10 of itself, or to some 1e-6 where it hardly grows along a direction, as that of a double rocker does."""
OPEN_RESIDUAL = 1e-9
"""Least residual norm of a pose that `SETTLED_COSINE` applies to. Of loops that can close, and come to a singular pose
by halves, the cosine is the distance from it and the residual norm the square of that: 1e-10 at most."""


class LevenbergMarquardtResult(NamedTuple):
    """Corrected states, with the closure there."""

    state: State
    closure: Closure
    residual_norm: Float[Array, " poses"]
    stationary: Bool[Array, " poses"]
    """Whether no free coordinate can reduce the residual to first order (J^T r = 0)."""


class _Iterate(NamedTuple):
    """The carry of the iteration: the last accepted state and the next one to try."""

    count: Array
    state: State
    closure: Closure
    factor: Float[Array, " poses"]
    """Factor of the damping."""
    done: Bool[Array, " poses"]
    trial: State
    delta: Float[Array, "columns poses"]
    """The step from `state` to `trial`."""
    slope: Float[Array, " poses"]
    """Slope of the merit along that step, at its beginning."""


def levenberg_marquardt(
    problem: ClosureProblem,
    state: State,
    max_steps: Int[Array, " poses"] | int,
    target_residual: Scalar | float = 0.0,
) -> LevenbergMarquardtResult:
    """Minimise the closure residual of every pose until it is at most `target_residual`, stationary, or rounding.

    Each step is delta = -J^T (J J^T + damping)^-1 r, no longer than `MAX_DAMPED_STEP`; no pose takes more than
    `max_steps`. `target_residual` is compared with the square root of Eq. 12.
    """
    system, geometry = problem.system, problem.geometry
    dtype = state.x.dtype
    eps = float(jnp.finfo(dtype).eps)

    def running(iterate: _Iterate) -> Array:
        """Tell whether any pose has steps left and is not done."""
        return any_in_lockstep((iterate.count <= max_steps) & ~iterate.done)

    def step(iterate: _Iterate) -> _Iterate:
        """Accept the trial of each pose where its merit is less, adapt the damping, and compute the next trial."""
        # the closure is evaluated at one place only: the compiled program holds its code once
        trial = closure(system, geometry, iterate.trial)
        first = iterate.count == 0
        better = (trial.merit < iterate.closure.merit) & ~iterate.done
        taken = better | first
        chosen_state, chosen = select_poses(taken, (iterate.trial, trial), (iterate.state, iterate.closure))
        jacobian = free_jacobian(system, chosen)
        gradient = _gradient(jacobian, chosen)
        overshot = jnp.sum(gradient * iterate.delta, axis=0) > -OVERSHOT * iterate.slope
        change = jnp.where(better, jnp.where(overshot, AFTER_OVERSHOT, AFTER_GAIN), AFTER_REFUSAL)
        factor = jnp.where(first, iterate.factor, jnp.clip(change * iterate.factor, LEAST_FACTOR, MOST_FACTOR))
        scale = jnp.maximum(1.0, LEAST_MEAN_SQUARE / (_mean_square(jacobian) + 1e-300))
        damping = factor * scale * jnp.minimum(2 * chosen.merit, 1.0) + damping_floor(dtype)
        delta = -solve_least_norm(jacobian, chosen.residual, damping, system.used)
        length = jnp.sqrt(jnp.sum(delta * delta, axis=0))
        delta = delta * jnp.minimum(1.0, MAX_DAMPED_STEP / jnp.maximum(length, MAX_DAMPED_STEP))
        # a refused step: shorter than rounding, or from a residual that counts as closed
        closed = chosen.merit < 0.5 * (CLOSED_ROUNDINGS * eps) ** 2
        exhausted = ~taken & ((length < SHORTEST_STEP_ROUNDINGS * eps) | closed)
        # the merit stagnates although the damping is small, and not from side to side of a valley: loops cannot close
        stagnates = trial.merit > (1 - STAGNANT_DECREASE) * iterate.closure.merit
        cosine = _range_cosine(system, chosen, jacobian)
        settled = ~overshot | (cosine < STATIONARY_COSINE)
        least = better & settled & (iterate.factor <= SMALL_FACTOR) & stagnates
        done = (
            iterate.done
            | (chosen.residual_norm <= target_residual)
            | (chosen.merit < 0.5 * (NOTHING_LEFT_ROUNDINGS * eps) ** 2)
            | exhausted
            | least
            | (cosine < SETTLED_COSINE) & (chosen.residual_norm > OPEN_RESIDUAL)
            | ~jnp.isfinite(chosen.merit)
            | (iterate.count == max_steps)
        )
        ahead, slope = retract(system, chosen_state, delta), jnp.sum(gradient * delta, axis=0)
        return _Iterate(iterate.count + 1, chosen_state, chosen, factor, done, ahead, delta, slope)

    poses = state.x.shape[-1]
    nothing = Closure(
        jnp.zeros((system.equations, poses), dtype),
        jnp.zeros((system.equations, system.columns, poses), dtype),
        jnp.full(poses, jnp.inf, dtype),
        jnp.full(poses, jnp.inf, dtype),
    )
    no = jnp.zeros(poses, bool)
    still, level = jnp.zeros_like(state.x), jnp.zeros(poses, dtype)
    start = _Iterate(jnp.asarray(0), state, nothing, jnp.ones(poses, dtype), no, state, still, level)
    last = lax.while_loop(running, step, start)
    stationary = _range_cosine(system, last.closure, free_jacobian(system, last.closure)) < STATIONARY_COSINE
    return LevenbergMarquardtResult(last.state, last.closure, last.closure.residual_norm, stationary)


def _mean_square(jacobian: Float[Array, "equations columns poses"]) -> Float[Array, " poses"]:
    """Compute the mean square of the rows of J."""
    return jnp.sum(jacobian**2, axis=(0, 1)) / len(jacobian)


def _range_cosine(
    system: LoopSystem, evaluation: Closure, jacobian: Float[Array, "equations columns poses"]
) -> Float[Array, " poses"]:
    """Compute how nearly the residual is orthogonal to the range of J: |J^T r| over the norms of J and r.

    Where it is, no free coordinate reduces the residual to first order.

    At a least residual J^T r = 0. Where the residual is large, Gauss-Newton converges to it linearly; the test is
    therefore on the angle between residual and range, which an iterate on its way does not meet. The Jacobian of a rod
    holds no rotation of its ball, to which its residual is orthogonal: each rod adds 1 to the square of J. Where J
    vanishes, as at the largest value of a coupling's polynomial, J^T r does with it: J counts as `LEAST_MEAN_SQUARE`.
    """
    square = jnp.sum(jacobian**2, axis=(0, 1)) + sum(len(cut) > 1 for cut in system.cuts)
    square = jnp.maximum(square, LEAST_MEAN_SQUARE * len(jacobian))
    gradient = _gradient(jacobian, evaluation)
    return jnp.sqrt(jnp.sum(gradient**2, axis=0) / (square * 2 * evaluation.merit + 1e-300))


def _gradient(jacobian: Float[Array, "equations columns poses"], evaluation: Closure) -> Float[Array, "columns poses"]:
    """Compute the gradient of the merit, J^T r."""
    return jnp.sum(jacobian * evaluation.residual[:, None], axis=0)
