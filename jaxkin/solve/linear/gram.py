"""Compute products of small matrices at every pose, such as the Gram matrix J J^T, and add damping to that."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

MIN_MATMUL_ROWS = 9
"""Number of rows from which on J J^T is a matrix product at each pose, in a third of the time of sums over poses. For
fewer, a product is three operations to compile, two of which turn the axes, and a sum is one."""

Matrix = Float[Array, "rows columns poses"]
Vector = Float[Array, "rows poses"]
Damping = Float[Array, " poses"] | float
"""Damping relative to the mean square `s` of the rows of J: one number for all poses, or one a pose."""


def gram_matrix(jacobian: Matrix) -> Float[Array, "rows rows poses"]:
    """Compute J J^T at every pose."""
    if len(jacobian) < MIN_MATMUL_ROWS:
        return row_products(jacobian, jacobian)
    rows = jnp.moveaxis(jacobian, -1, 0)
    return jnp.moveaxis(rows @ rows.mT, 0, -1)


def row_products(one: Matrix, other: Float[Array, "others columns poses"]) -> Float[Array, "rows others poses"]:
    """Compute A B^T at every pose."""
    if len(one) < MIN_MATMUL_ROWS:
        return jnp.sum(one[:, None] * other[None], axis=2)
    return jnp.einsum("rcp,ocp->rop", one, other)


def product(one: Matrix, other: Float[Array, "columns others poses"]) -> Float[Array, "rows others poses"]:
    """Compute A B at every pose."""
    return row_products(one, other.swapaxes(0, 1))


def column_products(one: Matrix, other: Float[Array, "rows others poses"]) -> Float[Array, "columns others poses"]:
    """Compute A^T B at every pose."""
    if len(one) < MIN_MATMUL_ROWS:
        return jnp.sum(one[:, :, None] * other[:, None], axis=0)
    return jnp.einsum("rcp,rop->cop", one, other)


def row_sums(matrix: Matrix, vector: Float[Array, "columns poses"]) -> Vector:
    """Compute A x at every pose."""
    return jnp.sum(matrix * vector[None], axis=1)


def column_sums(matrix: Matrix, vector: Vector) -> Float[Array, "columns poses"]:
    """Compute A^T x at every pose."""
    return jnp.sum(matrix * vector[:, None], axis=0)


def add_damping(gram: Float[Array, "n n poses"], damping: Damping) -> Float[Array, "n n poses"]:
    """Compute J J^T + damping s 1 from J J^T."""
    diagonal = np.arange(len(gram))
    return gram + damping * mean_square(gram[diagonal, diagonal]) * np.eye(len(gram), dtype=gram.dtype)[..., None]


def mean_square(squares: Vector) -> Float[Array, " poses"]:
    """Compute `s`, the mean of the squared norms of the rows of J; one where J is zero."""
    mean = jnp.sum(squares, axis=0) / len(squares)
    return jnp.where(mean > 0, mean, 1.0)
