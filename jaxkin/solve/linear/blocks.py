"""Solve block lower triangular systems by forward substitution.

A block is solved with least norm, or by Cramer's rule if it is square, regular and of size three. The blocks of a
closure Jacobian are those of `solve.system.equation_blocks`.
"""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.solve.linear.cramer import solve_three
from jaxkin.solve.linear.gram import Matrix, Vector, column_products
from jaxkin.solve.linear.least_norm import MAX_UNROLLED_ROWS, factor_normal_equations, solve_least_norm_refined
from jaxkin.solve.system.equation_blocks import EquationBlock
from jaxkin.solve.system.scatter import scatter_rows


def solve_blocks(
    jacobian: Matrix, right: Vector, damping: float, blocks: Sequence[EquationBlock], *, regular: bool = False
) -> Array:
    """Solve J x = r block after block at every pose; returns x (columns, poses), which must not be differentiated.

    Each block gets its solution of least norm, with `damping` relative to the mean square of its rows. With `regular`,
    blocks of three equations in three unknowns are solved undamped by Cramer's rule, which costs less.
    """
    return _substitute_forward(jacobian, right[:, None], damping, blocks, regular)[:, 0]


def solve_blocks_refined(jacobian: Matrix, right: Vector, damping: float, blocks: Sequence[EquationBlock]) -> Array:
    """Solve J x = r block after block at every pose, each with least norm; returns x (columns, poses).

    Unlike that of `solve_blocks`, the solution may be differentiated, and one step of iterative refinement removes the
    bias of the damping.
    """
    known: list[int] = []
    found = jnp.zeros((0, right.shape[1]), right.dtype)
    for block in blocks:
        rest = right[np.array(block.rows)]
        if known:
            rest = rest - jnp.sum(jacobian[np.ix_(block.rows, known)] * found, axis=1)
        own = jacobian[np.ix_(block.rows, block.columns)]
        found = jnp.concatenate([found, solve_least_norm_refined(own, rest, damping, range(len(block.columns)))])
        known += block.columns
    return scatter_rows(found, known, jacobian.shape[1])


def is_costly(blocks: Sequence[EquationBlock]) -> bool:
    """Tell whether a block has more equations than straight-line code solves: it pays to save an elimination then."""
    return any(len(block.rows) > MAX_UNROLLED_ROWS for block in blocks)


def inverse_jacobian(
    jacobian: Matrix, damping: float, blocks: Sequence[EquationBlock]
) -> Float[Array, "poses columns rows"]:
    """Compute the matrix by which `solve_blocks(..., regular=True)` multiplies right-hand sides."""
    rows, _, poses = jacobian.shape
    unit = jnp.broadcast_to(jnp.eye(rows, dtype=jacobian.dtype)[..., None], (rows, rows, poses))
    return jnp.moveaxis(_substitute_forward(jacobian, unit, damping, blocks, True), -1, 0)


def _substitute_forward(
    jacobian: Matrix,
    right: Float[Array, "rows sides poses"],
    damping: float,
    blocks: Sequence[EquationBlock],
    regular: bool,
) -> Array:
    """Solve for several right-hand sides by forward substitution: (columns, sides, poses)."""
    known: list[int] = []
    found = jnp.zeros((0, *right.shape[1:]), right.dtype)
    for block in blocks:
        rest = right[np.array(block.rows)]
        if known:
            rest = rest - jnp.sum(jacobian[np.ix_(block.rows, known)][:, :, None] * found, axis=1)
        own = jacobian[np.ix_(block.rows, block.columns)]
        if regular and own.shape[:2] == (3, 3):
            here = solve_three(own, rest)
        else:
            here = column_products(own, factor_normal_equations(own, damping)(rest))
        found = jnp.concatenate([found, here])
        known += block.columns
    return scatter_rows(found, known, jacobian.shape[1])
