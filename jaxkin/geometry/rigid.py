"""Multiply and invert rigid displacements of many poses at once, in JAX.

They are stored as the first three rows of 4x4 matrices, with the pose as last axis. In this order of axes a product is
a few vector operations over all poses, several times as fast as a batch of products of small matrices.
"""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float

Rigid = Float[Array, "3 4 *#poses"]
"""[row, column, pose]: the rotation matrix, and in the last column the translation, in the unit of the mechanism."""


def as_rigid(matrix: Float[Array, "4 4"]) -> Float[Array, "3 4 1"]:
    """Use one 4x4 matrix for all poses: its first three rows, with a last axis of length one."""
    return matrix[:3, :, None]


def as_matrices(rigid: Float[Array, "3 4 *poses"]) -> Float[Array, "*poses 4 4"]:
    """Make 4x4 matrices with the poses as first axes, as users get them; the last row is 0, 0, 0, 1."""
    last = jnp.broadcast_to(jnp.array([0.0, 0.0, 0.0, 1.0], rigid.dtype), (*rigid.shape[2:], 1, 4))
    return jnp.concatenate([jnp.moveaxis(rigid, (0, 1), (-2, -1)), last], axis=-2)


def product(a: Rigid, b: Rigid) -> Rigid:
    """Multiply displacements pose by pose: first b, then a, in world coordinates.

    Either may have a last axis of length one, for all poses.
    """
    x, y, z = (a[:, k, None] * b[None, k] for k in range(3))
    turned = x + y + z
    return jnp.concatenate([turned[:, :3], turned[:, 3:] + a[:, 3:]], axis=1)


def inverse(a: Rigid) -> Rigid:
    """Invert displacements pose by pose: rotation R^T, translation -R^T t."""
    turned = a[:, :3].swapaxes(0, 1)
    x, y, z = (turned[:, k] * a[k, 3] for k in range(3))
    return jnp.concatenate([turned, -(x + y + z)[:, None]], axis=1)
