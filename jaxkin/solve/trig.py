"""Cosine and sine of many angles, several times as fast as one by one: by series that vector units can run.

An angle is brought to within an eighth of a turn of zero by whole quarter turns, which are taken off in three parts, so
that none of its digits is lost (Cody and Waite 1980); two short series do the rest. Where the poses of a stretch lie
near one another, even that is needed for one of them only.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

Angles = Float[Array, "*rows poses"]
Trig = Callable[[Array], tuple[Array, Array]]
FARTHEST = math.pi / 4 + 1e-6
"""Radians from zero, or from the middle angle: up to there the series end below the rounding error of float64."""
QUARTER = (float.fromhex("0x1.921fb544p+0"), float.fromhex("0x1.0b4611a6p-34"), float.fromhex("0x1.3198a2e037073p-69"))
"""A quarter turn as a sum: the first two parts hold 33 bits each, so that multiples up to a million are
exact; beyond, the angle itself is not given to more digits than are lost."""


@jax.custom_jvp
def cos_sin(angles: Angles) -> tuple[Angles, Angles]:
    """Cosine and sine of any angles."""
    if jnp.finfo(angles.dtype).bits != 64:
        return jnp.cos(angles), jnp.sin(angles)
    quarters = jnp.round(angles * (2 / math.pi))
    rest = angles
    for part in QUARTER:
        rest = rest - quarters * part
    cos, sin = _both(rest, rest * rest)
    turned = quarters - 4 * jnp.floor(quarters / 4)
    odd = (turned == 1) | (turned == 3)
    cos, sin = jnp.where(odd, sin, cos), jnp.where(odd, cos, sin)
    return jnp.where((turned == 1) | (turned == 2), -cos, cos), jnp.where(turned >= 2, -sin, sin)


@cos_sin.defjvp
def _cos_sin_jvp(primals, tangents):
    cos, sin = cos_sin(*primals)
    return (cos, sin), (-sin * tangents[0], cos * tangents[0])


def cos_sin_nearby(angles: Angles) -> tuple[Angles, Angles]:
    """Cosine and sine of angles that stay near the one in the middle of the poses; NaN where they do not."""
    middle = angles[..., angles.shape[-1] // 2, None]
    apart = angles - middle
    cos, sin = _both(apart, jnp.where(jnp.abs(apart) <= FARTHEST, apart * apart, jnp.nan))
    cos_0, sin_0 = cos_sin(middle)
    return cos * cos_0 - sin * sin_0, sin * cos_0 + cos * sin_0


def _both(angles: Angles, square: Angles) -> tuple[Angles, Angles]:
    """Cosine and sine by their series, from the angles and their squares."""
    return 1.0 + square * _series(square, 2), angles * (1.0 + square * _series(square, 3))


def _series(square: Angles, first: int) -> Angles:
    """(-1/n! + x/(n+2)! - ...) from n = `first` on: eight terms of cosine or sine behind the leading one."""
    total = jnp.zeros_like(square)
    for term in reversed(range(8)):
        total = total * square + (-1) ** (term + 1) / math.factorial(first + 2 * term)
    return total
