"""Compute the ratio of the determinants of two Jacobians: if it is negative, a singular pose lies between two poses.

Where two branches nearly meet, a long step of the continuation may lead straight on to the other branch. The poses at
both ends are closed, but the determinant of a block of the Jacobian has changed its sign between them.
"""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.gram import Matrix, column_products, row_products
from jaxkin.solve.system.equation_blocks import EquationBlock

Square = Float[Array, "n n poses"]

DIAGONAL = 0.1
"""Shift of the diagonal of the products of Jacobians, over the squared norm of the Jacobian times the root of the unit
of rounding. Without a shift, rounding decides the sign where the Jacobian lacks rank."""


def determinant_ratio(before: Matrix, after: Matrix, blocks: Sequence[EquationBlock]) -> Float[Array, "blocks poses"]:
    """Divide the determinant of each block of the Jacobian `after` by that of `before`: negative where the sign
    changed.

    Both Jacobians are (equations, columns, poses). Blocks need not be square: with J0 before and J1 after, the ratio is
    `det(J0^T J1) / det(J0^T J0)`, or `det(J0 J1^T) / det(J0 J0^T)` if there are at least as many columns as rows.
    """
    none = jnp.zeros((0, before.shape[-1]), before.dtype)
    ratios = [_block_ratio(before[np.ix_(*block)], after[np.ix_(*block)])[None] for block in blocks]
    return jnp.concatenate([none, *ratios])


def _block_ratio(before: Matrix, after: Matrix) -> Float[Array, " poses"]:
    """Compute the ratio of one block, (rows, columns, poses)."""
    rows, columns, _ = before.shape
    eps = float(jnp.finfo(before.dtype).eps)
    shift = DIAGONAL * eps**0.5 * jnp.sum(before**2, axis=(0, 1)) + 1e-30
    diagonal = shift * np.eye(min(columns, rows), dtype=before.dtype)[..., None]

    def product(other: Matrix) -> Square:
        return (column_products if columns < rows else row_products)(before, other) + diagonal

    return ratio_of_determinants(product(after), product(before))


def ratio_of_determinants(one: Square, other: Square) -> Float[Array, " poses"]:
    """Divide the determinants of `one` by those of `other`, both (n, n, poses).

    Elimination without pivoting suffices: `other` is positive definite, and `one` is near `other` or has a determinant
    of the other sign. A library routine is not used, because to import it takes as long as a small sweep.
    """
    n, _, poses = one.shape
    both = jnp.concatenate([one, other], axis=-1)
    if n == 3:
        a, b, c = both
        determinant = jnp.sum(a * jnp.cross(b, c, axis=0), axis=0)
        return determinant[:poses] / determinant[poses:]

    def eliminate(_, carry: tuple[Array, Array]) -> tuple[Array, Array]:
        matrix, ratio = carry
        pivot = matrix[0, 0]
        rest = matrix[1:, 1:] - matrix[1:, :1] * (matrix[0, 1:] / pivot)
        # multiply ratios of pivots one by one: determinants of large matrices would overflow or underflow
        return jnp.pad(rest, ((0, 1), (0, 1), (0, 0))), ratio * (pivot[:poses] / pivot[poses:])

    return lax.fori_loop(0, n, eliminate, (both, jnp.ones(poses, one.dtype)))[1]
