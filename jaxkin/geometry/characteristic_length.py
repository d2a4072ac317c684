"""Find the centroid and the characteristic length of points: where moments are taken, and what lengths are divided by.

With both, no result depends on the origin or on the unit of length.
"""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

SINGLE_PRECISION = 1e-7
"""Distance, over that from the origin, below which points are one: files keep them in single precision."""
ROUNDINGS = 100.0
"""The same in units of rounding, where that is more: points that are one come out of a few rotations and sums."""
SMALLEST = 1e-8
"""Distance, in the unit of length, below which points are one: no mechanism is that small in any unit."""


def centroid_and_length(points: Float[Array | np.ndarray, "n 3"], xp: Any = jnp) -> tuple[Any, Any]:
    """Return the centroid (3,) of points, and their root-mean-square distance from it, by jax.numpy or numpy as `xp`.

    The length is 1 where all points are one, to rounding: axes of a spherical mechanism meet in a point, and the noise
    of that point is no measure of anything.
    """
    centre = xp.mean(points, axis=0)
    square = xp.mean(xp.sum((points - centre) ** 2, axis=1))
    noise = max(SINGLE_PRECISION, ROUNDINGS * float(xp.finfo(points.dtype).eps)) * xp.max(xp.abs(points))
    apart = square > xp.maximum(noise, SMALLEST) ** 2
    return centre, xp.sqrt(xp.where(apart, square, 1.0))
