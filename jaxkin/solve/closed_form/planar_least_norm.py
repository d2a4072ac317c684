"""Numbers of least norm of the unknown coordinates of planar loops: of any number of loops, in any pose.

Each loop has one equation for the rates of turn, and two for the velocity of the origin. Coordinates that turn add
their rates with signs that no pose changes, so that the equations of turn are solved beforehand. With R for these
signs, R^+ for its pseudo-inverse, and the columns of N for an orthonormal basis of what R maps to zero, the rates that
add up to the turns w are

    x = R^+ w + N y,

and the two equations a loop that are left are solved for the y of least norm, which is the norm of N y.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.linkage.first_order import IN_SUBGROUP
from jaxkin.solve.closed_form.arithmetic import Number
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.planar_twists import LoopTwists
from jaxkin.solve.linear.ldl import factor_entries
from jaxkin.solve.linear.least_norm import damping_floor
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem

STEPS = 2
"""The second solution is one step of iterative refinement, which removes the bias of the damping. Both are in a loop:
XLA would compute the equations anew for each of them, and take twice as long."""

Signs = tuple[tuple[int, ...], ...]
"""For each loop the sign with which each unknown turns as the loop is travelled; 0 for slides, and outside of it."""


class _Turns(NamedTuple):
    """The equations of turn, solved (static)."""

    particular: Float[np.ndarray, "unknowns loops"]
    """R^+."""
    basis: Float[np.ndarray, "unknowns rest"]
    """N."""


def least_norm_rates(
    system: LoopSystem, axes: AssembledAxes, columns: Sequence[int], loops: Mapping[int, LoopTwists]
) -> dict[int, Number]:
    """Solve for the rates of the unknown `columns` with which `loops`, by the numbers of their chains, stay closed.

    No loop has a column in two rows. Loops that cannot stay closed are left open as little as possible.
    """
    table = chain_tables(system)
    rows = {chain: {int(table.column[row, chain]): row for row in loop.screws} for chain, loop in loops.items()}
    travelled = {chain: [own.get(column) for column in columns] for chain, own in rows.items()}
    signs = tuple(
        tuple(0 if row is None else int(table.sign[row, chain] * table.turn[row, chain]) for row in own)
        for chain, own in travelled.items()
    )
    particular, basis = _solved_turns(signs)
    turns = [-loop.turn for loop in loops.values()]
    rates = [_combined(own, turns) for own in particular]
    equations, right, squares = [], [], float(np.sum(np.square(signs)))
    for chain, loop in loops.items():
        for component in range(2):
            # by the unknown as it turns about the normal of the plane, or slides along its direction
            velocities = [
                0.0 if row is None else float(table.sign[row, chain]) * loop.screws[row].velocity[component]
                for row in travelled[chain]
            ]
            squares = squares + sum(velocity * velocity for velocity in velocities)
            equations.append([_combined(own, velocities) for own in basis.T])
            right.append(-loop.velocity[component] - _product(velocities, rates))
    if basis.shape[1]:
        y = _least_norm(equations, right, squares / (IN_SUBGROUP * len(loops)))
        rates = [rate + _combined(own, y) for rate, own in zip(rates, basis, strict=True)]
    found = {}
    for column, rate in zip(columns, rates, strict=True):
        chain = next(chain for chain, own in rows.items() if column in own)
        row = rows[chain][column]
        found[column] = axes.sense[row, chain] * float(table.sign[row, chain]) * rate
    return found


def _least_norm(equations: Sequence[Sequence[Number]], right: Sequence[Number], mean_square: Number) -> list[Number]:
    """Solve with least norm; `mean_square` is that of all equations of the loops, those of turn included.

    A pose is singular where these are, as for the solver: the damping is relative to them. It is the algorithm of
    `least_norm.solve_least_norm_refined`, by entries: as arrays, whose sums XLA does not join with what the entries are
    made of, 10,000 poses of the paper's Fig. 7 took 10.8 ms in place of 2.0.
    """
    absolute = damping_floor(jnp.result_type(right[0])) * mean_square
    columns = list(zip(*equations, strict=True))

    def gram(i: int, j: int) -> Array:
        own = jnp.asarray(_product(equations[i], equations[j]))
        return own + absolute if i == j else own

    factored = factor_entries(gram, len(equations))

    def gram_times(y: Array) -> Array:
        x = [_product(column, list(y)) for column in columns]
        return jnp.stack([_product(row, x) + absolute * own for row, own in zip(equations, y, strict=True)])

    def refined(_: object, x: list[Number]) -> list[Number]:
        rest = jnp.stack([b - _product(row, x) for row, b in zip(equations, right, strict=True)])
        # a derivative solves the same system: the elimination is never differentiated
        y = lax.custom_linear_solve(gram_times, rest, lambda _, rest: factored(rest), symmetric=True)
        return [own + _product(column, list(y)) for own, column in zip(x, columns, strict=True)]

    if len(columns) == 1:  # a quotient
        (column,) = columns
        square = _product(column, column) + absolute
        y = _product(column, right) / square
        return [y + _product(column, [b - a * y for a, b in zip(column, right, strict=True)]) / square]
    return lax.fori_loop(0, STEPS, refined, [jnp.zeros_like(right[0])] * len(columns))


def _product(one: Sequence[Number], other: Sequence[Number]) -> Number:
    """Add up products."""
    return sum((a * b for a, b in zip(one, other, strict=True)), jnp.zeros(()))


def _combined(factors: np.ndarray, rows: Sequence[Number]) -> Number:
    """Add rows, each times a factor that is known, without those whose factor is zero."""
    return sum((float(factor) * row for factor, row in zip(factors, rows, strict=True) if factor), jnp.zeros(()))


@lru_cache(maxsize=256)
def _solved_turns(signs: Signs) -> _Turns:
    coefficients = np.array(signs, float)
    particular = np.linalg.pinv(coefficients)
    particular[np.abs(particular) < np.finfo(float).eps] = 0.0
    turning = np.array([any(own) for own in zip(*signs, strict=True)])
    _, _, rows = np.linalg.svd(coefficients[:, turning])
    left = rows[np.linalg.matrix_rank(coefficients) :].T
    slides = int(np.sum(~turning))
    # a slide is a column of N by itself, and no combination of several
    basis = np.zeros((len(turning), left.shape[1] + slides))
    basis[np.ix_(turning, np.arange(left.shape[1]))] = left
    basis[~turning, left.shape[1] :] = np.eye(slides)
    return _Turns(particular, basis)
