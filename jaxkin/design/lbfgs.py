"""Bounded L-BFGS from jaxopt, for any loss.

jaxopt knows nothing of the loss: it says where a step leads, and is told what the loss and its slope are there. So one
program of the loss is compiled, for many designs at once, and the line search shortens the steps of those starts alone
that ask for it. jaxopt is imported when it is used: see `jaxkin.solve.reference_methods.optional_jaxopt`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jaxtyping import Float

from jaxkin.design.augmented_lagrangian import Penalty, Verdict
from jaxkin.design.problem import HOPELESS, Problem, ProgramKey, taken_apart
from jaxkin.design.solvers import CHUNK, KEPT, TOGETHER, Solver, in_groups, unit_box
from jaxkin.solve.execution.compiler import jit_options
from jaxkin.solve.execution.two_tiers import TwoTiers
from jaxkin.solve.reference_methods.optional_jaxopt import jaxopt

MEMORY = 12
"""Pairs of steps and gradients that L-BFGS keeps."""
TRIALS = 15
"""Trials of a line search."""
SHORTENED = 0.4
"""Length of a trial over that of the one before."""
ENOUGH = 1e-4
"""Decrease of the loss, over what its slope foresees, at which a trial is taken (Armijo)."""
SHORTER = 1e4
"""What first steps along the slope are divided by where a line search has failed."""


class _Found(NamedTuple):
    """A loss with its penalty, and its slope, at designs; numbers all of them."""

    values: Float[np.ndarray, " starts"]
    slopes: Float[np.ndarray, "starts variables"]


class _State(NamedTuple):
    units: Float[np.ndarray, "starts variables"]
    """0 at the lower bounds, 1 at the upper ones."""
    inner: Any
    """State of jaxopt, of the loss times the scale."""
    scale: Float[np.ndarray, " starts"]
    """One over the size of the first loss and of its slope. jaxopt holds slopes and steps against the rounding of 1:
    a loss with slopes of 1e16, such as squares of accelerations in mm/s^2, would never move."""


def bounded(problem: Problem, together: int = TOGETHER) -> Solver:
    """Make the solver by bounded L-BFGS, on vectors scaled to 0..1, `together` designs in a compiled program."""
    dtype = dtypes.canonicalize_dtype(float)
    lower, width = (np.asarray(each, dtype) for each in unit_box(problem.variables))
    box = np.zeros_like(lower), np.where(width > 0, 1.0, 0.0).astype(dtype)
    key, numbers = taken_apart(problem)
    program, steps = _program(key, together).search(), _steps()

    def evaluated(units, penalty):
        given = jax.tree.map(lambda leaf: np.asarray(leaf, dtype), (units, penalty))
        return in_groups(lambda group: program(numbers, *group), together, given)

    def found(units, penalty, scale) -> _Found:
        values, slopes, _ = evaluated(units, penalty)
        values = np.nan_to_num(scale * values, nan=HOPELESS, posinf=HOPELESS)
        return _Found(values, np.nan_to_num(scale[:, None] * slopes, posinf=0.0, neginf=0.0))

    def units_of(vectors):
        return np.where(width > 0, (np.asarray(vectors) - lower) / np.where(width > 0, width, 1.0), 0.0)

    def begin(vectors, penalty):
        units = units_of(vectors)
        now = found(units, penalty, np.ones(len(units)))
        sizes = np.maximum(np.abs(now.values), np.linalg.norm(np.where(width > 0, now.slopes, 0.0), axis=1))
        scale = np.where(sizes > 0, 1.0 / np.where(sizes > 0, sizes, 1.0), 1.0)
        scaled = _Found(scale * now.values, scale[:, None] * now.slopes)
        given = jax.tree.map(lambda leaf: np.asarray(leaf, dtype), (units, *scaled))
        return _State(units, in_groups(lambda group: steps.begun(box, *group), together, given), scale)

    def advance(state, penalty, active):
        losses = np.full((CHUNK, len(active)), np.nan)
        chosen = np.flatnonzero(active)
        now, of_now = jax.tree.map(lambda each: each[chosen], (state, penalty))

        def stepped(lengths, there: _Found):
            given = jax.tree.map(lambda leaf: np.asarray(leaf, dtype), (lengths, *there))
            return in_groups(lambda group: steps.stepped(box, *group), together, (now.units, now.inner, *given))

        for row in losses:
            ends, _ = stepped(np.ones(len(chosen)), _Found(now.inner.value, now.inner.grad))

            def of_some(some, units, now=now):
                return found(units, jax.tree.map(lambda each: each[some], of_now), now.scale[some])

            units, lengths, there = _searched(of_some, now, ends)
            new = _State(units, stepped(lengths, there)[1], now.scale)
            now = _kept(new, now)
            row[chosen] = now.inner.value / now.scale

        def put(old, new):
            whole = np.array(old)
            whole[chosen] = new
            return whole

        return jax.tree.map(put, state, now), losses

    def unknown(vectors, penalty):
        values, slopes, _ = evaluated(units_of(vectors), penalty)
        return np.isfinite(values)[:, None] & ~np.isfinite(slopes)

    def judge(vectors, shifts):
        _, _, judged = evaluated(units_of(vectors), Penalty(np.ones(len(vectors)), shifts))
        losses = np.where(np.isfinite(judged.rows[:, 0]), judged.rows[:, 0], np.nan)
        return Verdict(losses, judged.gaps, np.maximum(shifts - judged.margins, 0.0), shifts)

    return Solver(
        begin,
        advance,
        lambda state: np.asarray(lower + width * state.units),
        lambda state: state.inner.grad / state.scale[:, None],
        unknown,
        judge,
    )


@lru_cache(maxsize=KEPT)
def _program(key: ProgramKey, together: int) -> TwoTiers:
    """Make the program of a problem of this key: the loss with its penalty, its slope, and what `Problem.judge` says
    of designs."""
    del together  # a program is compiled for its number of designs

    def program(numbers, units, penalties):
        problem: Problem = key.problem.unflatten(numbers)
        lower, width = unit_box(problem.variables)

        def one(unit, penalty):
            def total(unit):
                judged = problem.judge(lower + width * unit)
                rows, gaps, charged = judged.weighted(penalty)
                return rows[0] + jnp.sum(gaps**2) + jnp.sum(charged**2), judged

            (value, judged), slope = jax.value_and_grad(total, has_aux=True)(unit)
            return value, slope, judged

        return jax.vmap(one)(units, penalties)

    return TwoTiers(program)


class _Steps(NamedTuple):
    """The programs of jaxopt, which serve all losses; starts come first in all but the box."""

    begun: Callable[..., Any]
    """Make the state of jaxopt, of a box, and units with value and slope."""
    stepped: Callable[..., Any]
    """Take a step of a length: from a box, units and their state, to units and state with a value and a slope. Called
    with the length 1 first, for where the step leads, and again when the loss is known there: the direction is found
    twice, in a fraction of the time that the loss takes."""


@cache
def _steps() -> _Steps:
    """Make the programs of jaxopt, whose function returns the value and the slope that it is given."""
    package = jaxopt()

    def solver(length, value, slope):
        return package.LBFGSB(
            lambda unit: (value, slope),
            value_and_grad=True,
            history_size=MEMORY,
            stepsize=lambda _: length,
            implicit_diff=False,
        )

    def begun(box, units, values, slopes):
        def one(unit, value, slope):
            return solver(1.0, value, slope).init_state(unit, box)

        return jax.vmap(one)(units, values, slopes)

    def stepped(box, units, inner, lengths, values, slopes):
        def one(unit, state, length, value, slope):
            return tuple(solver(length, value, slope).update(unit, state, box))

        return jax.vmap(one)(units, inner, lengths, values, slopes)

    return _Steps(*(jax.jit(each, **jit_options(quick=True)) for each in (begun, stepped)))


def _searched(
    found: Callable[[Any, Any], _Found], state: _State, ends: Float[np.ndarray, "starts variables"]
) -> tuple[Float[np.ndarray, "starts variables"], Float[np.ndarray, " starts"], _Found]:
    """Shorten the steps from the units of a state to `ends` until losses fall by enough, in a few trials.

    `found` evaluates some starts, given their numbers and units. Returns units, lengths, and what was found there.
    """
    steps = ends - state.units
    foreseen = ENOUGH * np.sum(state.inner.grad * steps, axis=1)
    lengths, waiting = np.ones(len(steps)), np.arange(len(steps))
    units, values, slopes = ends.copy(), np.array(state.inner.value), np.array(state.inner.grad)
    for trial in range(TRIALS):
        units[waiting] = (state.units + lengths[:, None] * steps)[waiting]
        values[waiting], slopes[waiting] = found(waiting, units[waiting])
        waiting = waiting[(values > state.inner.value + lengths * foreseen)[waiting]]
        if not len(waiting) or trial == TRIALS - 1:
            break
        lengths[waiting] *= SHORTENED
    return units, lengths, _Found(values, slopes)


def _kept(new: _State, old: _State) -> _State:
    """Take the new state of the starts whose loss fell.

    A line search that fails leaves the point where it was, and the next one would fail alike: pairs of steps and
    gradients that led there are forgotten, and the slope followed with a shorter step.
    """
    better = new.inner.value < old.inner.value
    pairs = np.zeros_like(old.inner.s_history)
    anew = old.inner._replace(s_history=pairs, y_history=pairs, num_updates=0 * old.inner.num_updates)
    anew = anew._replace(theta=SHORTER * old.inner.theta)

    def kept(new, old):
        return np.where(better.reshape(better.shape + (1,) * (np.ndim(new) - 1)), new, old)

    return jax.tree.map(kept, new, _State(old.units, anew, old.scale))
