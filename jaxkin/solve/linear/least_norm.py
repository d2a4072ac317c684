"""Find least-norm solutions of many small linear systems at once, by the algorithm that suits their size.

Closure equations are often redundant (parallel axes, several contacts of one pair), and freedoms may be idle (the spin
of a rod between two balls). `x = J^T (J J^T + damping s 1)^-1 r` is defined in both cases, and lies in the row space of
J by construction: rounding sets no idle freedom in motion, as it does with `(J^T J + damping)^-1 J^T r`.

| rows | algorithm |
|---|---|
| up to 3; up to 9 for many poses | L D L^T, straight-line code (`ldl`) |
| below 40 | Gauss-Jordan elimination (`gauss_jordan`) |
| 40 and more | Cholesky factorisation of a library (`cholesky`) |
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.linkage.first_order import DOUBLE, SINGLE
from jaxkin.solve.linear.cholesky import factor_cholesky
from jaxkin.solve.linear.gauss_jordan import factor_gauss_jordan
from jaxkin.solve.linear.gram import Damping, Matrix, Vector, mean_square
from jaxkin.solve.linear.ldl import factor_ldl
from jaxkin.solve.system.scatter import scatter_rows

MAX_ALWAYS_UNROLLED_ROWS = 3
"""Largest number of rows that straight-line code solves for any number of poses: that of one planar loop."""
MAX_UNROLLED_ROWS = 9
"""Largest number of rows that straight-line code solves for many poses, faster than a loop."""
MIN_UNROLLED_POSES = 1024
"""Number of poses from which on `MAX_UNROLLED_ROWS` applies: for fewer, the gain is less than the time to compile."""
MIN_CHOLESKY_ROWS = 40
"""Number of rows from which on a library is faster than a loop, the time to load it included."""
MAX_SELECTED_FRACTION = 0.75
"""Largest fraction of columns in use for which these are selected: to carry a few zero columns costs less than that."""


def damping_floor(dtype) -> float:
    """Compute the least damping, relative to the mean square of the rows of J: the squared tolerance of the rank."""
    return (DOUBLE if jnp.finfo(dtype).bits == 64 else SINGLE).rank ** 2


def solve_least_norm(jacobian: Matrix, right: Vector, damping: Damping, used: Sequence[int]) -> Array:
    """Solve min |J x - r|^2 + damping s |x|^2 at every pose; returns x (columns, poses), not to be differentiated.

    `s` is the mean square of the rows of J. All columns of J other than those in `used` must be zero.
    """
    own = _select_columns(jacobian, used)
    x = jnp.sum(own * factor_normal_equations(own, damping)(right)[:, None], axis=0)
    return _restore_columns(x, used, jacobian.shape[1])


def solve_least_norm_refined(jacobian: Matrix, right: Vector, damping: Damping, used: Sequence[int]) -> Array:
    """Solve min |x| subject to J x = r at every pose; returns x (columns, poses), which may be differentiated.

    One step of iterative refinement removes the bias of the damping.
    """
    own = _select_columns(jacobian, used)
    factored = factor_normal_equations(own, damping)
    absolute = damping * mean_square(jnp.sum(own * own, axis=1))

    def transposed(y: Vector) -> Array:
        return jnp.sum(own * y[:, None], axis=0)

    def forward(x: Array) -> Vector:
        return jnp.sum(own * x[None], axis=1)

    def solve(right: Vector) -> Vector:
        # a derivative solves the same system: the elimination is never differentiated
        return lax.custom_linear_solve(
            lambda y: forward(transposed(y)) + absolute * y, right, lambda _, right: factored(right), symmetric=True
        )

    x = transposed(solve(right))
    x = x + transposed(solve(right - forward(x)))
    return _restore_columns(x, used, jacobian.shape[1])


def _select_columns(jacobian: Matrix, used: Sequence[int]) -> Float[Array, "rows picked poses"]:
    """Select the columns in use, or all columns if only a few are not in use."""
    return jacobian[:, np.array(used, np.int32)] if len(used) < MAX_SELECTED_FRACTION * jacobian.shape[1] else jacobian


def _restore_columns(x: Array, used: Sequence[int], columns: int) -> Array:
    """Put zeros into x for the columns that `_select_columns` left out."""
    return x if len(x) == columns else scatter_rows(x, used, columns)


def factor_normal_equations(jacobian: Matrix, damping: Damping) -> Callable[[Array], Array]:
    """Return the function that solves (J J^T + damping s 1) y = r for r of (rows, poses) or (rows, sides, poses)."""
    rows, _, poses = jacobian.shape
    if rows <= MAX_ALWAYS_UNROLLED_ROWS or (rows <= MAX_UNROLLED_ROWS and poses >= MIN_UNROLLED_POSES):
        return factor_ldl(jacobian, damping)
    return (factor_gauss_jordan if rows < MIN_CHOLESKY_ROWS else factor_cholesky)(jacobian, damping)
