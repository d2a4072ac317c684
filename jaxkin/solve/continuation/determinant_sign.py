"""How the Jacobian has turned on the way from one pose to another: whether a singular pose lies between them.

Where two branches nearly meet a long step goes straight on to the other one; both are closed, but between them a
determinant has changed its sign.
"""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.least_norm import Matrix
from jaxkin.solve.system.equation_blocks import EquationBlock

Square = Float[Array, "n n poses"]


def turned(before: Matrix, after: Matrix, blocks: Sequence[EquationBlock]) -> Float[Array, "blocks poses"]:
    """The determinant of each block of the Jacobian over the one before: negative where it has changed its sign.

    Where a block is not square those of `J0^T J1` and `J0^T J0`, or of `J0 J1^T` and `J0 J0^T`; a little on the
    diagonal makes columns, or rows, count for which the Jacobian lacks rank.
    """
    found = jnp.zeros((0, before.shape[-1]), before.dtype)
    return jnp.concatenate([found, *(_turned(before[np.ix_(*block)], after[np.ix_(*block)])[None] for block in blocks)])


def _turned(before: Matrix, after: Matrix) -> Float[Array, " poses"]:
    rows, columns, _ = before.shape
    eps = float(jnp.finfo(before.dtype).eps)
    little = 0.1 * eps**0.5 * jnp.einsum("eil,eil->l", before, before) + 1e-30
    diagonal = little * jnp.eye(min(columns, rows), dtype=before.dtype)[..., None]

    def product(other: Matrix) -> Square:
        return jnp.einsum("eil,ejl->ijl" if columns < rows else "eil,fil->efl", before, other) + diagonal

    return ratio_of_determinants(product(after), product(before))


def ratio_of_determinants(one: Square, other: Square) -> Float[Array, " poses"]:
    """Those of matrices that are positive definite, but for the first where it has turned over.

    Such need no pivoting; and no library, whose import would take as long as a small sweep.
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
        # the first row and column are done with; the determinants of large matrices would leave the range of numbers
        return jnp.pad(rest, ((0, 1), (0, 1), (0, 0))), ratio * (pivot[:poses] / pivot[poses:])

    return lax.fori_loop(0, n, eliminate, (both, jnp.ones(poses, one.dtype)))[1]
