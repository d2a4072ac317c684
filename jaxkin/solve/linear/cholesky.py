"""Solve (J J^T + damping s 1) y = r by Cholesky factorisation, J J^T + damping s 1 = L L^T, by a library routine.

The library is faster for many rows, but to load it takes longer than the sweep of a system with few rows.
"""

from __future__ import annotations

from collections.abc import Callable

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.gram import Damping, Matrix, add_damping, gram_matrix

ROUNDING_MARGIN = 0.25
"""Further damping, in units of rounding times the number of rows: without it, rounding may make J J^T indefinite, and
the square root of a pivot fail."""


def factor_cholesky(jacobian: Matrix, damping: Damping) -> Callable[[Array], Array]:
    """Factorise, and return the function that solves for right-hand sides (rows, poses) or (rows, sides, poses)."""
    n = jacobian.shape[0]
    gram = add_damping(gram_matrix(jacobian), damping + ROUNDING_MARGIN * n * float(jnp.finfo(jacobian.dtype).eps))
    return factor_by_library(gram)


def factor_by_library(matrix: Float[Array, "n n poses"]) -> Callable[[Array], Array]:
    """Factorise positive definite matrices, and return the function that solves as that of `factor_cholesky`."""
    n = len(matrix)
    lower = lax.linalg.cholesky(jnp.moveaxis(matrix, -1, 0), symmetrize_input=False)

    def solve(right: Array) -> Array:
        sides = jnp.moveaxis(right.reshape(n, -1, right.shape[-1]), -1, 0)
        for transposed in (False, True):
            sides = lax.linalg.triangular_solve(lower, sides, left_side=True, lower=True, transpose_a=transposed)
        return jnp.moveaxis(sides, 0, -1).reshape(right.shape)

    return solve
