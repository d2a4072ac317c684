"""Solve the equations that place the features of a part: for `rearrange`, which makes them.

The unknowns are the positions of the features over the size of the part; directions are given. The equations are solved
by damped Gauss-Newton steps and differentiated by the implicit function theorem. `xp` is numpy on the host or jax.numpy
for traced numbers. In shapes, "features" is their number n, "pairs" is n (n - 1) / 2 in the order of
`itertools.combinations`.
"""

from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

PLACEMENT_ITERATIONS = 60
"""Largest number of Gauss-Newton steps: enough for steps of at most `_MAX_STEP`, since the guess is near a solution.

The iteration ends before when a step is of rounding size."""

_MAX_STEP = 0.5
"""Largest norm of a Gauss-Newton step, in units of the size of the part: keeps the solution near the guess."""

_DAMPING = 0.1
"""Damping of a step over (squared residual, at most 1) x (trace of the normal matrix).

Damping that falls with the squared residual steadies the first steps and leaves the convergence quadratic."""

_LEAST_DAMPING = 1e-15
"""Damping over the trace at zero residual: of rounding size, so that a singular normal matrix can be solved."""
_LEAST_DAMPING_ROUNDINGS = 4.0
"""The same in units of rounding, where these are more, as in float32."""

_NORMAL_NUMBERS = 1e8
"""`tiny` over the smallest normal number."""

_HOST_STEP = 1e-16
"""Norm of a step, in units of the size, below which the iteration on the host (float64) ends: half the spacing of
numbers near 1, so that the step changes nothing."""

_DEVICE_ROUNDINGS = 2.0
"""The same norm in JAX, in units of the spacing of numbers near 1 in the precision in use."""

_RANK_TOLERANCE = 1e-8
"""Singular values of the Jacobian below this, relative to the largest, count as zero in derivatives: the root of the
float64 rounding error, since redundant equations agree only as far as the positions are solved. In float32, half the
root of its rounding error."""


def tiny(dtype: Any) -> float:
    """Return what is added to numbers that may be zero before a division, or a square root, whose derivative is
    infinite at zero; far below all other numbers here."""
    return _NORMAL_NUMBERS * float(jnp.finfo(dtype).tiny)


class PairEquations(NamedTuple):
    """The equations of all pairs of features for the vectors d from the first to the second.

    d and all lengths here are divided by the size of the part.
    """

    project: Any
    """(pairs, 3, 3): projects d onto the directions in which the distance is measured."""
    distance: Any
    """(pairs,): the distance that the two features must get."""
    along: Any
    """(pairs, 3): unit vector of the distance, for a linear equation `project d = distance along`."""
    linear: Any
    """(pairs,): whether the equation is the linear one; otherwise it is `|project d| = distance`."""
    offset_vectors: Any
    """(pairs, 2, 3): for the offset along either feature the vector in `vector . d = offset`; zero for no equation."""
    offsets: Any
    """(pairs, 2): the offset along either feature that the other must get; zero for no equation."""
    angle_errors: Any
    """(pairs,): errors of the cosines of the angles, constants, since only positions are solved for."""
    weights: Any
    """(features,): 1 for a feature that moves, else 0."""


def residuals(xp, pairs: PairEquations, positions):
    """Compute the residuals (5 pairs,) of all equations, and their Jacobian (5 pairs, features, 3) by the positions.

    `positions` (features, 3) are the origins over the size. A pair has three rows for its distance (an equation that is
    not linear uses the first only) and one for each of its two offsets.
    """
    count = len(positions)
    first, second = np.array(list(combinations(range(count), 2))).T
    incidence = np.zeros((len(first), count))
    incidence[np.arange(len(first)), first], incidence[np.arange(len(first)), second] = -1.0, 1.0
    d = positions[second] - positions[first]
    projected = xp.einsum("pij,pj->pi", pairs.project, d)
    square = xp.sum(projected**2, axis=1)
    length = xp.sqrt(xp.where(square > 0, square, 1.0))  # 1 for 0: no division by zero, also in derivatives
    linear = pairs.linear[:, None]
    first_row = np.array([1.0, 0.0, 0.0])
    norms = (xp.where(square > 0, length, 0.0) - pairs.distance)[:, None] * first_row
    distances = xp.where(linear, projected - pairs.distance[:, None] * pairs.along, norms)
    slope = xp.einsum("pi,pij->pj", projected / length[:, None], pairs.project)
    slopes = xp.where(linear[:, :, None], pairs.project, first_row[:, None] * slope[:, None])
    offsets = xp.einsum("pej,pj->pe", pairs.offset_vectors, d) - pairs.offsets
    rows = xp.concatenate([distances, offsets], axis=1)
    jacobian = xp.concatenate([slopes, pairs.offset_vectors], axis=1)[:, :, None] * incidence[:, None, :, None]
    return rows.ravel(), jacobian.reshape(rows.size, count, 3)


def solve_positions(xp, pairs: PairEquations, start):
    """Solve for the positions (features, 3) over the size, near `start`; in JAX the result is differentiable."""
    return _search(np, _host_loop, pairs, start) if xp is np else _solve(pairs, start)


def _search(xp, loop, pairs: PairEquations, start):
    """Solve for the positions (features, 3) over the size, from `start`, by damped Gauss-Newton steps.

    `loop(step, start)` repeats `step`, which maps positions to the next positions and the norm of the step.
    """
    weights = xp.repeat(pairs.weights, 3)
    least = tiny(start.dtype)
    least_damping = max(_LEAST_DAMPING, _LEAST_DAMPING_ROUNDINGS * float(xp.finfo(start.dtype).eps))

    def step(positions):
        rows, jacobian = residuals(xp, pairs, positions)
        slope = jacobian.reshape(rows.size, -1) * weights
        gram = slope.T @ slope
        damping = (_DAMPING * xp.minimum(rows @ rows, 1.0) + least_damping) * xp.trace(gram) + least
        delta = -weights * xp.linalg.solve(gram + damping * xp.eye(len(gram)), slope.T @ rows)
        length = xp.sqrt(delta @ delta)
        delta = delta * xp.minimum(1.0, _MAX_STEP / (length + least))
        return positions + delta.reshape(positions.shape), length

    return loop(step, start)


def _host_loop(step, positions):
    """Repeat steps in numpy until they are of rounding size."""
    for _ in range(PLACEMENT_ITERATIONS):
        positions, length = step(positions)
        if length < _HOST_STEP:
            break
    return positions


def _device_loop(step, positions):
    """Repeat steps in JAX until they are of rounding size."""

    def next_carry(carry):
        count, positions, _ = carry
        return count + 1, *step(positions)

    start = (jnp.asarray(0), positions, jnp.asarray(jnp.inf, positions.dtype))
    least = _DEVICE_ROUNDINGS * float(jnp.finfo(positions.dtype).eps)
    return lax.while_loop(lambda carry: (carry[0] < PLACEMENT_ITERATIONS) & (carry[2] > least), next_carry, start)[1]


@jax.custom_jvp
def _solve(pairs: PairEquations, start: Float[Array, "features 3"]) -> Float[Array, "features 3"]:
    """Solve for the positions in JAX, with derivatives by the implicit function theorem (`_solve_jvp`)."""
    return _search(jnp, _device_loop, pairs, start)


@_solve.defjvp
def _solve_jvp(primals, tangents):
    """Compute the positions and their derivative: J dx = -dr for the features that move, by the least norm."""
    (pairs, start), (d_pairs, d_start) = primals, tangents
    positions = _solve(pairs, start)
    # features that stay have the derivative of the start; the others correct theirs by the least-norm solution
    _, d_rows = jax.jvp(lambda p, x: residuals(jnp, p, x)[0], (pairs, positions), (d_pairs, d_start))
    rows, jacobian = residuals(jnp, pairs, positions)
    weights = jnp.repeat(pairs.weights, 3)
    least = max(_RANK_TOLERANCE, 0.5 * float(jnp.finfo(rows.dtype).eps) ** 0.5)
    inverse = jnp.linalg.pinv(jacobian.reshape(rows.size, -1) * weights, rtol=least)
    return positions, d_start - (weights * (inverse @ d_rows)).reshape(positions.shape)
