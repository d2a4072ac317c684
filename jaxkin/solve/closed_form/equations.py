"""The two equations that all formulas come down to: A cos x + B sin x = C, and the quadratic of a displacement."""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry.trig import angle

Number = Float[Array | np.ndarray, "*#poses"] | float
"""One number a pose, or one for all poses."""


class Root(NamedTuple):
    """A solution of one of the two equations."""

    value: Number
    """Radians in (-pi, pi], or a length."""
    discriminant: Number
    """Over its largest possible value: 1 where the two solutions are farthest apart."""


def root(square: Number) -> Number:
    """Compute the square root of positive numbers, and zero with zero derivative of all others."""
    positive = square > 0
    return jnp.where(positive, jnp.sqrt(jnp.where(positive, square, 1.0)), 0.0)


def ratio(part: Number, whole: Number) -> Number:
    """Divide by numbers that are not negative; zero with zero derivative where these are zero."""
    positive = whole > 0
    return jnp.where(positive, part / jnp.where(positive, whole, 1.0), 0.0)


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
