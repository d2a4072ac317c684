"""Compute cosines and sines of many angles, and angles from these, by vectorised polynomials.

They are several times as fast as library functions, which take one number after the other. Cosine and sine are both
computed as sines. From the angle, its nearest zero of the function is subtracted, a multiple of pi / 2. This is done in
three parts, so that no digit is lost (Cody and Waite 1980). A polynomial gives the sine of the remainder, which is at
most pi / 2 in size. Cosine and sine are in one array, which the compiler computes in one loop.
"""

from __future__ import annotations

import math

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

TURN = 2 * math.pi
"""A full turn, radians."""
HALF = (float.fromhex("0x1.921fb544p+1"), float.fromhex("0x1.0b4611a6p-33"), float.fromhex("0x1.3198a2e037073p-68"))
"""pi, half a turn, as a sum of three numbers.

The first two have 33 bits each, so that their products with multiples of 1/2 up to a million are exact; larger angles
have themselves lost as many digits to rounding."""
SERIES = tuple(
    map(
        float.fromhex,
        (
            "-0x1.5555555555555p-3",
            "0x1.1111111111107p-7",
            "-0x1.a01a01a018aaap-13",
            "0x1.71de3a54564dfp-19",
            "-0x1.ae6455a1c0795p-26",
            "0x1.612401540ed0fp-33",
            "-0x1.ae51366b753a9p-41",
            "0x1.89a43bea5b135p-49",
        ),
    )
)
"""Coefficients of (sin r - r) / r^3 in powers of r^2, interpolated at Chebyshev nodes: the error of the sine is below
1.3e-18 for |r| up to pi / 2, before rounding."""
ARC_SERIES = tuple(
    map(
        float.fromhex,
        (
            "-0x1.5555555555555p-2",
            "0x1.9999999999953p-3",
            "-0x1.249249248d7eep-3",
            "0x1.c71c71c304b68p-4",
            "-0x1.745d165df3f95p-4",
            "0x1.3b1392d9e785cp-4",
            "-0x1.110e880a7a521p-4",
            "0x1.e19a13b9fc6dfp-5",
            "-0x1.ac7a938b69c93p-5",
            "0x1.74ddd408bb4c1p-5",
            "-0x1.1b33b923aa954p-5",
            "0x1.0ad36a455cafbp-6",
        ),
    )
)
"""Coefficients of (atan t - t) / t^3 in powers of t^2, interpolated at Chebyshev nodes: the relative error of atan is
below 3.1e-18 for |t| up to tan(pi / 8), before rounding."""
TAN_EIGHTH = math.sqrt(2) - 1
"""tan(pi / 8)."""


@jax.custom_jvp
def cos_sin(angles: Float[Array, "*rows"]) -> Float[Array, "2 *rows"]:
    """Compute the cosines (first row) and sines (second row) of angles in radians.

    Only float64 uses the polynomial; other precisions use the library functions.
    """
    if jnp.finfo(angles.dtype).bits != 64:
        return jnp.stack([jnp.cos(angles), jnp.sin(angles)])
    # zeros of the cosine lie half way between those of the sine
    shift = np.array([0.5, 0.0]).reshape(2, *[1] * angles.ndim)
    turns = jnp.round(angles * (1 / math.pi) - shift)
    rest = angles
    for part in HALF:
        rest = rest - (turns + shift) * part
    square = rest * rest
    *lower, total = SERIES
    for term in reversed(lower):
        total = total * square + term
    # the sine changes its sign with every half turn; the cosine falls at pi / 2, the zero with `turns` = 0
    odd = turns - 2 * jnp.floor(0.5 * turns)
    # divide by the sign: XLA takes a quotient for costly, and does not compute it again wherever it is used
    return (rest + rest * (square * total)) / ((1 - 2 * odd) * (1 - 4 * shift))


@cos_sin.defjvp
def _cos_sin_jvp(primals, tangents):
    both = cos_sin(*primals)
    return both, jnp.stack([-both[1] * tangents[0], both[0] * tangents[0]])


@jax.custom_jvp
def known_cos_and_sin(
    angles: Float[Array, "*rows"], known: tuple[Float[Array, "*rows"], Float[Array, "*rows"]]
) -> tuple[Float[Array, "*rows"], Float[Array, "*rows"]]:
    """Return the cosines and sines of angles in radians that are `known` already, as functions of the angles."""
    return known


@known_cos_and_sin.defjvp
def _known_cos_and_sin_jvp(primals, tangents):
    cos, sin = known_cos_and_sin(*primals)
    return (cos, sin), (-sin * tangents[0], cos * tangents[0])


def cos_and_sin(angles: Float[Array, "*rows"]) -> tuple[Float[Array, "*rows"], Float[Array, "*rows"]]:
    """Compute the cosines and the sines of angles in radians, as two arrays.

    In a reverse pass XLA joins their derivatives with what comes before and after; those of the rows of `cos_sin` are
    padded to arrays of two rows each, and added.
    """
    cos, sin = cos_sin(lax.stop_gradient(angles))
    return known_cos_and_sin(angles, (cos, sin))


@jax.custom_jvp
def angle(sin: Float[Array, "..."], cos: Float[Array, "..."]) -> Float[Array, "..."]:
    """Compute the angles in (-pi, pi], radians, at which vectors of any length have these components: atan2.

    Zero, with zero derivative, for vectors of length zero. Only float64 uses the polynomial; other precisions use the
    library function.
    """
    if jnp.finfo(jnp.result_type(sin, cos)).bits != 64:
        return jnp.arctan2(sin, cos)
    one, other = jnp.abs(sin), jnp.abs(cos)
    small, large = jnp.minimum(one, other), jnp.maximum(one, other)
    # beyond pi / 8: atan t = pi / 4 + atan((t - 1) / (t + 1))
    beyond = small > TAN_EIGHTH * large
    part = jnp.where(beyond, small - large, small)
    whole = jnp.where(beyond, small + large, jnp.where(large == 0, 1.0, large))
    tangent = part / whole
    square = tangent * tangent
    *lower, total = ARC_SERIES
    for term in reversed(lower):
        total = total * square + term
    arc = tangent + tangent * (square * total) + jnp.where(beyond, 0.25 * math.pi, 0.0)
    arc = jnp.where(one > other, 0.5 * math.pi - arc, arc)
    arc = jnp.where(cos < 0, math.pi - arc, arc)
    # divide by the sign, as in `cos_sin`
    return arc / jnp.where(sin < 0, -1.0, 1.0)


@angle.defjvp
def _angle_jvp(primals, tangents):
    (sin, cos), (d_sin, d_cos) = primals, tangents
    square = sin * sin + cos * cos
    return angle(sin, cos), (cos * d_sin - sin * d_cos) / jnp.where(square == 0, 1.0, square)
