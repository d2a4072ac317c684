"""Solve (J J^T + damping s 1) y = r by Gauss-Jordan elimination, in a compiled loop over the rows.

The matrix is positive definite, so no pivoting is needed. Larger systems are halved first (block elimination with the
Schur complement of the upper left half), which turns most of the work into products of matrices.
"""

from __future__ import annotations

from collections.abc import Callable

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.gram import Damping, Matrix, add_damping, gram_matrix

MAX_GAUSS_JORDAN_ROWS = 8
"""Largest number of rows that are eliminated row by row. Larger systems are halved first: the 22 rows of the paper's
Fig. 7 at 32 poses take 110 us without halving, 52 us with halves of eleven, 28 us with quarters, which take a quarter
of a second more to compile; 12 rows take 20 and 9 us."""


def factor_gauss_jordan(jacobian: Matrix, damping: Damping) -> Callable[[Array], Array]:
    """Return the function that solves for right-hand sides of (rows, poses) or (rows, sides, poses).

    Each call of that function eliminates anew, together with its right-hand sides.
    """
    n = jacobian.shape[0]
    gram = add_damping(gram_matrix(jacobian), damping)

    def solve(right: Array) -> Array:
        sides = right.reshape(n, -1, right.shape[-1])
        return _eliminate(jnp.concatenate([gram, sides], axis=1)).reshape(right.shape)

    return solve


def _eliminate(matrix: Float[Array, "rows more poses"]) -> Float[Array, "rows sides poses"]:
    """Solve the square systems A y = b given as [A | b], with `sides` columns of b."""
    n = len(matrix)
    if n > MAX_GAUSS_JORDAN_ROWS:
        half = n // 2
        upper = _eliminate(matrix[:half])
        lower = _eliminate(matrix[half:, half:] - _product(matrix[half:, :half], upper))
        return jnp.concatenate([upper[:, n - half :] - _product(upper[:, : n - half], lower), lower])

    def eliminate(_, matrix: Array) -> Array:
        # the first row and column are finished and roll to the end: under `vmap` a moving index would become a gather
        pivot = matrix[0, 1:] / matrix[0, 0]
        rest = matrix[1:, 1:] - matrix[1:, :1] * pivot
        return jnp.pad(jnp.concatenate([rest, pivot[None]]), ((0, 0), (0, 1), (0, 0)))

    return lax.fori_loop(0, n, eliminate, matrix)[:, : matrix.shape[1] - n]


def _product(a: Float[Array, "rows inner poses"], b: Float[Array, "inner columns poses"]) -> Array:
    """Multiply two matrices, pose by pose."""
    return jnp.sum(a[:, :, None] * b[None], axis=1)
