"""Cosine and sine of many angles: of any, or, several times as fast, of angles that lie near one another."""

from __future__ import annotations

import math
from collections.abc import Callable

import jax.numpy as jnp
from jaxtyping import Array, Float

Angles = Float[Array, "*rows poses"]
Trig = Callable[[Array], tuple[Array, Array]]
FARTHEST = 0.5
"""Radians from the middle one: up to there the series ends below the rounding error."""


def cos_sin(angles: Angles) -> tuple[Angles, Angles]:
    """Cosine and sine of any angles."""
    return jnp.cos(angles), jnp.sin(angles)


def cos_sin_nearby(angles: Angles) -> tuple[Angles, Angles]:
    """Cosine and sine of angles that stay near the one in the middle of the poses; NaN where they do not."""
    middle = angles[..., angles.shape[-1] // 2, None]
    apart = angles - middle
    square = jnp.where(jnp.abs(apart) <= FARTHEST, apart * apart, jnp.nan)
    cos, sin = 1.0 + square * _series(square, 2), apart * (1.0 + square * _series(square, 3))
    cos_0, sin_0 = cos_sin(middle)
    return cos * cos_0 - sin * sin_0, sin * cos_0 + cos * sin_0


def _series(square: Angles, first: int) -> Angles:
    """(-1/n! + x/(n+2)! - ...) from n = `first` on: seven terms of cosine or sine behind the leading one."""
    total = jnp.zeros_like(square)
    for term in reversed(range(7)):
        total = total * square + (-1) ** (term + 1) / math.factorial(first + 2 * term)
    return total
