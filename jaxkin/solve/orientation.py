"""Whether a step has passed a singular pose: the Jacobian has turned over on its way.

Where two branches nearly meet a long step goes straight on to the other one; both are closed, but between them a
determinant has changed its sign.
"""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.blocks import Block
from jaxkin.solve.linear import Matrix


def turned_over(before: Matrix, after: Matrix, blocks: Sequence[Block]) -> Bool[Array, " poses"]:
    """Whether the determinant of any block of the Jacobian has changed its sign, or what takes its place.

    Where a block is not square that is `det(J0^T J1)`, or `det(J0 J1^T)`, which has the same sign; a little on the
    diagonal makes columns, or rows, count for which the Jacobian lacks rank.
    """
    found = jnp.zeros(before.shape[-1], bool)
    for block in blocks:
        found |= _turned_over(before[np.ix_(*block)], after[np.ix_(*block)])
    return found


def _turned_over(before: Matrix, after: Matrix) -> Bool[Array, " poses"]:
    rows, columns, _ = before.shape
    product = jnp.einsum("eil,ejl->ijl" if columns < rows else "eil,fil->efl", before, after)
    eps = float(jnp.finfo(before.dtype).eps)
    little = 0.1 * eps**0.5 * jnp.einsum("eil,eil->l", before, before) + 1e-30
    return is_turned_over(product + little * jnp.eye(min(columns, rows), dtype=before.dtype)[..., None])


def is_turned_over(matrix: Float[Array, "rows rows poses"]) -> Bool[Array, " poses"]:
    """Whether the determinants are negative, of matrices that are positive definite but where they have turned over.

    Such need no pivoting; and no library, whose import would take as long as a small sweep.
    """
    n = matrix.shape[0]
    if n == 3:
        a, b, c = matrix
        return jnp.sum(a * jnp.cross(b, c, axis=0), axis=0) < 0

    def eliminate(k: Array | int, carry: tuple[Array, Array]) -> tuple[Array, Array]:
        matrix, negative = carry
        pivot = lax.dynamic_index_in_dim(matrix, k, axis=0, keepdims=False)
        column = lax.dynamic_index_in_dim(matrix, k, axis=1, keepdims=False)
        diagonal = lax.dynamic_index_in_dim(column, k, axis=0, keepdims=False)
        factor = jnp.where(jnp.arange(n)[:, None] > k, column / diagonal, 0.0)
        return matrix - factor[:, None] * pivot[None], negative ^ (diagonal < 0)

    return lax.fori_loop(0, n, eliminate, (matrix, jnp.zeros(matrix.shape[-1], bool)))[1]
