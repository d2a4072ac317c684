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

from jaxkin.solve.system.equation_blocks import EquationBlock

(
    MAX_ALWAYS_UNROLLED_ROWS,
    MAX_UNROLLED_ROWS,
    MIN_UNROLLED_POSES,
    MIN_MATMUL_ROWS,
    MAX_UNHALVED_ROWS,
    MIN_CHOLESKY_ROWS,
) = 3, 9, 1024, 9, 12, 40
"""Up to so many rows, and from so many poses on, straight-line code over the poses is faster than a loop; for
fewer poses it is not worth the time that it takes to compile, but for so few rows as one planar loop has. From so many
rows on J J^T is a product of matrices pose by pose, a third of the time of sums; systems of more rows than these are
eliminated half after half; from so many on a library is faster, which takes longer to import than smaller systems to
sweep."""
MAX_SELECTED_FRACTION = 0.75
"""If no more of the columns are used they are picked: to carry a few zeros along costs less."""

Matrix = Float[Array, "rows columns poses"]
Vector = Float[Array, "rows poses"]
Damping = Float[Array, " poses"] | float


def solve_least_norm(jacobian: Matrix, right: Vector, damping: Damping, used: Sequence[int]) -> Array:
    """The x of least norm that minimises |J x - r|^2 + damping s |x|^2, for every pose: (columns, poses).

    Dampings are in terms of `s`, the mean square of the rows of J. All columns but those `used` are zero. No
    derivatives.
    """
    own = _picked(jacobian, used)
    x = jnp.sum(own * _factored(own, damping)(right)[:, None], axis=0)
    return _put_back(x, used, jacobian.shape[1])


def solve_least_norm_refined(jacobian: Matrix, right: Vector, damping: Damping, used: Sequence[int]) -> Array:
    """The same with derivatives, the bias of the damping taken out by one step of iterative refinement."""
    own = _picked(jacobian, used)
    factored = _factored(own, damping)
    absolute = damping * _mean(jnp.sum(own * own, axis=1))

    def transposed(y: Vector) -> Array:
        return jnp.sum(own * y[:, None], axis=0)

    def forward(x: Array) -> Vector:
        return jnp.sum(own * x[None], axis=1)

    def solve(right: Vector) -> Vector:
        # derivatives are solutions of the same system, too: nothing differentiates the elimination
        return lax.custom_linear_solve(
            lambda y: forward(transposed(y)) + absolute * y, right, lambda _, right: factored(right), symmetric=True
        )

    x = transposed(solve(right))
    x = x + transposed(solve(right - forward(x)))
    return _put_back(x, used, jacobian.shape[1])


def _picked(jacobian: Matrix, used: Sequence[int]) -> Float[Array, "rows picked poses"]:
    """The columns used, or all if hardly any is not."""
    return jacobian[:, np.array(used, np.int32)] if len(used) < MAX_SELECTED_FRACTION * jacobian.shape[1] else jacobian


def _put_back(x: Array, used: Sequence[int], columns: int) -> Array:
    """A solution for what `_picked` picked as one for all columns."""
    return x if len(x) == columns else scatter_rows(x, used, columns)


def solve_blocks(
    jacobian: Matrix, right: Vector, damping: float, blocks: Sequence[EquationBlock], *, regular: bool = False
) -> Array:
    """The x with J x = r, block after block, for every pose: (columns, poses). No derivatives.

    Of each block that of least norm, damped by so much of its mean square. Where all is `regular` blocks of
    three equations in as many unknowns are solved by Cramer's rule, which costs less.
    """
    return _in_turn(jacobian, right[:, None], damping, blocks, regular)[:, 0]


def inverse_jacobian(
    jacobian: Matrix, damping: float, blocks: Sequence[EquationBlock]
) -> Float[Array, "poses columns rows"]:
    """What `solve_blocks` multiplies right-hand sides by where all is regular."""
    rows, _, poses = jacobian.shape
    unit = jnp.broadcast_to(jnp.eye(rows, dtype=jacobian.dtype)[..., None], (rows, rows, poses))
    return jnp.moveaxis(_in_turn(jacobian, unit, damping, blocks, True), -1, 0)


def _in_turn(
    jacobian: Matrix,
    right: Float[Array, "rows sides poses"],
    damping: float,
    blocks: Sequence[EquationBlock],
    regular: bool,
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
            here = jnp.einsum("rcp,rkp->ckp", own, _factored(own, damping)(rest))
        found = jnp.concatenate([found, here])
        known += block.columns
    return scatter_rows(found, known, jacobian.shape[1])


def scatter_rows(found: Float[Array, "some *entries"], which: Sequence[int] | np.ndarray, number: int) -> Array:
    """Rows put into their places among zeros: picked, since XLA writes scattered rows one after another."""
    place = np.full(number, len(which))
    place[list(which)] = np.arange(len(which))
    if len(which) < number:
        found = jnp.concatenate([found, jnp.zeros((1, *found.shape[1:]), found.dtype)])
    return found if np.array_equal(place, np.arange(number)) else found[place]


def _cramer(own: Float[Array, "3 3 poses"], right: Float[Array, "3 sides poses"]) -> Float[Array, "3 sides poses"]:
    a, b, c = own
    normals = jnp.stack([jnp.cross(b, c, axis=0), jnp.cross(c, a, axis=0), jnp.cross(a, b, axis=0)])
    return jnp.sum(normals[:, :, None] * right[:, None], axis=0) / jnp.sum(a * normals[0], axis=0)


def _mean(squares: Vector) -> Float[Array, " poses"]:
    """What a damping is measured by, the mean of the squares of the rows of J; one where nothing moves the loops."""
    mean = jnp.sum(squares, axis=0) / len(squares)
    return jnp.where(mean > 0, mean, 1.0)


def _factored(jacobian: Matrix, damping: Damping) -> Callable[[Array], Array]:
    """The solution of (J J^T + damping s) y = r, for right-hand sides of (rows, poses) or (rows, sides, poses)."""
    rows, _, poses = jacobian.shape
    if rows <= MAX_ALWAYS_UNROLLED_ROWS or (rows <= MAX_UNROLLED_ROWS and poses >= MIN_UNROLLED_POSES):
        return _unrolled(jacobian, damping)
    return (_looped if rows < MIN_CHOLESKY_ROWS else _by_library)(jacobian, damping)


def _unrolled(jacobian: Matrix, damping: Damping):
    """L D L^T of the matrix, every entry an array over the poses."""
    n = jacobian.shape[0]
    absolute = damping * _mean(jnp.sum(jacobian * jacobian, axis=1))
    lower: dict[tuple[int, int], Array] = {}
    pivots: list[Array] = []
    for j in range(n):
        column = [jnp.sum(jacobian[i] * jacobian[j], axis=0) for i in range(j, n)]
        column = [
            entry - sum(lower[i, k] * lower[j, k] * pivots[k] for k in range(j)) for i, entry in enumerate(column, j)
        ]
        pivots.append(column[0] + absolute)
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


def _looped(jacobian: Matrix, damping: Damping):
    """The same by Gauss-Jordan elimination in loops. The matrix is positive definite: it needs no pivoting."""
    n = jacobian.shape[0]
    gram = _damped(_gram(jacobian), damping)

    def solve(right: Array) -> Array:
        sides = right.reshape(n, -1, right.shape[-1])
        return _eliminated(jnp.concatenate([gram, sides], axis=1)).reshape(right.shape)

    return solve


def _eliminated(matrix: Float[Array, "rows more poses"]) -> Float[Array, "rows sides poses"]:
    """The solutions of square systems, given with their right-hand sides behind them; of large ones half after half."""
    n = len(matrix)
    if n > MAX_UNHALVED_ROWS:
        half = n // 2
        upper = _eliminated(matrix[:half])
        lower = _eliminated(matrix[half:, half:] - _product(matrix[half:, :half], upper))
        return jnp.concatenate([upper[:, n - half :] - _product(upper[:, : n - half], lower), lower])

    def eliminate(_, matrix: Array) -> Array:
        # the first row and column are done with, and roll to the end: inside `vmap` places that move would be gathered
        pivot = matrix[0, 1:] / matrix[0, 0]
        rest = matrix[1:, 1:] - matrix[1:, :1] * pivot
        return jnp.pad(jnp.concatenate([rest, pivot[None]]), ((0, 0), (0, 1), (0, 0)))

    return lax.fori_loop(0, n, eliminate, matrix)[:, : matrix.shape[1] - n]


def _product(a: Float[Array, "rows inner poses"], b: Float[Array, "inner columns poses"]) -> Array:
    return jnp.sum(a[:, :, None] * b[None], axis=1)


def _gram(jacobian: Matrix) -> Float[Array, "rows rows poses"]:
    """J J^T."""
    if len(jacobian) < MIN_MATMUL_ROWS:
        return jnp.sum(jacobian[:, None] * jacobian[None], axis=2)
    rows = jnp.moveaxis(jacobian, -1, 0)
    return jnp.moveaxis(rows @ rows.mT, 0, -1)


def _damped(gram: Float[Array, "n n poses"], damping: Damping) -> Float[Array, "n n poses"]:
    diagonal = np.arange(len(gram))
    return gram + damping * _mean(gram[diagonal, diagonal]) * jnp.eye(len(gram), dtype=gram.dtype)[..., None]


def _by_library(jacobian: Matrix, damping: Damping):
    """The same by Cholesky's method. Rounding must not make it fail, so that a little more damping is needed."""
    n = jacobian.shape[0]
    gram = _damped(_gram(jacobian), damping + 0.25 * n * float(jnp.finfo(jacobian.dtype).eps))
    lower = lax.linalg.cholesky(jnp.moveaxis(gram, -1, 0), symmetrize_input=False)

    def solve(right: Array) -> Array:
        sides = jnp.moveaxis(right.reshape(n, -1, right.shape[-1]), -1, 0)
        for transposed in (False, True):
            sides = lax.linalg.triangular_solve(lower, sides, left_side=True, lower=True, transpose_a=transposed)
        return jnp.moveaxis(sides, 0, -1).reshape(right.shape)

    return solve
