"""Solve three equations at every pose by Cramer's rule, with determinants as triple products of the rows."""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float


def solve_three(
    matrix: Float[Array, "3 3 poses"], right: Float[Array, "3 sides poses"]
) -> Float[Array, "3 sides poses"]:
    """Solve for several right-hand sides; not finite where the matrix is singular."""
    normals, determinant = _normals(matrix)
    return jnp.sum(normals[:, :, None] * right[:, None], axis=0) / determinant


def inverse_of_three(matrix: Float[Array, "3 3 poses"]) -> Float[Array, "3 3 poses"]:
    """Compute the inverse; not finite where the matrix is singular."""
    normals, determinant = _normals(matrix)
    return normals.swapaxes(0, 1) / determinant


def _normals(matrix: Float[Array, "3 3 poses"]) -> tuple[Float[Array, "3 3 poses"], Float[Array, " poses"]]:
    """Compute the cross product of the two other rows for each row, and the determinant."""
    a, b, c = matrix
    normals = jnp.stack([jnp.cross(b, c, axis=0), jnp.cross(c, a, axis=0), jnp.cross(a, b, axis=0)])
    return normals, jnp.sum(a * normals[0], axis=0)
