"""What formulas compute with: NumPy where all their numbers are NumPy's, `jax.numpy` where any is an array of JAX.

So a few poses of a known mechanism, such as the nodes of its line (`input_line`), need no compiled program.
"""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry import root as safe_root
from jaxkin.geometry import trig

Number = Float[Array | np.ndarray, "*#poses"] | float
"""One number a pose, or one for all poses."""


def namespace(*numbers: object) -> Any:
    """Return `jax.numpy` if any number is an array of JAX, else `numpy`."""
    return jnp if any(isinstance(number, jax.Array) for number in numbers) else np


def cos_sin(angles: Number) -> Float[Array | np.ndarray, "2 *#poses"]:
    """Compute the cosines (first row) and sines (second row) of angles in radians."""
    if namespace(angles) is np:
        return np.stack([np.cos(angles), np.sin(angles)])
    return trig.cos_sin(angles)


def angle(sin: Number, cos: Number) -> Number:
    """Compute the angles in [-pi, pi], radians, of vectors with these components; zero for vectors of length zero."""
    return np.arctan2(sin, cos) if namespace(sin, cos) is np else trig.angle(sin, cos)


def root(square: Number) -> Number:
    """Compute the square root of positive numbers, and zero with zero derivative of all others."""
    return np.sqrt(np.where(square > 0, square, 0.0)) if namespace(square) is np else safe_root.root(square)


def ratio(part: Number, whole: Number) -> Number:
    """Divide by numbers that are not negative; zero with zero derivative where these are zero."""
    xp, positive = namespace(part, whole), whole > 0
    return xp.where(positive, part / xp.where(positive, whole, 1.0), 0.0)
