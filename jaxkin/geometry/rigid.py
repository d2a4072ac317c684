"""Rigid displacements of many poses at once, as three rows of a 4x4 matrix with the poses last.

So a product is a few operations over all poses; as many products of small matrices it takes several times as long.
"""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float

Rigid = Float[Array, "3 4 *#poses"]
"""[row, column]: a rotation matrix, and in the last column where the origin goes, in the unit of the mechanism."""


def as_rigid(matrix: Float[Array, "4 4"]) -> Float[Array, "3 4 1"]:
    """One matrix for all poses: its first three rows, of a last axis of one."""
    return matrix[:3, :, None]


def as_matrices(rigid: Float[Array, "3 4 *poses"]) -> Float[Array, "*poses 4 4"]:
    """The 4x4 matrices, their last row 0, 0, 0, 1: poses first, as users get them."""
    last = jnp.broadcast_to(jnp.array([0.0, 0.0, 0.0, 1.0], rigid.dtype), (*rigid.shape[2:], 1, 4))
    return jnp.concatenate([jnp.moveaxis(rigid, (0, 1), (-2, -1)), last], axis=-2)


def product(a: Rigid, b: Rigid) -> Rigid:
    """The displacement a b, b followed by a in world coordinates, pose by pose; either may be one for all poses."""
    x, y, z = (a[:, k, None] * b[None, k] for k in range(3))
    turned = x + y + z
    return jnp.concatenate([turned[:, :3], turned[:, 3:] + a[:, 3:]], axis=1)


def inverse(a: Rigid) -> Rigid:
    """The displacement back, pose by pose: R^T, and -R^T t for the origin."""
    turned = a[:, :3].swapaxes(0, 1)
    x, y, z = (turned[:, k] * a[k, 3] for k in range(3))
    return jnp.concatenate([turned, -(x + y + z)[:, None]], axis=1)
