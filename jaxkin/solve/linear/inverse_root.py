"""Compute inverse roots of positive definite matrices, at every pose: R M R^T = 1, with R lower triangular.

No routine of a library: on few cores two of those that do not wait for each other may wait for a thread for ever.
"""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.solve.linear.gram import product, row_products

MAX_UNHALVED_ROWS = 3
"""Largest number of rows that straight-line code factorises at once. More are halved, which turns most of the work into
products of matrices."""

Square = Float[Array, "n n poses"]


def inverse_root(matrix: Square) -> Square:
    """Compute R in each pose."""
    if len(matrix) <= MAX_UNHALVED_ROWS:
        return _unrolled(matrix)
    half = len(matrix) // 2
    upper = inverse_root(matrix[:half, :half])
    across = row_products(matrix[half:, :half], upper)
    lower = inverse_root(matrix[half:, half:] - row_products(across, across))
    left = -product(lower, product(across, upper))
    none = jnp.zeros_like(matrix[:half, half:])
    return jnp.concatenate([jnp.concatenate([upper, none], axis=1), jnp.concatenate([left, lower], axis=1)])


def _unrolled(matrix: Square) -> Square:
    """Factorise M = C C^T by Cholesky's method, and invert C."""
    n = len(matrix)
    lower: dict[tuple[int, int], Array] = {}
    found: dict[tuple[int, int], Array] = {}
    for j in range(n):
        column = [matrix[i, j] - sum(lower[i, k] * lower[j, k] for k in range(j)) for i in range(j, n)]
        found[j, j] = 1.0 / jnp.sqrt(column[0])
        for i in range(j + 1, n):
            lower[i, j] = column[i - j] * found[j, j]
    for j in range(n):
        for i in range(j + 1, n):
            found[i, j] = -found[i, i] * sum(lower[i, k] * found[k, j] for k in range(j, i))
    none = jnp.zeros_like(matrix[:1, 0])
    rows = [jnp.concatenate([found[i, j][None] if i >= j else none for j in range(n)]) for i in range(n)]
    return jnp.stack(rows)
