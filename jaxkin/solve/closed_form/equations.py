"""The two equations that all formulas come down to: A cos x + B sin x = C, and the quadratic of a displacement.

Formulas compute with NumPy where all their numbers are NumPy's, so that a few poses of a known mechanism, such as the
nodes of its way (`way`), need no compiled program; and with `jax.numpy` where any number is an array of JAX.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry import trig

Number = Float[Array | np.ndarray, "*#poses"] | float
"""One number a pose, or one for all poses."""


class Root(NamedTuple):
    """A solution of one of the two equations."""

    value: Number
    """Radians in (-pi, pi], or a length."""
    discriminant: Number
    """Over its largest possible value: 1 where the two solutions are farthest apart."""


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
    xp, positive = namespace(square), square > 0
    return xp.where(positive, xp.sqrt(xp.where(positive, square, 1.0)), 0.0)


def ratio(part: Number, whole: Number) -> Number:
    """Divide by numbers that are not negative; zero with zero derivative where these are zero."""
    xp, positive = namespace(part, whole), whole > 0
    return xp.where(positive, part / xp.where(positive, whole, 1.0), 0.0)


def solve_turn(a: Number, b: Number, c: Number, sign: Number) -> Root:
    """Solve a cos x + b sin x = c for the angle x.

    The derivative of the left side is b cos x - a sin x = `sign` sqrt(a^2 + b^2 - c^2); at x = 0 it is b. The
    discriminant is 1 - c^2 / (a^2 + b^2).
    """
    square = a * a + b * b
    radius = root(square)
    product = (radius - c) * (radius + c)
    slope = sign * root(product)
    return Root(angle(b * c - a * slope, a * c + b * slope), ratio(product, square))


def solve_slide(half: Number, square: Number, whole: Number, sign: Number) -> Root:
    """Solve (s + half)^2 = square for the displacement s.

    Half the derivative of the left side is s + half = `sign` sqrt(square); at s = 0 it is `half`. The discriminant is
    square / whole.
    """
    return Root(sign * root(square) - half, ratio(square, whole))
