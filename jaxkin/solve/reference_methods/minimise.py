"""Find the poses one after the other by a named method of minimisation, as the paper does (Section 5.1).

Each pose is sought from the last closed pose before it. This is for comparison only: the branch is not traced, so a
pose on another branch counts as CLOSED, and stationarity is not tested, so a pose that cannot be reached counts as
STALLED. Gauss-Newton, Levenberg-Marquardt and BFGS are those of jaxopt.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin.solve.closure.closure import Closure, Geometry, closure
from jaxkin.solve.reference_methods.dfp import central_differences, dfp
from jaxkin.solve.reference_methods.optional_jaxopt import jaxopt
from jaxkin.solve.status import Scalar, Status
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, assembled, drive, retract, select_poses

Point = Float[Array, " used"]
Function = Callable[[Point], Array]
JAXOPT_ITERATIONS = 100
"""Largest number of iterations for a pose; a pose that needs more is STALLED."""
IDLE_ITERATIONS = 3
"""Number of iterations in a row without a decrease of the objective, after which the search stops."""


def minimise_each(
    system: LoopSystem, geometry: Geometry, inputs: Float[Array, "driven poses"], method: str, max_residual: Scalar
) -> tuple[State, Int[Array, " poses"], Float[Array, " poses"]]:
    """Find each pose from the last closed pose before it; returns states, statuses and residual norms.

    `inputs` are in radians and characteristic lengths. Statuses are CLOSED, STALLED and NONFINITE only. Residual norms
    are the square root of Eq. 12, lengths over the characteristic length; a pose is CLOSED when its residual norm is at
    most `max_residual`.
    """
    place = jnp.asarray(np.eye(system.columns)[:, list(system.used)], inputs.dtype)
    search = _SEARCHES[method]

    def one(before: State, given: Float[Array, " driven"]):
        start = drive(system, before, given[:, None])

        def at(free: Point) -> tuple[State, Closure]:
            state = drive(system, retract(system, start, (place @ free)[:, None]), given[:, None])
            return state, closure(system, geometry, state)

        # Eq. 12 with the entries of rotation weighted by one half: the objective whose residuals are those of `closure`
        free = search(
            lambda free: at(free)[1].residual[:, 0],
            lambda free: at(free)[1].merit[0],
            jnp.zeros(place.shape[1], inputs.dtype),
            0.5 * max_residual**2,
        )
        state, evaluation = at(free)
        within = evaluation.residual_norm <= max_residual
        status = jnp.where(within, Status.CLOSED.value, Status.STALLED.value)
        status = jnp.where(jnp.isfinite(evaluation.residual_norm), status, Status.NONFINITE.value)[0].astype(jnp.int32)
        return select_poses(within, state, before), (state, evaluation.residual_norm[0], status)

    _, (states, residual_norm, status) = lax.scan(one, assembled(system, 1, inputs.dtype), inputs.T)
    state = State(states.x[..., 0].T, jnp.moveaxis(states.turns[..., 0], 0, -1))
    return state, status, residual_norm


def _stepping(make: Callable[[Function, Function], Any]):
    """Make a search that runs a method of jaxopt until the objective is at most `target` or falls no more.

    `make` returns the method for a residual and an objective, both functions of the free coordinates.
    """

    def search(residual: Function, objective: Function, start: Point, target: Array) -> Point:
        solver = make(residual, objective)

        def running(carry) -> Array:
            count, idle, best, *_ = carry
            return (count < JAXOPT_ITERATIONS) & (idle < IDLE_ITERATIONS) & (best > target)

        def step(carry):
            count, idle, best, found, params, state = carry
            params, state = solver.update(params, state)
            value = objective(params)
            better = value < best
            found = jnp.where(better, params, found)
            return count + 1, jnp.where(better, 0, idle + 1), jnp.minimum(value, best), found, params, state

        begin = (jnp.asarray(0), jnp.asarray(0), objective(start), start, start, solver.init_state(start))
        return lax.while_loop(running, step, begin)[3]

    return search


def _gauss_newton(residual: Function, objective: Function):
    del objective
    return jaxopt().GaussNewton(residual, implicit_diff=False)


def _levenberg_marquardt(residual: Function, objective: Function):
    del objective
    return jaxopt().LevenbergMarquardt(residual, materialize_jac=True, solver="cholesky", implicit_diff=False)


def _bfgs(residual: Function, objective: Function):
    del residual
    return jaxopt().BFGS(objective, implicit_diff=False)


_SEARCHES = {
    "gauss-newton": _stepping(_gauss_newton),
    "levenberg-marquardt": _stepping(_levenberg_marquardt),
    "bfgs": _stepping(_bfgs),
    "dfp": lambda _, objective, start, target: dfp(objective, central_differences(objective), start, target),
    "dfp-autodiff": lambda _, objective, start, target: dfp(objective, jax.grad(objective), start, target),
}
"""Name of the method -> function of residual, objective, start and target of the objective that returns a point."""
