"""Minimise as the paper does: by the method of Davidon, Fletcher and Powell (Fletcher and Powell 1963).

This quasi-Newton method starts with the unit matrix as its estimate of the inverse Hessian, and uses the cubic line
search of the same authors. The gradient is computed by central differences, as in a program that can only evaluate
Eq. 12, or by automatic differentiation.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

Objective = Callable[[Array], Array]
Point = Float[Array, " n"]
DFP_ITERATIONS = 200
"""Largest number of iterations: progress may be slow where the estimate of the Hessian is reset."""
MAX_DOUBLINGS = 20
"""Largest number of doublings of the first step of a line search: up to a million times its length."""


class _Iterate(NamedTuple):
    count: Array
    x: Point
    value: Array
    gradient: Point
    inverse: Float[Array, "n n"]
    """Estimate of the inverse Hessian."""
    done: Array


def central_differences(objective: Objective) -> Callable[[Point], Point]:
    """Return the gradient by central differences, with the step eps^(1/3), which balances rounding and truncation."""

    def gradient(x: Point) -> Point:
        step = float(jnp.finfo(x.dtype).eps) ** (1 / 3)
        shifts = step * jnp.eye(x.shape[0], dtype=x.dtype)
        values = lax.map(objective, jnp.concatenate([x + shifts, x - shifts]))
        return (values[: x.shape[0]] - values[x.shape[0] :]) / (2 * step)

    return gradient


def dfp(objective: Objective, gradient: Callable[[Point], Point], start: Point, target: Array) -> Point:
    """Minimise the objective from the point `start` (n,), until its value is at most `target` or falls no more."""

    def step(at: _Iterate) -> _Iterate:
        direction = -at.inverse @ at.gradient
        slope = direction @ at.gradient
        downhill = slope < 0
        direction = jnp.where(downhill, direction, -at.gradient)
        slope = jnp.where(downhill, slope, -at.gradient @ at.gradient)
        moved = _along(objective, gradient, at.x, direction, at.value, slope) * direction
        x = at.x + moved
        value, new = objective(x), gradient(x)
        change = new - at.gradient
        seen, curved = moved @ change, at.inverse @ change
        safe = (seen > 0) & (change @ curved > 0)
        update = jnp.outer(moved, moved) / jnp.where(safe, seen, 1.0)
        update -= jnp.outer(curved, curved) / jnp.where(safe, change @ curved, 1.0)
        unit = jnp.eye(x.shape[0], dtype=x.dtype)
        inverse = jnp.where(safe, at.inverse + update, jnp.where(downhill, at.inverse, unit))
        better = value < at.value
        done = (value <= target) | ~better
        x, value, new = (jnp.where(better, a, b) for a, b in ((x, at.x), (value, at.value), (new, at.gradient)))
        return _Iterate(at.count + 1, x, value, new, inverse, done)

    value = objective(start)
    unit = jnp.eye(start.shape[0], dtype=start.dtype)
    first = _Iterate(jnp.asarray(0), start, value, gradient(start), unit, value <= target)
    return lax.while_loop(lambda at: (at.count < DFP_ITERATIONS) & ~at.done, step, first).x


def _along(objective: Objective, gradient, x: Point, direction: Point, value: Array, slope: Array) -> Array:
    """Find the step length at which the objective is least along a direction: bracket by doubling, then fit a cubic.

    The step is doubled until the objective rises. The cubic goes through values and slopes at both ends of the last
    interval. The first step would bring the objective to zero, its least possible value, if it were a parabola.
    """

    def ends(length: Array) -> tuple[Array, Array]:
        point = x + length * direction
        return objective(point), gradient(point) @ direction

    def rising(carry) -> Array:
        count, _, (_, low, falling), (_, high, rise) = carry
        return (count < MAX_DOUBLINGS) & (rise < 0) & (high < low) & (falling < 0)

    def further(carry):
        count, length, _, b = carry
        length = 2 * length
        return count + 1, length, b, (length, *ends(length))

    first = jnp.minimum(1.0, -2 * value / jnp.where(slope < 0, slope, -1.0))
    begin = (jnp.asarray(0), first, (jnp.zeros_like(first), value, slope), (first, *ends(first)))
    _, _, (a, low, falling), (b, high, rise) = lax.while_loop(rising, further, begin)
    width = jnp.where(b > a, b - a, 1.0)
    z = 3 * (low - high) / width + falling + rise
    w = jnp.sqrt(jnp.maximum(z * z - falling * rise, 0.0))
    bottom = rise - falling + 2 * w
    inside = b - width * (rise + w - z) / jnp.where(bottom != 0, bottom, 1.0)
    inside = jnp.clip(jnp.where(jnp.isfinite(inside) & (bottom != 0), inside, b), a, b)
    lengths = jnp.stack([inside, b, 0.5 * (a + b)])
    values = jax.vmap(lambda length: objective(x + length * direction))(lengths)
    return lengths[jnp.argmin(jnp.where(jnp.isfinite(values), values, jnp.inf))]
