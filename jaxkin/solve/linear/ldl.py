"""Solve (J J^T + damping s 1) y = r by L D L^T factorisation, written out as straight-line code.

J J^T + damping s 1 = L D L^T with L unit lower triangular and D diagonal. Every entry is an array over the poses, so
that vector units run through the poses; the matrix is positive definite, so no pivoting is needed. The compiled code
grows with the cube of the rows: for few rows only.
"""

from __future__ import annotations

from collections.abc import Callable

import jax.numpy as jnp
from jaxtyping import Array

from jaxkin.solve.linear.gram import Damping, Matrix, mean_square


def factor_ldl(jacobian: Matrix, damping: Damping) -> Callable[[Array], Array]:
    """Factorise, and return the function that solves for right-hand sides (rows, poses) or (rows, sides, poses)."""
    absolute = damping * mean_square(jnp.sum(jacobian * jacobian, axis=1))

    def entry(i: int, j: int) -> Array:
        own = jnp.sum(jacobian[i] * jacobian[j], axis=0)
        return own + absolute if i == j else own

    return factor_entries(entry, len(jacobian))


def factor_entries(entry: Callable[[int, int], Array], n: int) -> Callable[[Array], Array]:
    """Factorise a positive definite matrix by its entries (i, j), i >= j, of `n` rows; returns as `factor_ldl`."""
    lower: dict[tuple[int, int], Array] = {}
    upper: dict[tuple[int, int], Array] = {}
    pivots: list[Array] = []
    for j in range(n):
        column = [entry(i, j) - sum(lower[i, k] * upper[j, k] for k in range(j)) for i in range(j, n)]
        pivots.append(column[0])
        for i in range(j + 1, n):
            upper[i, j] = column[i - j]
            lower[i, j] = column[i - j] / pivots[j]

    def solve(right: Array) -> Array:
        y = list(right)
        for i in range(n):
            y[i] = y[i] - sum(lower[i, k] * y[k] for k in range(i))
        x = y
        # divide last: XLA takes a quotient for costly, and does not compute it again wherever it is used
        for i in reversed(range(n)):
            x[i] = (x[i] - sum(upper[k, i] * x[k] for k in range(i + 1, n))) / pivots[i]
        return jnp.stack(x)

    return solve
