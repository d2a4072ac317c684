"""Outer solvers, from jaxopt: Levenberg-Marquardt for sums of squares, else bounded L-BFGS; many starts at once.

jaxopt is imported when it is used: see `jaxkin.solve.outside`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.design.problem import HOPELESS, Problem
from jaxkin.design.variables import from_angles, to_angles
from jaxkin.solve.compiled import jit_options
from jaxkin.solve.outside import jaxopt

CHUNK = 10
"""Iterations between two looks at the losses."""
DAMPING = 1e-3
"""First damping, relative to the largest diagonal entry of J^T J."""
MEMORY = 12
"""Pairs of steps and gradients that L-BFGS keeps."""
HALVINGS = 15
"""Trials of a line search, each 0.4 times as long as the one before."""


class Solver(NamedTuple):
    """`begin(vectors, weight)` and `advance(state, weight)`, over all starts at once."""

    begin: Callable[..., Any]
    advance: Callable[..., Any]
    """Some iterations; returns the state and the losses after each (iterations, starts)."""
    vectors: Callable[[Any], Float[Array, "starts variables"]]
    slopes: Callable[[Any], Float[Array, "starts variables"]]
    """Zero where a variable has no influence."""
    replaced: Callable[[Any, Any, Any], Any]
    """The state with the lanes of a mask (second) overwritten by one lane (third)."""
    judge: Callable[[Any], tuple[np.ndarray, np.ndarray]]
    """Losses, nan where not finite, and roots of the sums of squares of violations, of some vectors."""


class _Once:
    """Residuals and Jacobian from one evaluation: the solver asks for them one after another at the same point."""

    def __init__(self, function: Callable[[Any, Any], Array]):
        self.function = function
        self.at: Any = None
        self.found: Any = None

    def evaluate(self, x, weight):
        if self.at is not x:
            basis = jnp.eye(x.size, dtype=x.dtype)
            push = jax.vmap(lambda v: jax.jvp(lambda x: self.function(x, weight), (x,), (v,)), out_axes=(None, -1))
            self.at, self.found = x, push(basis)
        return self.found

    def residuals(self, x, weight):
        return jnp.clip(jnp.nan_to_num(self.evaluate(x, weight)[0], nan=HOPELESS), -HOPELESS, HOPELESS)

    def jacobian(self, x, weight):
        return jnp.nan_to_num(self.evaluate(x, weight)[1], nan=0.0, posinf=0.0, neginf=0.0)

    def forget(self) -> None:
        self.at = self.found = None


def least_squares(problem: Problem) -> Solver:
    """Levenberg-Marquardt on angles without bounds, x = middle + half sin(angle).

    One program does all: it evaluates residuals and Jacobian once, at the new point, and takes or refuses the step.
    """
    once = _Once(lambda angles, weight: problem.residuals(from_angles(problem.variables, angles), weight))
    solver = jaxopt().LevenbergMarquardt(
        once.residuals,
        materialize_jac=True,
        solver="cholesky",
        implicit_diff=False,
        jit=False,
    )
    solver._jac_fun = once.jacobian  # its own option `jac_fun` is ignored in jaxopt 0.8.5

    start = jnp.asarray(problem.variables.start)
    count = jax.eval_shape(problem.judge, start).rows.shape[0]
    total = jax.eval_shape(problem.residuals, start, 1.0).shape[0]

    def blank(angles):
        """A state before any evaluation: no step, an infinite loss, so that the first update only evaluates."""
        starts, size = angles.shape
        nothing = jnp.zeros((starts, size), angles.dtype)
        jacobian = jnp.zeros((starts, total, size), angles.dtype)
        example = jax.eval_shape(lambda x: solver.init_state(x, 1.0), angles[0])
        once.forget()
        return example._replace(
            iter_num=jnp.zeros(starts, int),
            damping_factor=jnp.ones(starts, angles.dtype),
            increase_factor=jnp.full(starts, 2.0, angles.dtype),
            error=jnp.full(starts, jnp.inf, angles.dtype),
            residual=jnp.zeros((starts, total), angles.dtype),
            value=jnp.full(starts, jnp.inf, angles.dtype),
            delta=nothing,
            gradient=nothing,
            jac=jacobian,
            jt=jnp.swapaxes(jacobian, 1, 2),
            jtj=jnp.zeros((starts, size, size), angles.dtype),
        )

    @partial(jax.jit, **jit_options())
    def update(state, weight):
        def one(angles, state):
            step = solver.update(angles, state, weight)
            once.forget()
            return step.params, step.state._replace(
                increase_factor=jnp.asarray(step.state.increase_factor, angles.dtype)
            )

        return jax.vmap(one)(*state)

    def begin(vectors, weight):
        angles = to_angles(problem.variables, jnp.asarray(vectors))
        angles, state = update((angles, blank(angles)), weight)
        largest = jnp.max(jnp.diagonal(state.jtj, axis1=1, axis2=2), axis=1)
        return angles, state._replace(damping_factor=DAMPING * largest + 1e-300)

    def advance(state, weight):
        values = []
        for _ in range(CHUNK):
            state = update(state, weight)
            values.append(2.0 * state[1].value)
        return state, jnp.stack(values)

    def judge(vectors):
        residuals = np.asarray(begin(vectors, 1.0)[1].residual)
        rows, violations = residuals[:, :count], residuals[:, count:]
        losses = np.where(np.any(np.abs(rows) >= HOPELESS, axis=1), np.nan, np.sum(rows**2, axis=1))
        return losses, np.sqrt(np.sum(violations**2, axis=1))

    return Solver(
        begin,
        advance,
        lambda state: from_angles(problem.variables, state[0]),
        lambda state: jnp.max(jnp.abs(state[1].jac), axis=1),
        _replaced,
        judge,
    )


def bounded(problem: Problem) -> Solver:
    """Bounded L-BFGS on vectors scaled to 0..1."""
    lower, upper = (jnp.asarray(bound) for bound in (problem.variables.lower, problem.variables.upper))
    width = jnp.where(upper > lower, upper - lower, 1.0)

    def value_and_grad(unit, weight):
        value, slope = jax.value_and_grad(lambda unit: problem.total(lower + width * unit, weight))(unit)
        return jnp.nan_to_num(value, nan=HOPELESS, posinf=HOPELESS), jnp.nan_to_num(slope, posinf=0.0, neginf=0.0)

    package = jaxopt()
    solver = package.LBFGSB(
        value_and_grad, value_and_grad=True, history_size=MEMORY, linesearch_init="max", implicit_diff=False
    )
    # its own line search holds the program of loss and gradient three times over; this one once. It asks for less loss
    # only: `c2` switches the condition on the slope off, and L-BFGS skips steps of negative curvature by itself
    solver.run_ls = package.BacktrackingLineSearch(
        value_and_grad, value_and_grad=True, condition="wolfe", c2=1e30, decrease_factor=0.4, maxiter=HALVINGS
    ).run
    bounds = (jnp.zeros_like(lower), (upper - lower) / width)

    def begin(vectors, weight):
        units = (jnp.asarray(vectors) - lower) / width
        return units, jax.vmap(lambda unit: solver.init_state(unit, bounds, weight))(units)

    def advance(state, weight):
        def one(unit, state):
            step = solver.update(unit, state, bounds, weight)
            return step.params, step.state

        def iterate(carry, _):
            new = jax.vmap(one)(*carry)
            # a line search that fails leaves the point where it was
            better = new[1].value <= carry[1].value

            def keep(new, old):
                return jnp.where(better.reshape(better.shape + (1,) * (new.ndim - 1)), new, old)

            carry = jax.tree.map(keep, new, carry)
            return carry, carry[1].value

        return jax.lax.scan(iterate, state, None, length=CHUNK)

    judged = jax.jit(jax.vmap(problem.judge), **jit_options())

    def judge(vectors):
        found = judged(jnp.asarray(vectors))
        losses = np.asarray(found.rows)[:, 0]
        return np.where(np.isfinite(losses), losses, np.nan), np.sqrt(np.sum(np.asarray(found.violations) ** 2, axis=1))

    return Solver(
        jax.jit(begin, **jit_options()),
        jax.jit(advance, **jit_options()),
        lambda state: lower + width * state[0],
        lambda state: state[1].grad,
        _replaced,
        judge,
    )


@jax.jit
def _replaced(state, mask, source):
    def each(leaf):
        leaf = jnp.asarray(leaf)
        return jnp.where(mask.reshape(mask.shape + (1,) * (leaf.ndim - 1)), leaf[source][None], leaf)

    return jax.tree.map(each, state)
