"""Frames of joints by hand: at a point, with z along an axis."""

from __future__ import annotations

from collections.abc import Sequence

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin._traced import traced
from jaxkin.geometry.pose import frame

PERPENDICULAR = 1e-6
"""Largest cosine between directions that a joint needs perpendicular: numbers of six digits."""

Triple = Sequence[float | int] | np.ndarray | jax.Array


def axis_frame(
    name: str, point: Triple | None, axis: Triple, what: str = "axis", point_label: str = "point"
) -> np.ndarray | jax.Array:
    """Make the frame at the point with z along the axis; numbers are checked (ValueError), traced ones are not.

    `what` and `point_label` are the names of the axis and of the point in messages.
    """
    if traced(point, axis):
        return _traced_frame(jnp.asarray(point, float), jnp.asarray(axis, float))
    checked = {}
    for label, value in ((point_label, point), (what, axis)):
        try:
            array = np.asarray(value, float)
        except (TypeError, ValueError):
            array = np.array(np.nan)
        if array.shape != (3,) or not np.all(np.isfinite(array)):
            raise ValueError(f"joint {name!r}: {label} must be three finite numbers (x, y, z), got {value!r}")
        checked[label] = array
    if not np.any(checked[what]):
        raise ValueError(f"joint {name!r}: {what} must be a direction, got the zero vector")
    return frame(checked[point_label], checked[what])


def _traced_frame(point: jax.Array, axis: jax.Array) -> jax.Array:
    """Make a frame from traced numbers as `frame` does from others."""
    z = axis / jnp.linalg.norm(axis)
    least = jnp.eye(3)[jnp.argmin(jnp.abs(z))]
    x = least - (least @ z) * z
    x = x / jnp.linalg.norm(x)
    rotation = jnp.stack([x, jnp.cross(z, x), z, point], axis=1)
    return jnp.concatenate([rotation, jnp.array([[0.0, 0.0, 0.0, 1.0]])])
