"""The square root of numbers that may be zero, where derivatives are asked for."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float


def root(square: Float[Array | np.ndarray, "*rows"] | float) -> Float[Array, "*rows"]:
    """Compute the square root, with a derivative of zero at zero: that of `jnp.sqrt` is infinite or NaN there."""
    positive = square > 0
    return jnp.where(positive, jnp.sqrt(jnp.where(positive, square, 1.0)), 0.0)
