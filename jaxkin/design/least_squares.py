"""Levenberg-Marquardt steps within bounds, for sums of squares."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jax.extend.core import jaxpr_as_fun
from jaxtyping import Bool, Float

from jaxkin.design.augmented_lagrangian import Penalty, Verdict
from jaxkin.design.problem import HOPELESS, Problem, ProgramKey, WeightedResiduals, taken_apart
from jaxkin.design.solvers import CHUNK, KEPT, TOGETHER, Solver, in_groups, unit_box
from jaxkin.solve.execution.two_tiers import TwoTiers
from jaxkin.solve.lockstep import in_lockstep

FIRST_DAMPING = 1e-3
"""Damping of the first step, relative to the largest diagonal entry of J^T J."""
LEAST_DAMPING = 1e-16
"""Least damping of a step, relative to the same."""
MOST = 100 * HOPELESS
"""Largest residual and violation. Shifts of what is not known grow by `HOPELESS` with each search: cut off there, what
constraints lack would be zero in the second one."""
MAX_HOLDS = 3
"""How often a step is computed anew at most, with the variables held at whose bounds it would leave the box."""


class _State(NamedTuple):
    units: Float[np.ndarray, "starts variables"]
    """0 at the lower bounds, 1 at the upper ones."""
    residuals: Float[np.ndarray, "starts rows"]
    jacobian: Float[np.ndarray, "starts rows variables"]
    damping: Float[np.ndarray, " starts"]
    """What is added to the diagonal of J^T J; in float64 always, since refused steps raise it beyond all float32."""
    growth: Float[np.ndarray, " starts"]
    """What the damping is multiplied by if the next step is refused."""


def least_squares(problem: Problem, together: int = TOGETHER) -> Solver:
    """Make the solver by Levenberg-Marquardt steps with projection: of the variables that no bound holds.

    One program is compiled, residuals and Jacobian of `together` designs; the small systems are solved in numpy.
    """
    dtype = dtypes.canonicalize_dtype(float)
    lower, width = (np.asarray(each, dtype) for each in unit_box(problem.variables))
    key, numbers = taken_apart(problem)
    program = _program(key, together).search()

    def found(units, penalty) -> tuple[WeightedResiduals, np.ndarray]:
        given = jax.tree.map(lambda leaf: np.asarray(leaf, dtype), (units, penalty))
        return in_groups(lambda group: program(numbers, *group), together, given)

    def evaluated(units, penalty):
        weighted, jacobian = found(units, penalty)
        return np.concatenate(weighted, axis=1), np.where(np.isfinite(jacobian), jacobian, 0.0)

    def units_of(vectors):
        return np.clip((np.asarray(vectors) - lower) / np.where(width > 0, width, 1.0), 0.0, 1.0)

    def begin(vectors, penalty):
        units = units_of(vectors)
        residuals, jacobian = evaluated(units, penalty)
        damping = FIRST_DAMPING * _largest(jacobian).astype(np.float64) + 1e-300
        return _State(units, residuals, jacobian, damping, np.full(len(units), 2.0))

    def advance(state, penalty, active):
        losses = np.full((CHUNK, len(active)), np.nan)
        chosen = np.flatnonzero(active)
        now, of_now = jax.tree.map(lambda each: each[chosen], (state, penalty))
        for row in losses:
            units, foreseen = _proposed(now)
            now = _accepted(now, units, foreseen, *evaluated(units, of_now))
            row[chosen] = _loss(now.residuals)
        whole = [each.copy() for each in state]
        for each, part in zip(whole, now, strict=True):
            each[chosen] = part
        return _State(*whole), losses

    def unknown(vectors, penalty):
        weighted, jacobian = found(units_of(vectors), penalty)
        known_rows = np.abs(np.concatenate(weighted, axis=1)) < HOPELESS
        return np.any(known_rows[:, :, None] & ~np.isfinite(jacobian), axis=1)

    def judge(vectors, shifts):
        rows, gaps, charged = map(np.asarray, found(units_of(vectors), Penalty(np.ones(len(vectors)), shifts))[0])
        losses = np.where(np.any(np.abs(rows) >= HOPELESS, axis=1), np.nan, np.sum(rows**2, axis=1))
        return Verdict(losses, gaps, charged, shifts)

    return Solver(
        begin,
        advance,
        lambda state: np.asarray(lower + width * state.units),
        lambda state: np.max(np.abs(state.jacobian), axis=1),
        unknown,
        judge,
    )


@lru_cache(maxsize=KEPT)
def _program(key: ProgramKey, together: int) -> TwoTiers:
    """Make the program of a problem of this key: residuals of designs, violations weighted, and the Jacobian."""
    del together  # a program is compiled for its number of designs

    def program(numbers, units, penalties):
        problem: Problem = key.problem.unflatten(numbers)
        lower, width = unit_box(problem.variables)

        def one(unit, penalty):
            def weighted(unit):
                return problem.judge(lower + width * unit).weighted(penalty)

            # operations are traced once, and then mapped and differentiated: in place of all functions of JAX, each
            # of which is a program to be mapped and differentiated by itself
            operations, shapes = jax.make_jaxpr(weighted, return_shape=True)(unit)

            def along(direction):
                return jax.jvp(jaxpr_as_fun(operations), (unit,), (direction,))

            found, slopes = jax.vmap(along, out_axes=(None, -1))(jnp.eye(unit.size, dtype=unit.dtype))
            found = jax.tree.structure(shapes).unflatten(found)
            found = jax.tree.map(lambda rows: jnp.clip(jnp.nan_to_num(rows, nan=HOPELESS), -MOST, MOST), found)
            return found, jnp.concatenate(slopes)

        return in_lockstep(one, (0, 0))(units, penalties)

    return TwoTiers(program)


def _loss(residuals: Float[np.ndarray, "starts rows"]) -> Float[np.ndarray, " starts"]:
    return np.sum(residuals**2, axis=1)


def _largest(jacobian: Float[np.ndarray, "starts rows variables"]) -> Float[np.ndarray, " starts"]:
    """Find the largest diagonal entry of J^T J."""
    return np.max(np.sum(jacobian**2, axis=1), axis=1)


def _proposed(state: _State) -> tuple[Float[np.ndarray, "starts variables"], Float[np.ndarray, " starts"]]:
    """Compute where the next step leads, and the decrease of the loss that the linearised residuals foresee."""
    jacobian = state.jacobian.astype(np.float64)  # as the damping is: see `_State.damping`
    square = np.einsum("sri,srj->sij", jacobian, jacobian)
    slope = np.einsum("sri,sr->si", jacobian, state.residuals)
    at_lower, at_upper = state.units <= 0.0, state.units >= 1.0
    held = at_lower & (slope > 0) | at_upper & (slope < 0)
    step = _step(square, slope, state.damping, held)
    for _ in range(MAX_HOLDS):
        leaving = at_lower & (step < 0) | at_upper & (step > 0)
        if not leaving.any():
            break
        held |= leaving
        step = _step(square, slope, state.damping, held)
    units = np.clip(state.units + step, 0.0, 1.0)
    step = units - state.units
    return units, -np.sum(step * (2 * slope + np.einsum("sij,sj->si", square, step)), axis=1)


def _step(square, slope, damping, held: Bool[np.ndarray, "starts variables"]) -> Float[np.ndarray, "starts variables"]:
    """Solve (J^T J + damping) step = -J^T r for the variables that are not held; zero for the others."""
    size = held.shape[1]
    matrix = np.where(held[:, :, None] | held[:, None, :], 0.0, square)
    matrix[:, range(size), range(size)] += np.where(held, 1.0, damping[:, None])
    return np.linalg.solve(matrix, np.where(held, 0.0, -slope)[..., None])[..., 0]


def _accepted(state: _State, units, foreseen, residuals, jacobian) -> _State:
    """Take the steps that lower the loss, and choose the damping by how well the decrease was foreseen (Nielsen)."""
    gained = _loss(state.residuals) - _loss(residuals)
    better = gained > 0
    share = np.where(foreseen > 0, gained / np.where(foreseen > 0, foreseen, 1.0), 0.0)
    easier = state.damping * np.maximum(1 / 3, 1 - (2 * np.clip(share, 0.0, 1.0) - 1) ** 3)
    harder = np.minimum(state.damping * state.growth, 1e100)

    def kept(new, old):
        return np.where(better.reshape(-1, *(1,) * (new.ndim - 1)), new, old)

    found = _State(
        units=kept(units, state.units),
        residuals=kept(residuals, state.residuals),
        jacobian=kept(jacobian, state.jacobian),
        damping=np.where(better, easier, harder),
        growth=np.where(better, 2.0, np.minimum(2 * state.growth, 1e100)),
    )
    return found._replace(damping=np.maximum(found.damping, LEAST_DAMPING * _largest(found.jacobian) + 1e-300))
