"""Least-norm solution of many small linear systems at once.

Closure equations are often redundant (parallel axes, several contacts of one pair) and coordinates idle (the spin of a
rod between two balls). `x = J^T (J J^T + damping)^-1 r` is defined in both cases, and lies in the row space of J by
construction: rounding never sets an idle coordinate in motion, as it does in the normal equations of the other form.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax.scipy.linalg import cho_solve
from jaxtyping import Array, Float

UNROLLED = 9
"""Up to this many rows straight-line code over the poses is 8 to 27 times faster than batched library calls."""

Matrix = Float[Array, "rows columns poses"]
Vector = Float[Array, "rows poses"]


def least_norm(jacobian: Matrix, right: Vector, damping: Float[Array, " poses"], refine: bool = False) -> Array:
    """The x of least norm that minimises |J x - r|^2 + damping |x|^2, for every pose: (columns, poses).

    With `refine` one step of iterative refinement takes the bias of the damping out.
    """
    rows = jacobian.shape[0]
    gram = [[jnp.sum(jacobian[i] * jacobian[k], axis=0) for k in range(i + 1)] for i in range(rows)]
    for i in range(rows):
        gram[i][i] = gram[i][i] + damping
    solve = _unrolled(gram) if rows <= UNROLLED else _library(gram)

    def transposed(y: Vector) -> Array:
        return jnp.sum(jacobian * y[:, None], axis=0)

    x = transposed(solve(right))
    if refine:
        x = x + transposed(solve(right - jnp.sum(jacobian * x[None], axis=1)))
    return x


def scale(jacobian: Matrix) -> Float[Array, " poses"]:
    """Mean square of the rows of J: what a damping is measured by."""
    return jnp.sum(jacobian * jacobian, axis=(0, 1)) / jacobian.shape[0]


def _unrolled(gram: list[list[Array]]):
    """L D L^T of a symmetric matrix given by its lower half, every entry an array over the poses."""
    n = len(gram)
    lower: dict[tuple[int, int], Array] = {}
    pivots: list[Array] = []
    for j in range(n):
        pivots.append(gram[j][j] - sum(lower[j, k] ** 2 * pivots[k] for k in range(j)))
        for i in range(j + 1, n):
            entry = gram[i][j] - sum(lower[i, k] * lower[j, k] * pivots[k] for k in range(j))
            lower[i, j] = entry / pivots[j]

    def solve(right: Vector) -> Vector:
        y = list(right)
        for i in range(n):
            y[i] = y[i] - sum(lower[i, k] * y[k] for k in range(i))
        x = [entry / pivot for entry, pivot in zip(y, pivots, strict=True)]
        for i in reversed(range(n)):
            x[i] = x[i] - sum(lower[k, i] * x[k] for k in range(i + 1, n))
        return jnp.stack(x)

    return solve


def _library(gram: list[list[Array]]):
    """The same through the batched Cholesky decomposition."""
    n = len(gram)
    full = jnp.stack([jnp.stack([gram[max(i, k)][min(i, k)] for k in range(n)]) for i in range(n)])
    factor = jnp.linalg.cholesky(jnp.moveaxis(full, -1, 0))

    def solve(right: Vector) -> Vector:
        return jnp.moveaxis(cho_solve((factor, True), jnp.moveaxis(right, -1, 0)[..., None])[..., 0], 0, -1)

    return solve
