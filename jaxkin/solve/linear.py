"""Least-norm solution of many small linear systems at once.

Closure equations are often redundant (parallel axes, several contacts of one pair) and coordinates idle (the spin of a
rod between two balls). `x = J^T (J J^T + damping)^-1 r` is defined in both cases, and lies in the row space of J by
construction: rounding never sets an idle coordinate in motion, as it does in the normal equations of the other form.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

FEW, UNROLLED, MANY = 3, 9, 1024
"""Up to so many rows, and from so many poses on, straight-line code over the poses is faster than a loop; for
fewer poses it is not worth the time that it takes to compile, but for so few rows as one planar loop has."""
PICKED = 0.75
"""If no more of the columns are used they are picked: to carry a few zeros along costs less."""

Matrix = Float[Array, "rows columns poses"]
Vector = Float[Array, "rows poses"]


def least_norm(
    jacobian: Matrix, right: Vector, damping: Float[Array, " poses"], used: Sequence[int], *, refine: bool = False
) -> Array:
    """The x of least norm that minimises |J x - r|^2 + damping |x|^2, for every pose: (columns, poses).

    All columns but those `used` are zero. With `refine` one step of iterative refinement takes the bias of the damping
    out.
    """
    _, columns, poses = jacobian.shape
    if len(used) < PICKED * columns:
        which = np.array(used, np.int32)
        few = least_norm(jacobian[:, which], right, damping, range(len(used)), refine=refine)
        return jnp.zeros((columns, poses), few.dtype).at[which].set(few, unique_indices=True)
    factored = _factored(jacobian, damping)

    def transposed(y: Vector) -> Array:
        return jnp.sum(jacobian * y[:, None], axis=0)

    def forward(x: Array) -> Vector:
        return jnp.sum(jacobian * x[None], axis=1)

    def solve(right: Vector) -> Vector:
        # derivatives are solutions of the same system, too: nothing differentiates the elimination
        return lax.custom_linear_solve(
            lambda y: forward(transposed(y)) + damping * y, right, lambda _, right: factored(right), symmetric=True
        )

    x = transposed(solve(right))
    if refine:
        x = x + transposed(solve(right - forward(x)))
    return x


def inverse(
    jacobian: Matrix, damping: Float[Array, " poses"], used: Sequence[int]
) -> Float[Array, "poses columns rows"]:
    """What `least_norm` multiplies right-hand sides by."""
    rows, columns, poses = jacobian.shape
    which = np.array(used, np.int32)
    unit = jnp.broadcast_to(jnp.eye(rows, dtype=jacobian.dtype)[..., None], (rows, rows, poses))
    found = jnp.einsum("rcp,rkp->pck", jacobian[:, which], _factored(jacobian[:, which], damping)(unit))
    return jnp.zeros((poses, columns, rows), found.dtype).at[:, which].set(found, unique_indices=True)


def is_turned_over(matrix: Float[Array, "rows rows poses"]) -> Bool[Array, " poses"]:
    """Whether the determinants are negative, of matrices that are positive definite but where they have turned over.

    Such need no pivoting; and no library, whose import would take as long as a small sweep.
    """
    n = matrix.shape[0]

    def eliminate(k: Array | int, carry: tuple[Array, Array]) -> tuple[Array, Array]:
        matrix, negative = carry
        pivot = lax.dynamic_index_in_dim(matrix, k, axis=0, keepdims=False)
        column = lax.dynamic_index_in_dim(matrix, k, axis=1, keepdims=False)
        diagonal = lax.dynamic_index_in_dim(column, k, axis=0, keepdims=False)
        factor = jnp.where(jnp.arange(n)[:, None] > k, column / diagonal, 0.0)
        return matrix - factor[:, None] * pivot[None], negative ^ (diagonal < 0)

    return lax.fori_loop(0, n, eliminate, (matrix, jnp.zeros(matrix.shape[-1], bool)))[1]


def scale(jacobian: Matrix) -> Float[Array, " poses"]:
    """Mean square of the rows of J: what a damping is measured by; one where nothing moves the loops."""
    square = jnp.sum(jacobian * jacobian, axis=(0, 1)) / jacobian.shape[0]
    return jnp.where(square > 0, square, 1.0)


def _factored(jacobian: Matrix, damping: Float[Array, " poses"]) -> Callable[[Array], Array]:
    """The solution of (J J^T + damping) y = r, for right-hand sides of shape (rows, poses) or (rows, number, poses)."""
    rows, _, poses = jacobian.shape
    straight = rows <= FEW or (rows <= UNROLLED and poses >= MANY)
    return (_unrolled if straight else _looped)(jacobian, damping)


def _unrolled(jacobian: Matrix, damping: Float[Array, " poses"]):
    """L D L^T of J J^T + damping, every entry an array over the poses."""
    n = jacobian.shape[0]
    lower: dict[tuple[int, int], Array] = {}
    pivots: list[Array] = []
    for j in range(n):
        column = [jnp.sum(jacobian[i] * jacobian[j], axis=0) for i in range(j, n)]
        column = [
            entry - sum(lower[i, k] * lower[j, k] * pivots[k] for k in range(j)) for i, entry in enumerate(column, j)
        ]
        pivots.append(column[0] + damping)
        for i in range(j + 1, n):
            lower[i, j] = column[i - j] / pivots[j]

    def solve(right: Array) -> Array:
        y = list(right)
        for i in range(n):
            y[i] = y[i] - sum(lower[i, k] * y[k] for k in range(i))
        x = [entry / pivot for entry, pivot in zip(y, pivots, strict=True)]
        for i in reversed(range(n)):
            x[i] = x[i] - sum(lower[k, i] * x[k] for k in range(i + 1, n))
        return jnp.stack(x)

    return solve


def _looped(jacobian: Matrix, damping: Float[Array, " poses"]):
    """The same by Gauss-Jordan elimination in a loop. The matrix is positive definite: it needs no pivoting."""
    n = jacobian.shape[0]
    gram = jnp.sum(jacobian[:, None] * jacobian[None], axis=2) + damping * jnp.eye(n, dtype=damping.dtype)[..., None]

    def solve(right: Array) -> Array:
        def eliminate(k: Array | int, matrix: Array) -> Array:
            pivot = lax.dynamic_index_in_dim(matrix, k, axis=0, keepdims=False)
            column = lax.dynamic_index_in_dim(matrix, k, axis=1, keepdims=False)
            pivot = pivot / lax.dynamic_index_in_dim(column, k, axis=0, keepdims=False)
            return lax.dynamic_update_index_in_dim(matrix - column[:, None] * pivot[None], pivot, k, axis=0)

        sides = right.reshape(n, -1, right.shape[-1])
        return lax.fori_loop(0, n, eliminate, jnp.concatenate([gram, sides], axis=1))[:, n:].reshape(right.shape)

    return solve
