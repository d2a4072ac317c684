"""Find the centroid and the characteristic length of points: where moments are taken, and what lengths are divided by.

With both, no result depends on the origin or on the unit of length.
"""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

EIGHT_DIGITS = 1e-8
"""Distance, over that from the origin, below which points are one, in float64: rounding of coordinates would be 2e-8 of
the size of a smaller mechanism, and files with few digits write a point differently here and there."""
ROUNDINGS = 100.0
"""The same in units of rounding, where that is more, as in float32."""
SMALLEST = 1e-12
"""Distance, in the unit of length, below which points are one: at the origin rounding leaves such numbers in place of
zero."""


def centroid_and_length(points: Float[Array | np.ndarray, "n 3"], xp: Any = jnp) -> tuple[Any, Any]:
    """Return the centroid (3,) of points, and their root-mean-square distance from it, by jax.numpy or numpy as `xp`.

    The length is 1 where all points are one, to rounding: axes of a spherical mechanism meet in a point, and the noise
    of that point is no measure of anything.
    """
    centre = xp.mean(points, axis=0)
    square = xp.mean(xp.sum((points - centre) ** 2, axis=1))
    noise = max(EIGHT_DIGITS, ROUNDINGS * float(xp.finfo(points.dtype).eps)) * xp.max(xp.abs(points))
    apart = square > xp.maximum(noise, SMALLEST) ** 2
    return centre, xp.sqrt(xp.where(apart, square, 1.0))
