"""The ratio of the determinants of two Jacobians: a negative one tells that a singular pose lies between two poses.

Where two branches nearly meet, a long step of the continuation leads straight on to the other branch. Both ends are
closed poses; but between them a determinant has changed its sign.
"""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.gram import Matrix
from jaxkin.solve.system.equation_blocks import EquationBlock

Square = Float[Array, "n n poses"]

DIAGONAL = 0.1
"""Times the root of the unit of rounding and the squared norm of the Jacobian: added to the diagonal of the products of
Jacobians, so that rows or columns for which the Jacobian lacks rank do not decide the sign by rounding."""


def determinant_ratio(before: Matrix, after: Matrix, blocks: Sequence[EquationBlock]) -> Float[Array, "blocks poses"]:
    """The determinant of each block of the Jacobian `after` over that of `before`: negative where its sign changed.

    Both are (equations, columns, poses). A block that need not be square is compared by `det(J0^T J1) / det(J0^T J0)`,
    or by `det(J0 J1^T) / det(J0 J0^T)` if it has more columns than rows.
    """
    none = jnp.zeros((0, before.shape[-1]), before.dtype)
    ratios = [_block_ratio(before[np.ix_(*block)], after[np.ix_(*block)])[None] for block in blocks]
    return jnp.concatenate([none, *ratios])


def _block_ratio(before: Matrix, after: Matrix) -> Float[Array, " poses"]:
    rows, columns, _ = before.shape
    eps = float(jnp.finfo(before.dtype).eps)
    shift = DIAGONAL * eps**0.5 * jnp.einsum("eil,eil->l", before, before) + 1e-30
    diagonal = shift * jnp.eye(min(columns, rows), dtype=before.dtype)[..., None]

    def product(other: Matrix) -> Square:
        return jnp.einsum("eil,ejl->ijl" if columns < rows else "eil,fil->efl", before, other) + diagonal

    return ratio_of_determinants(product(after), product(before))


def ratio_of_determinants(one: Square, other: Square) -> Float[Array, " poses"]:
    """The determinants of `one` over those of `other`, both (n, n, poses).

    `other` is positive definite and `one` is near it, or has changed the sign of its determinant: elimination without
    pivoting does, and no library is called, whose import would take as long as a small sweep.
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
        # a ratio of pivots at a time: the determinants of large matrices would leave the range of numbers
        return jnp.pad(rest, ((0, 1), (0, 1), (0, 0))), ratio * (pivot[:poses] / pivot[poses:])

    return lax.fori_loop(0, n, eliminate, (both, jnp.ones(poses, one.dtype)))[1]
