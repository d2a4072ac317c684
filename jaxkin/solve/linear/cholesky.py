"""Solve (J J^T + damping s 1) y = r by Cholesky factorisation, J J^T + damping s 1 = L L^T, with the library's routine.

A library is faster for many rows, but takes longer to load than smaller systems take to sweep.
"""

from __future__ import annotations

from collections.abc import Callable

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array

from jaxkin.solve.linear.gram import Damping, Matrix, add_damping, gram_matrix

ROUNDING_MARGIN = 0.25
"""Damping that is added, in units of rounding a row: without it rounding may make J J^T indefinite and the square root
of a pivot fail."""


def factor_cholesky(jacobian: Matrix, damping: Damping) -> Callable[[Array], Array]:
    """Factorise, and return the solution for right-hand sides of (rows, poses) or (rows, sides, poses)."""
    n = jacobian.shape[0]
    gram = add_damping(gram_matrix(jacobian), damping + ROUNDING_MARGIN * n * float(jnp.finfo(jacobian.dtype).eps))
    lower = lax.linalg.cholesky(jnp.moveaxis(gram, -1, 0), symmetrize_input=False)

    def solve(right: Array) -> Array:
        sides = jnp.moveaxis(right.reshape(n, -1, right.shape[-1]), -1, 0)
        for transposed in (False, True):
            sides = lax.linalg.triangular_solve(lower, sides, left_side=True, lower=True, transpose_a=transposed)
        return jnp.moveaxis(sides, 0, -1).reshape(right.shape)

    return solve
