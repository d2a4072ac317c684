"""The poses one after the other by a named method of minimisation, as the paper does it (Section 5.1).

Each pose is sought from the one before it. For comparison: nothing watches the branch, and no pose can be told from
another that is nearer to the start. Gauss-Newton, Levenberg-Marquardt and BFGS are those of jaxopt.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import Closure, Geometry, closure
from jaxkin.solve.correctors.levenberg_marquardt import choose
from jaxkin.solve.reference_methods.dfp import central_differences, dfp
from jaxkin.solve.reference_methods.optional_jaxopt import jaxopt
from jaxkin.solve.status import Scalar, Status
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, assembled, drive, retract

Point = Float[Array, " used"]
Function = Callable[[Point], Array]
ITERATIONS, STALE = 100, 3
"""At most so many steps a pose, and so many in a row that gain nothing."""


def minimised(
    system: LoopSystem, geometry: Geometry, inputs: Float[Array, "driven poses"], method: str, enough: Scalar
) -> tuple[State, Float[Array, " poses"], Array]:
    """States and status and closure gap, the pose before each as its start; a pose is done when its gap is `enough`."""
    place = jnp.asarray(np.eye(system.columns)[:, list(system.used)], inputs.dtype)
    search = _SEARCHES[method]

    def one(before: State, given: Float[Array, " driven"]):
        start = drive(system, before, given[:, None])

        def at(free: Point) -> tuple[State, Closure]:
            state = drive(system, retract(system, start, (place @ free)[:, None]), given[:, None])
            return state, closure(system, geometry, state)

        # Eq. 12 with the entries of rotation weighted by one half: what the residual is the root of nearby
        free = search(
            lambda free: at(free)[1].residual[:, 0],
            lambda free: at(free)[1].merit[0],
            jnp.zeros(place.shape[1], inputs.dtype),
            0.5 * enough**2,
        )
        state, closed = at(free)
        within = closed.gap <= enough
        status = jnp.where(within, Status.CLOSED.value, Status.STALLED.value)
        status = jnp.where(jnp.isfinite(closed.gap), status, Status.NONFINITE.value)[0].astype(jnp.int32)
        return choose(within, state, before), (state, closed.gap[0], status)

    _, (states, gap, status) = lax.scan(one, assembled(system, 1, inputs.dtype), inputs.T)
    return State(states.x[..., 0].T, jnp.moveaxis(states.turns[..., 0], 0, -1)), gap, status


def _stepping(make: Callable[[Function, Function], Any]):
    """A method of jaxopt, step by step until the objective is small enough or falls no more."""

    def search(residual: Function, objective: Function, start: Point, enough: Array) -> Point:
        solver = make(residual, objective)

        def running(carry) -> Array:
            count, stale, best, *_ = carry
            return (count < ITERATIONS) & (stale < STALE) & (best > enough)

        def step(carry):
            count, stale, best, found, params, state = carry
            params, state = solver.update(params, state)
            value = objective(params)
            better = value < best
            found = jnp.where(better, params, found)
            return count + 1, jnp.where(better, 0, stale + 1), jnp.minimum(value, best), found, params, state

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
    "dfp": lambda _, objective, start, enough: dfp(objective, central_differences(objective), start, enough),
    "dfp-autodiff": lambda _, objective, start, enough: dfp(objective, jax.grad(objective), start, enough),
}
"""By name: from residual, objective and start to the point found."""
