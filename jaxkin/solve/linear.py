"""Least-norm solution of many small linear systems at once.

Closure equations are often redundant (parallel axes, several contacts of one pair) and coordinates idle (the spin of a
rod between two balls). `x = J^T (J J^T + damping)^-1 r` is defined in both cases, and lies in the row space of J by
construction: rounding never sets an idle coordinate in motion, as it does in the normal equations of the other form.
Where loops follow from one another, so do their systems: see `blocks`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.blocks import Block

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
    columns = jacobian.shape[1]
    if len(used) < PICKED * columns:
        which = np.array(used, np.int32)
        few = least_norm(jacobian[:, which], right, damping, range(len(used)), refine=refine)
        return _placed(few, used, columns)
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


def solve_blocks(
    jacobian: Matrix, right: Vector, floor: float, blocks: Sequence[Block], *, regular: bool = False
) -> Array:
    """The x with J x = r, block after block, for every pose: (columns, poses). No derivatives.

    Of each block that of least norm, damped by so much of the scale of the block. Where all is `regular` blocks of
    three equations in as many unknowns are solved by Cramer's rule, which costs less.
    """
    return _in_turn(jacobian, right[:, None], floor, blocks, regular)[:, 0]


def inverse(jacobian: Matrix, floor: float, blocks: Sequence[Block]) -> Float[Array, "poses columns rows"]:
    """What `solve_blocks` multiplies right-hand sides by where all is regular."""
    rows, _, poses = jacobian.shape
    unit = jnp.broadcast_to(jnp.eye(rows, dtype=jacobian.dtype)[..., None], (rows, rows, poses))
    return jnp.moveaxis(_in_turn(jacobian, unit, floor, blocks, True), -1, 0)


def _in_turn(
    jacobian: Matrix, right: Float[Array, "rows sides poses"], floor: float, blocks: Sequence[Block], regular: bool
) -> Array:
    """Solutions for several right-hand sides: (columns, sides, poses)."""
    known: list[int] = []
    found = jnp.zeros((0, *right.shape[1:]), right.dtype)
    for block in blocks:
        rest = right[np.array(block.rows)]
        if known:
            rest = rest - jnp.sum(jacobian[np.ix_(block.rows, known)][:, :, None] * found, axis=1)
        own = jacobian[np.ix_(block.rows, block.columns)]
        if regular and own.shape[:2] == (3, 3):
            here = _cramer(own, rest)
        else:
            here = jnp.einsum("rcp,rkp->ckp", own, _factored(own, floor * scale(own))(rest))
        found = jnp.concatenate([found, here])
        known += block.columns
    return _placed(found, known, jacobian.shape[1])


def _placed(found: Float[Array, "some *entries"], which: Sequence[int], number: int) -> Float[Array, "number *entries"]:
    """Rows put into their places among zeros: picked, since XLA writes scattered rows one after another."""
    place = np.full(number, len(which))
    place[list(which)] = np.arange(len(which))
    return jnp.concatenate([found, jnp.zeros((1, *found.shape[1:]), found.dtype)])[place]


def _cramer(own: Float[Array, "3 3 poses"], right: Float[Array, "3 sides poses"]) -> Float[Array, "3 sides poses"]:
    a, b, c = own
    normals = jnp.stack([jnp.cross(b, c, axis=0), jnp.cross(c, a, axis=0), jnp.cross(a, b, axis=0)])
    return jnp.sum(normals[:, :, None] * right[:, None], axis=0) / jnp.sum(a * normals[0], axis=0)


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
