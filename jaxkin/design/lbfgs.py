"""Bounded L-BFGS from jaxopt, for any loss.

jaxopt is imported when it is used: see `jaxkin.solve.reference_methods.optional_jaxopt`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jaxtyping import Float

from jaxkin.design.augmented_lagrangian import Verdict
from jaxkin.design.problem import HOPELESS, Judged, Problem, ProgramKey, taken_apart
from jaxkin.design.solvers import CHUNK, KEPT, TOGETHER, Solver, in_groups, unit_box
from jaxkin.solve.execution.compiler import jit_options
from jaxkin.solve.reference_methods.optional_jaxopt import jaxopt

MEMORY = 12
"""Pairs of steps and gradients that L-BFGS keeps."""
HALVINGS = 15
"""Trials of a line search, each 0.4 times as long as the one before."""
SHORTER = 1e4
"""What first steps along the slope are divided by where a line search has failed."""


class _State(NamedTuple):
    units: Float[Any, "starts variables"]
    """0 at the lower bounds, 1 at the upper ones."""
    inner: Any
    """State of jaxopt, of the loss times the scale."""
    scale: Float[Any, " starts"]
    """One over the size of the first loss and of its slope. jaxopt holds slopes and steps against the rounding of 1:
    a loss with slopes of 1e16, such as squares of accelerations in mm/s^2, would never move."""


class _Programs(NamedTuple):
    """The programs of problems of one key, whose numbers are their first argument."""

    first: Callable[..., Any]
    """Evaluate loss and gradient of designs, for the first state; also tells which derivatives are no numbers."""
    further: Callable[..., Any]
    """Take `CHUNK` iterations."""
    judged: Callable[..., Judged]
    """Judge designs: see `Problem.judge`."""


def bounded(problem: Problem, together: int = TOGETHER) -> Solver:
    """Make the solver by bounded L-BFGS, on vectors scaled to 0..1, `together` designs in a compiled program."""
    lower, width = (np.asarray(each, dtypes.canonicalize_dtype(float)) for each in unit_box(problem.variables))
    key, numbers = taken_apart(problem)
    first, further, judged = _programs(key)

    def begun(vectors, penalty):
        span = np.where(width > 0, width, 1.0)
        units = np.where(width > 0, (np.asarray(vectors) - lower) / span, 0.0)
        return in_groups(lambda group: first(numbers, *group), together, (units, penalty))

    def unknown(vectors, penalty):
        return begun(vectors, penalty)[1]

    def advance(state, penalty, active):
        chosen = np.flatnonzero(active)
        found, values = in_groups(lambda group: further(numbers, *group), together, (state, penalty), chosen)
        losses = np.full((CHUNK, len(active)), np.nan)
        losses[:, chosen] = values.T

        def put(old, new):
            whole = np.array(old)
            whole[chosen] = new
            return whole

        return jax.tree.map(put, state, found), losses

    def judge(vectors, shifts):
        found = in_groups(lambda group: judged(numbers, group), together, np.asarray(vectors))
        losses = np.where(np.isfinite(found.rows[:, 0]), found.rows[:, 0], np.nan)
        return Verdict(losses, found.gaps, np.maximum(shifts - found.margins, 0.0), shifts)

    return Solver(
        lambda vectors, penalty: begun(vectors, penalty)[0],
        advance,
        lambda state: np.asarray(lower + width * state.units),
        lambda state: state.inner.grad / state.scale[:, None],
        unknown,
        judge,
    )


@lru_cache(maxsize=KEPT)
def _programs(key: ProgramKey) -> _Programs:
    """Make the programs of problems of this key."""

    def exactly(unit, penalty, scale, numbers):
        problem: Problem = key.problem.unflatten(numbers)
        lower, width = unit_box(problem.variables)
        return jax.value_and_grad(lambda unit: scale * problem.total(lower + width * unit, penalty))(unit)

    def in_numbers(value, slope):
        return jnp.nan_to_num(value, nan=HOPELESS, posinf=HOPELESS), jnp.nan_to_num(slope, posinf=0.0, neginf=0.0)

    def value_and_grad(unit, penalty, scale, numbers):
        return in_numbers(*exactly(unit, penalty, scale, numbers))

    def bounds(numbers):
        chosen = key.problem.unflatten(numbers).variables
        return jnp.zeros_like(chosen.lower), jnp.where(chosen.upper > chosen.lower, 1.0, 0.0)

    package = jaxopt()
    settings = {"value_and_grad": True, "history_size": MEMORY, "linesearch_init": "max", "implicit_diff": False}
    solver, beginner = (package.LBFGSB(each, **settings) for each in (value_and_grad, exactly))
    # its own line search holds the program of loss and gradient three times over; this one once. It asks for less loss
    # only: `c2` switches the condition on the slope off, and L-BFGS skips steps of negative curvature by itself
    solver.run_ls = package.BacktrackingLineSearch(
        value_and_grad, value_and_grad=True, condition="wolfe", c2=1e30, decrease_factor=0.4, maxiter=HALVINGS
    ).run

    def first(numbers, units, penalties):
        box = bounds(numbers)

        def one(unit, penalty):
            state = beginner.init_state(unit, box, penalty, 1.0, numbers)
            unknown = jnp.isfinite(state.value) & ~jnp.isfinite(state.grad)
            value, slope = in_numbers(state.value, state.grad)
            size = jnp.maximum(jnp.abs(value), jnp.linalg.norm(jnp.where(box[1] > 0, slope, 0.0)))
            scale = jnp.where(size > 0, 1.0 / size, 1.0)
            return _State(unit, state._replace(value=scale * value, grad=scale * slope), scale), unknown

        return jax.vmap(one)(units, penalties)

    def further(numbers, state, penalties):
        box = bounds(numbers)

        def one(unit, state, penalty, scale):
            step = solver.update(unit, state, box, penalty, scale, numbers)
            return step.params, step.state

        def iterate(carry, _):
            new = jax.vmap(one)(carry[0], carry[1], penalties, scales)
            # a line search that fails leaves the point where it was, and the next one would fail alike: pairs of steps
            # and gradients that led there are forgotten, and the slope followed with a shorter step
            better = new[1].value < carry[1].value
            units, old = carry
            pairs = jnp.zeros_like(old.s_history)
            anew = old._replace(s_history=pairs, y_history=pairs, num_updates=0 * old.num_updates)
            anew = anew._replace(theta=SHORTER * old.theta)

            def keep(new, old):
                return jnp.where(better.reshape(better.shape + (1,) * (new.ndim - 1)), new, old)

            carry = jax.tree.map(keep, new, (units, anew))
            return carry, carry[1].value / scales

        scales = state.scale
        (units, inner), losses = jax.lax.scan(iterate, (state.units, state.inner), None, length=CHUNK)
        return _State(units, inner, scales), losses.T

    def judged(numbers, vectors):
        return jax.vmap(key.problem.unflatten(numbers).judge)(vectors)

    return _Programs(*(jax.jit(each, **jit_options()) for each in (first, further, judged)))
