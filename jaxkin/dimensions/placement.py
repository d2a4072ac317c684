"""Solve the equations that place the features of a part: for `rearrange`, which makes them.

The unknowns are the positions of the features over the size of the part; directions are given. The equations are solved
by damped Gauss-Newton steps and differentiated by the implicit function theorem. `xp` is numpy on the host or jax.numpy
for traced numbers. In shapes, "features" is their number n, "pairs" is n (n - 1) / 2 in the order of
`itertools.combinations`.
"""

from __future__ import annotations

from functools import partial
from itertools import combinations
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.ldl import factor_entries

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

MAX_UNROLLED_UNKNOWNS = 9
"""Largest number of unknowns that straight-line code solves in JAX: those of three features that move. A library solves
one design after another: for 1,000 designs of three features that took half of the time of their lengths."""

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
    """Compute the residuals (pairs, 5) of all equations, and their slopes (pairs, 5, 3) by the vectors d.

    `positions` (features, 3) are the origins over the size. A pair has three rows for its distance (an equation that is
    not linear uses the first only) and one for each of its two offsets. All arrays may have one more axis, the last:
    that of several designs.
    """
    first, second = _ends(len(positions))
    d = positions[second] - positions[first]
    projected = _sum(pairs.project * d[:, None], 2)
    square = _sum(projected**2, 1)
    length = xp.sqrt(xp.where(square > 0, square, 1.0))[:, None]  # 1 for 0: no division by zero, also in derivatives
    linear = pairs.linear[:, None]
    first_row = np.array([1.0, 0.0, 0.0]).reshape(3, *[1] * (d.ndim - 2))
    norms = (xp.where(square > 0, length[:, 0], 0.0) - pairs.distance)[:, None] * first_row
    distances = xp.where(linear, projected - pairs.distance[:, None] * pairs.along, norms)
    slope = _sum((projected / length)[:, :, None] * pairs.project, 1)
    slopes = xp.where(linear[:, :, None], pairs.project, first_row[:, None] * slope[:, None])
    offsets = _sum(pairs.offset_vectors * d[:, None], 2) - pairs.offsets
    return xp.concatenate([distances, offsets], axis=1), xp.concatenate([slopes, pairs.offset_vectors], axis=1)


def _sum(terms, axis: int) -> Any:
    """Add up the few terms along an axis, one after another: for XLA that is a tenth of the time of its sums."""
    return sum(terms[(slice(None),) * axis + (k,)] for k in range(terms.shape[axis]))


def _ends(count: int) -> tuple[np.ndarray, np.ndarray]:
    """List the first and the second feature of each pair of so many features."""
    first, second = np.array(list(combinations(range(count), 2))).T
    return first, second


def _incidence(count: int) -> np.ndarray:
    """Make the matrix (pairs, features) that takes positions to the vectors d."""
    first, second = _ends(count)
    incidence = np.zeros((len(first), count))
    incidence[np.arange(len(first)), first], incidence[np.arange(len(first)), second] = -1.0, 1.0
    return incidence


def solve_positions(xp, pairs: PairEquations, movable: tuple[int, ...], start):
    """Solve for the positions (features, 3) over the size, near `start`; in JAX the result is differentiable.

    `movable` are the features that may move: all others have the weight zero.
    """
    if xp is np:
        return _search(np, _host_loop, pairs, movable, start)
    return _solve(movable, pairs, start)


def _search(xp, loop, pairs: PairEquations, movable: tuple[int, ...], start):
    """Solve for the positions (features, 3) over the size, from `start`, by damped Gauss-Newton steps.

    `loop(step, start)` repeats `step`, which maps positions to the next positions and the norm of the step. All arrays
    may have one more axis, the last: that of several designs.
    """
    incidence, weights = _incidence(len(start)), pairs.weights
    least = tiny(start.dtype)
    least_damping = max(_LEAST_DAMPING, _LEAST_DAMPING_ROUNDINGS * float(xp.finfo(start.dtype).eps))

    def step(positions):
        rows, slopes = residuals(xp, pairs, positions)
        squares = _sum(slopes[:, :, :, None] * slopes[:, :, None], 1)
        pulls = _sum(slopes * rows[:, :, None], 1)

        def block(one: int, other: int):
            signs = incidence[:, one] * incidence[:, other]
            return weights[one] * weights[other] * sum(signs[pair] * squares[pair] for pair in np.flatnonzero(signs))

        def pull(one: int):
            signs = incidence[:, one]
            return weights[one] * sum(signs[pair] * pulls[pair] for pair in np.flatnonzero(signs))

        gram = [[block(one, other) for other in movable[: k + 1]] for k, one in enumerate(movable)]
        trace = sum(gram[k][k][i, i] for k in range(len(movable)) for i in range(3))
        damping = (_DAMPING * xp.minimum(_sum(_sum(rows**2, 0), 0), 1.0) + least_damping) * trace + least
        delta = -_solved(xp, gram, damping, xp.concatenate([pull(one) for one in movable]))
        length = xp.sqrt(_sum(delta**2, 0))
        delta = delta * xp.minimum(1.0, _MAX_STEP / (length + least))
        changes = dict(zip(movable, delta.reshape(-1, *start.shape[1:]), strict=True))
        rest = xp.zeros_like(start[0])
        return positions + xp.stack([weights[k] * changes.get(k, rest) for k in range(len(start))]), length

    return loop(step, start)


def _solved(xp, gram, damping, right):
    """Solve (G + damping 1) x = right for x (unknowns,), with G by its blocks of 3 by 3 on and below the diagonal.

    In JAX, few unknowns of many designs are solved by straight-line code, for all designs side by side.
    """
    unknowns, count = len(right), len(gram)
    if xp is not np and unknowns <= MAX_UNROLLED_UNKNOWNS:

        def entry(i: int, j: int):
            own = gram[i // 3][j // 3][i % 3, j % 3]
            return own + damping if i == j else own

        return factor_entries(entry, unknowns)(right)
    blocks = [[gram[i][j] if j <= i else gram[j][i].swapaxes(0, 1) for j in range(count)] for i in range(count)]
    whole = xp.concatenate([xp.concatenate(row, axis=1) for row in blocks]).reshape(unknowns, unknowns, -1)
    matrices = xp.moveaxis(whole, -1, 0) + xp.reshape(damping, (-1, 1, 1)) * np.eye(unknowns)
    sides = xp.moveaxis(right.reshape(unknowns, 1, -1), -1, 0)
    return xp.moveaxis(xp.linalg.solve(matrices, sides), 0, -1).reshape(right.shape)


def _host_loop(step, positions):
    """Repeat steps in numpy until they are of rounding size."""
    for _ in range(PLACEMENT_ITERATIONS):
        positions, length = step(positions)
        if length < _HOST_STEP:
            break
    return positions


def _device_loop(step, positions):
    """Repeat steps in JAX until they are of rounding size; designs that are done rest while others go on."""

    def next_carry(carry):
        count, positions, length = carry
        found, step_length = step(positions)
        going = length > least
        return count + 1, jnp.where(going, found, positions), jnp.where(going, step_length, length)

    start = (jnp.asarray(0), positions, jnp.full(positions.shape[2:], jnp.inf, positions.dtype))
    least = _DEVICE_ROUNDINGS * float(jnp.finfo(positions.dtype).eps)
    return lax.while_loop(
        lambda carry: (carry[0] < PLACEMENT_ITERATIONS) & jnp.any(carry[2] > least), next_carry, start
    )[1]


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _solve(
    movable: tuple[int, ...], pairs: PairEquations, start: Float[Array, "features 3"]
) -> Float[Array, "features 3"]:
    """Solve for the positions in JAX, with derivatives by the implicit function theorem (`_solve_jvp`).

    Under `vmap` many designs are solved side by side, along the last axis, so that vector units run through them.
    """

    @jax.custom_batching.custom_vmap
    def search(pairs: PairEquations, start: Array) -> Array:
        return _search(jnp, _device_loop, pairs, movable, start)

    @search.def_vmap
    def search_many(size: int, batched, *given):
        def designs_last(array: Array, is_batched: bool) -> Array:
            array = array if is_batched else jnp.broadcast_to(array, (size, *array.shape))
            return jnp.moveaxis(array, 0, -2).reshape(*array.shape[1:-1], -1)

        found = search(*jax.tree.map(designs_last, given, tuple(batched)))
        return jnp.moveaxis(found.reshape(*start.shape, size, -1), -2, 0), True

    return search(*jax.tree.map(lambda array: array[..., None], (pairs, start)))[..., 0]


@_solve.defjvp
def _solve_jvp(movable: tuple[int, ...], primals, tangents):
    """Compute the positions and their derivative: J dx = -dr for the features that move, by the least norm."""
    (pairs, start), (d_pairs, d_start) = primals, tangents
    positions = _solve(movable, pairs, start)
    # features that stay have the derivative of the start; the others correct theirs by the least-norm solution
    _, d_rows = jax.jvp(lambda p, x: residuals(jnp, p, x)[0], (pairs, positions), (d_pairs, d_start))
    rows, slopes = residuals(jnp, pairs, positions)
    jacobian = slopes[:, :, None] * (_incidence(len(start))[:, :, None] * pairs.weights[:, None])[:, None]
    least = max(_RANK_TOLERANCE, 0.5 * float(jnp.finfo(rows.dtype).eps) ** 0.5)
    inverse = jnp.linalg.pinv(jacobian.reshape(rows.size, -1), rtol=least)
    return positions, d_start - (jnp.repeat(pairs.weights, 3) * (inverse @ d_rows.ravel())).reshape(positions.shape)
