"""Many poses at once, between few that were solved: interpolation of high order, one correction, a check of each pose.

A range in order is cut into segments. At four poses of each the state and its exact slope are known, which makes a
polynomial of degree seven; over a segment of a fortieth of a radian it is right to about rounding. Where it is not, one
chord step (Newton's, with the inverse Jacobian of the middle of the segment) brings it there. Each pose then has to
close by itself: a segment in which one does not is left to the damped corrector.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure.closure import Geometry, closure
from jaxkin.solve.closure.joint_coordinates import at_rest
from jaxkin.solve.continuation.branch import Knots, guess
from jaxkin.solve.continuation.step import slopes
from jaxkin.solve.correctors.levenberg_marquardt import floor
from jaxkin.solve.correctors.newton import newton
from jaxkin.solve.execution.lockstep import any_lane
from jaxkin.solve.linear.least_norm import inverse
from jaxkin.solve.status import roundings, tolerance
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, assembled, difference, drive, rate, retract

SEGMENTS, WITH_SPINS = 256, 512
"""At most so many, of a number of poses that is a power of two. Where rods spin between balls, and a ball passes near
half a turn, the spin changes fast."""
NODES = -np.cos(np.pi * (2 * np.arange(4) + 1) / 8)
"""Where a segment from -1 to 1 is solved beforehand: the zeros of a Chebyshev polynomial."""
NARROWEST = 1e-4
"""Half the width of the narrowest segment, radians or characteristic lengths: repeated inputs have no width."""
CORRECTION = 1e-6
"""A pose farther from the polynomial than this is not trusted."""
NEAR = 1e-2
"""A node farther from where the knots put it is not trusted."""
SHARP, CLOSED = 32, 64
"""Times the unit of rounding: a segment whose poses do not all close as well as this is corrected, or after that left
to the damped corrector."""


class Poses(NamedTuple):
    """Poses as they were found: numbers without derivatives."""

    state: State
    status: Int[Array, " poses"]
    gap: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""


def interpolate(
    system: LoopSystem,
    geometry: Geometry,
    knots: Knots,
    values: Float[Array, " poses"],
    settle: Callable[[Float[Array, " segment"]], Poses],
    share: int,
) -> Poses:
    """All poses from those at the nodes of the segments; `settle` finds those of a segment that cannot be trusted.

    The values are one of so many pieces of a range.
    """
    dtype, poses = values.dtype, values.shape[0]
    sharp, closes = roundings(dtype, SHARP), roundings(dtype, CLOSED)
    segments = max((WITH_SPINS if system.spinning else SEGMENTS) // share, 1)
    length = max(2 ** (poses - 1).bit_length() // segments, 1)
    # the last segment overlaps the one before it: nothing is filled up, and all results are written where they belong
    first = jnp.asarray(np.minimum(np.arange(-(-poses // length)) * length, poses - length))
    begin, end = values[first], values[first + length - 1]
    middle, half = 0.5 * (begin + end), jnp.maximum(0.5 * jnp.abs(end - begin), NARROWEST)
    status, solid, polynomials, back = _solve_nodes(system, geometry, knots, middle, half)

    def one(number: Array, found: Poses) -> Poses:
        here = lax.dynamic_slice_in_dim(values, first[number], length)
        state = jax.tree.map(lambda c: _at((here - middle[number]) / half[number], c[number]), polynomials)
        predicted = drive(system, retract(system, state, jnp.zeros_like(state.x)), here[None])
        closed = closure(system, geometry, predicted)

        def corrected() -> tuple[State, Array, Array]:
            state = retract(system, predicted, -back[number] @ closed.residual)
            return state, closure(system, geometry, state).gap, difference(state, predicted)

        state, gap, moved = lax.cond(
            any_lane(closed.gap > sharp), corrected, lambda: (predicted, closed.gap, jnp.zeros_like(here))
        )
        trusted = solid[number] & jnp.all((gap <= closes) & (moved <= CORRECTION))
        segment = lax.cond(
            any_lane(~trusted),
            lambda: settle(here),
            lambda: Poses(state, jnp.full(length, status[number]), gap),
        )
        return jax.tree.map(
            lambda whole, part: lax.dynamic_update_slice_in_dim(whole, part, first[number], axis=-1), found, segment
        )

    start = Poses(assembled(system, poses, dtype), jnp.zeros(poses, jnp.int32), jnp.zeros(poses, dtype))
    return lax.fori_loop(0, len(first), one, start)


def _solve_nodes(
    system: LoopSystem,
    geometry: Geometry,
    knots: Knots,
    middle: Float[Array, " segments"],
    half: Float[Array, " segments"],
) -> tuple[Int[Array, " segments"], Bool[Array, " segments"], State, Array]:
    """Of every segment: status, whether that holds for all of its nodes, polynomials of the state, inverse Jacobian."""
    values = (middle[:, None] + half[:, None] * jnp.asarray(NODES, half.dtype)).reshape(-1)
    begin = guess(system, knots, values)
    state = drive(system, begin.state, values[None])
    state, closed, _ = newton(system, geometry, state, roundings(values.dtype, CLOSED))
    middles = closed.jacobian[..., len(NODES) // 2 :: len(NODES)]
    back = inverse(middles, floor(values.dtype), equation_blocks(system))
    basis = jnp.asarray(_coefficients(), values.dtype)

    def polynomial(x: Array, d: Array) -> Array:
        shape = (*x.shape[:-1], half.shape[0], len(NODES))
        x = x.reshape(shape)
        # of differences, which are small: the coefficients of a power are sums that cancel
        centre = x[..., :1]
        data = jnp.concatenate([x - centre, d.reshape(shape) * half[:, None]], axis=-1)
        return jnp.einsum("ij,...sj->s...i", basis, data).at[..., 0].add(jnp.moveaxis(centre[..., 0], -1, 0))

    slope = rate(system, state, slopes(system, state, closed, jnp.ones_like(values)[None]))
    polynomials = jax.tree.map(polynomial, *jax.jvp(partial(at_rest, system, geometry), (state,), (slope,)))
    status = begin.status.reshape(-1, len(NODES))
    good = (closed.gap <= tolerance(values.dtype)) & (difference(state, begin.state) <= NEAR) & begin.covered
    solid = jnp.all((status == status[:, :1]) & good.reshape(status.shape), axis=1)
    return status[:, 0], solid, polynomials, back


def _at(t: Float[Array, " poses"], coefficients: Float[Array, "*entries degree"]) -> Float[Array, "*entries poses"]:
    """Polynomials at these places, by Horner's rule."""
    *lower, total = jnp.moveaxis(coefficients, -1, 0)[..., None]
    for coefficient in reversed(lower):
        total = total * t + coefficient
    return total


def _coefficients() -> np.ndarray:
    """(8, 8): coefficients of the polynomial of degree seven from the values and slopes at the four nodes."""
    powers = np.arange(2 * len(NODES))
    values = NODES[:, None] ** powers
    slopes = powers * NODES[:, None] ** np.maximum(powers - 1, 0)
    return np.linalg.inv(np.concatenate([values, slopes]))
