"""Many poses at once, between few that were solved: interpolation of high order, one correction, a check of each pose.

A range in order is cut into segments. At four poses of each the state and its exact slope are known, which makes a
polynomial of degree seven; over a segment of a twentieth of a radian it is right to about 1e-13. One chord step
(Newton's, with the inverse Jacobian of the middle of the segment) leaves rounding only. Each pose then has to close by
itself: what does not is left to the damped corrector.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure import Closure, Geometry, closure
from jaxkin.solve.continuation import slopes
from jaxkin.solve.correct import floor, free_jacobian
from jaxkin.solve.knots import Knots, guess
from jaxkin.solve.linear import least_norm, scale
from jaxkin.solve.state import State, difference, drive, rate, retract
from jaxkin.solve.status import tolerance
from jaxkin.solve.system import LoopSystem

SEGMENTS, WITH_SPINS = 128, 512
"""At most so many, of a number of poses that is a power of two. Where rods spin between balls, and a ball passes near
half a turn, the spin changes fast."""
NODES = -np.cos(np.pi * (2 * np.arange(4) + 1) / 8)
"""Where a segment from -1 to 1 is solved beforehand: the zeros of a Chebyshev polynomial."""
NARROWEST = 1e-4
"""Half the width of the narrowest segment, radians or characteristic lengths: repeated inputs have no width."""
CORRECTION = 1e-6
"""A pose farther from the polynomial than this is not trusted."""
NEAR = 1e-3
"""A node farther from where the knots put it is not trusted."""
CLOSED = 64
"""Times the unit of rounding: a pose that does not close as well as this is left to the corrector."""


class Poses(NamedTuple):
    """Poses as they were found: numbers without derivatives."""

    state: State
    status: Int[Array, " poses"]
    gap: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""


def interpolate(
    system: LoopSystem, geometry: Geometry, knots: Knots, values: Float[Array, " poses"]
) -> tuple[Poses, Bool[Array, " poses"]]:
    """All poses from those at the nodes of the segments, and which of them are trusted."""
    dtype, poses = values.dtype, values.shape[0]
    length = max(2 ** (poses - 1).bit_length() // (WITH_SPINS if system.spins else SEGMENTS), 1)
    rows = jnp.pad(values, (0, -poses % length), mode="edge").reshape(-1, length)
    middle, half = 0.5 * (rows[:, 0] + rows[:, -1]), jnp.maximum(0.5 * jnp.abs(rows[:, -1] - rows[:, 0]), NARROWEST)
    status, solid, polynomials, inverse = _solve_nodes(system, geometry, knots, middle, half)

    def one(segment):
        coefficients, inverse, middle, half, values = segment
        powers = _powers((values - middle) / half)
        state = jax.tree.map(lambda c: jnp.tensordot(c, powers, 1), coefficients)
        predicted = drive(system, retract(system, state, jnp.zeros_like(state.x)), values[None])
        delta = -inverse @ closure(system, geometry, predicted).residual
        state = retract(system, predicted, delta)
        gap = closure(system, geometry, state).gap
        trusted = (gap <= CLOSED * float(jnp.finfo(dtype).eps)) & (difference(state, predicted) <= CORRECTION)
        return state, gap, trusted

    found = lax.map(one, (polynomials, inverse, middle, half, rows))
    whole = jax.tree.map(lambda a: jnp.moveaxis(a, 0, -2).reshape(*a.shape[1:-1], rows.size)[..., :poses], found)
    state, gap, trusted = whole
    return Poses(state, jnp.repeat(status, length)[:poses], gap), trusted & jnp.repeat(solid, length)[:poses]


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

    def newton(_, carry: tuple[State, Closure]) -> tuple[State, Closure]:
        state, closed = carry
        jacobian = free_jacobian(system, closed)
        state = retract(system, state, -least_norm(jacobian, closed.residual, floor(values.dtype) * scale(jacobian)))
        return state, closure(system, geometry, state)

    state = drive(system, begin.state, values[None])
    state, closed = lax.fori_loop(0, 3, newton, (state, closure(system, geometry, state)))
    inverse = _inverse(system, free_jacobian(system, closed)[..., len(NODES) // 2 :: len(NODES)])
    basis = jnp.asarray(_coefficients(), values.dtype)

    def polynomial(x: Array, d: Array) -> Array:
        shape = (*x.shape[:-1], half.shape[0], len(NODES))
        data = jnp.concatenate([x.reshape(shape), d.reshape(shape) * half[:, None]], axis=-1)
        return jnp.einsum("ij,...sj->s...i", basis, data)

    polynomials = jax.tree.map(
        polynomial, state, rate(system, state, slopes(system, state, closed, jnp.ones_like(values)[None]))
    )
    status = begin.status.reshape(-1, len(NODES))
    good = (closed.gap <= tolerance(values.dtype)) & (difference(state, begin.state) <= NEAR) & begin.covered
    solid = jnp.all((status == status[:, :1]) & good.reshape(status.shape), axis=1)
    return status[:, 0], solid, polynomials, inverse


def _inverse(
    system: LoopSystem, jacobian: Float[Array, "equations columns segments"]
) -> Float[Array, "segments columns equations"]:
    """The inverse Jacobian of least norm; zero for what is driven."""
    unit, damping = jnp.eye(system.equations, dtype=jacobian.dtype), floor(jacobian.dtype) * scale(jacobian)
    columns = jax.vmap(lambda e: least_norm(jacobian, jnp.broadcast_to(e[:, None], jacobian.shape[::2]), damping))(unit)
    return jnp.transpose(columns, (2, 1, 0))


def _powers(t: Float[Array, " poses"]) -> Float[Array, "degree poses"]:
    square = t * t
    low = jnp.stack([jnp.ones_like(t), t, square, square * t])
    return jnp.concatenate([low, low * (square * square)])


def _coefficients() -> np.ndarray:
    """(8, 8): coefficients of the polynomial of degree seven from the values and slopes at the four nodes."""
    powers = np.arange(2 * len(NODES))
    values = NODES[:, None] ** powers
    slopes = powers * NODES[:, None] ** np.maximum(powers - 1, 0)
    return np.linalg.inv(np.concatenate([values, slopes]))
