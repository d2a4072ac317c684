"""Find many poses of a single input by interpolation of high order, and check the closure of each.

A sorted range is cut into segments. At four nodes of each segment the state and its exact slope are computed, and
define a polynomial of degree seven; over a segment of a fortieth of a radian its error is about rounding. Where the
error is larger, one chord step (a Newton step with the inverse Jacobian from near the middle of the segment) closes the
poses. The residual of each pose is then checked, and a segment in which a pose is not closed is corrected pose by pose.
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

from jaxkin.solve.closure.closure import closure
from jaxkin.solve.closure.joint_coordinates import remove_idle_spin
from jaxkin.solve.continuation.branch_samples import BranchSamples, predict
from jaxkin.solve.continuation.fronts import ContinuationProblem
from jaxkin.solve.continuation.input_slopes import input_slopes
from jaxkin.solve.correctors.newton import newton
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.linear.blocks import inverse_jacobian
from jaxkin.solve.linear.least_norm import damping_floor
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.range.groups import LARGEST_GROUP, in_groups
from jaxkin.solve.range.poses import RangePoses
from jaxkin.solve.status import CLOSED_ROUNDINGS, default_tolerance, rounding_residual
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.state import State, assembled, difference, drive, rate, retract, select_poses

MAX_SEGMENTS = 256
"""Largest number of segments of a range: those of a full turn are a fortieth of a radian wide."""
MAX_SEGMENTS_WITH_SPINS = 512
"""Largest number of segments where rods spin idly between balls: the spin changes fast where a ball is rotated by
nearly half a turn."""
NODES = -np.cos(np.pi * (2 * np.arange(4) + 1) / 8)
"""Nodes of a segment from -1 to 1, at which it is solved first: the zeros of a Chebyshev polynomial, which spread the
error evenly over the segment."""
NARROWEST = 1e-4
"""Least half width of a segment, radians or characteristic lengths: repeated inputs have no width."""
MAX_CHORD_STEP = 1e-6
"""Largest length of a chord step, radians or characteristic lengths, at which the polynomial is trusted to be on the
branch: the error of a good fit is many times smaller."""
MAX_NODE_CORRECTION = 1e-2
"""Largest distance of a node from its prediction, radians or characteristic lengths, at which the node is trusted to be
on the branch."""
SHARP_ROUNDINGS = 32
"""Residual norm, in units of rounding, above which the poses of a segment are corrected: half of `CLOSED_ROUNDINGS`, so
that poses without a correction are closed by a margin."""


class _Segments(NamedTuple):
    """The segments of a range, with the polynomials that interpolate their poses."""

    first: Int[Array, " segments"]
    """Number of the first pose. The last segment overlaps the one before it, so that all have the same length."""
    middle: Float[Array, " segments"]
    """Input in the middle of the segment."""
    half_width: Float[Array, " segments"]
    """Half the difference between the inputs at both ends of the segment."""
    status: Int[Array, " segments"]
    """Status of all poses of the segment, if it is trusted."""
    trusted: Bool[Array, " segments"]
    """Whether all nodes closed, near their predictions, with one status."""
    polynomials: State
    """Coefficients of the polynomials of all entries of the state, over the argument from -1 to 1: arrays (segments,
    entries, powers), lowest power first."""
    inverses: Float[Array, "segments columns equations"]
    """Least-norm inverse of the Jacobian at the third of the four nodes."""


def interpolate(
    problem: ContinuationProblem,
    samples: BranchSamples,
    values: Float[Array, " poses"],
    correct: Callable[[Float[Array, " group"]], RangePoses],
    shard_count: int,
) -> RangePoses:
    """Find the poses for sorted values of a single input, which are one of `shard_count` shards of a range.

    `correct` finds poses, given their inputs, where the polynomials of their segment cannot be trusted.
    """
    system, geometry, dtype, poses = problem.system, problem.geometry, values.dtype, values.shape[0]
    sharp, closes = rounding_residual(dtype, SHARP_ROUNDINGS), rounding_residual(dtype, CLOSED_ROUNDINGS)
    max_segments = max((MAX_SEGMENTS_WITH_SPINS if system.spinning else MAX_SEGMENTS) // shard_count, 1)
    length = max(2 ** (poses - 1).bit_length() // max_segments, 1)
    segments = _solved_segments(problem, samples, values, length)

    def fill_segment(number: Array, filled: tuple[RangePoses, Array]) -> tuple[RangePoses, Array]:
        first = segments.first[number]
        here = lax.dynamic_slice_in_dim(values, first, length)
        t = (here - segments.middle[number]) / segments.half_width[number]
        state = jax.tree.map(lambda coefficients: _horner(t, coefficients[number]), segments.polynomials)
        predicted = drive(system, retract(system, state, jnp.zeros_like(state.x)), here[None])
        evaluation = closure(system, geometry, predicted)

        def chord_step() -> tuple[State, Array, Array]:
            state = retract(system, predicted, -segments.inverses[number] @ evaluation.residual)
            return state, closure(system, geometry, state).residual_norm, difference(state, predicted)

        state, residual_norm, moved = lax.cond(
            any_in_lockstep(evaluation.residual_norm > sharp),
            chord_step,
            lambda: (predicted, evaluation.residual_norm, jnp.zeros_like(here)),
        )
        good = segments.trusted[number] & jnp.all((residual_norm <= closes) & (moved <= MAX_CHORD_STEP))
        segment = RangePoses(state, jnp.full(length, segments.status[number]), residual_norm), jnp.full(length, ~good)
        return jax.tree.map(
            lambda whole, part: lax.dynamic_update_slice_in_dim(whole, part, first, axis=-1), filled, segment
        )

    def corrected(group: tuple[Array, RangePoses, Array]) -> RangePoses:
        here, found, wrong = group
        return lax.cond(any_in_lockstep(wrong), lambda: select_poses(wrong, correct(here), found), lambda: found)

    start = RangePoses(assembled(system, poses, dtype), jnp.zeros(poses, jnp.int32), jnp.zeros(poses, dtype))
    found, wrong = lax.fori_loop(0, len(segments.first), fill_segment, (start, jnp.zeros(poses, bool)))
    return lax.cond(
        any_in_lockstep(wrong), lambda: in_groups(corrected, (values, found, wrong), LARGEST_GROUP), lambda: found
    )


def _solved_segments(
    problem: ClosureProblem, samples: BranchSamples, values: Float[Array, " poses"], length: int
) -> _Segments:
    """Cut the values into segments of `length` poses, and solve the nodes of all segments at once."""
    system, poses = problem.system, values.shape[0]
    # the last segment overlaps the one before it, so that no segment needs padding
    first = jnp.asarray(np.minimum(np.arange(-(-poses // length)) * length, poses - length))
    begin, end = values[first], values[first + length - 1]
    middle, half_width = 0.5 * (begin + end), jnp.maximum(0.5 * jnp.abs(end - begin), NARROWEST)

    nodes = (middle[:, None] + half_width[:, None] * jnp.asarray(NODES, values.dtype)).reshape(-1)
    prediction = predict(system, samples, nodes)
    state = drive(system, prediction.state, nodes[None])
    state, evaluation, _ = newton(problem, state, rounding_residual(values.dtype, CLOSED_ROUNDINGS))
    middles = evaluation.jacobian[..., len(NODES) // 2 :: len(NODES)]
    inverses = inverse_jacobian(middles, damping_floor(values.dtype), equation_blocks(system))

    slope = rate(system, state, input_slopes(system, state, evaluation, jnp.ones_like(nodes)[None]))
    state_and_slope = jax.jvp(partial(remove_idle_spin, system, problem.geometry), (state,), (slope,))
    polynomials = jax.tree.map(partial(_coefficients, half_width), *state_and_slope)
    status = prediction.status.reshape(-1, len(NODES))
    near = difference(state, prediction.state) <= MAX_NODE_CORRECTION
    good = (evaluation.residual_norm <= default_tolerance(values.dtype)) & near & prediction.covered
    trusted = jnp.all((status == status[:, :1]) & good.reshape(status.shape), axis=1)
    return _Segments(first, middle, half_width, status[:, 0], trusted, polynomials, inverses)


def _coefficients(
    half_width: Float[Array, " segments"], x: Float[Array, "*entries nodes"], slope: Float[Array, "*entries nodes"]
) -> Float[Array, "segments *entries degree"]:
    """Compute the polynomials through values and slopes at the nodes of all segments, lowest power first."""
    basis = jnp.asarray(_hermite_basis(), half_width.dtype)
    shape = (*x.shape[:-1], half_width.shape[0], len(NODES))
    x = x.reshape(shape)
    # differences from the first node are small, which keeps the rounding of the coefficients small: their sums cancel
    origin = x[..., :1]
    data = jnp.concatenate([x - origin, slope.reshape(shape) * half_width[:, None]], axis=-1)
    return jnp.einsum("ij,...sj->s...i", basis, data).at[..., 0].add(jnp.moveaxis(origin[..., 0], -1, 0))


def _horner(t: Float[Array, " poses"], coefficients: Float[Array, "*entries degree"]) -> Float[Array, "*entries poses"]:
    """Evaluate polynomials at `t` by Horner's rule."""
    *lower, total = jnp.moveaxis(coefficients, -1, 0)[..., None]
    for coefficient in reversed(lower):
        total = total * t + coefficient
    return total


def _hermite_basis() -> np.ndarray:
    """Compute the matrix (8, 8) from values and slopes at the four nodes to the coefficients of degree 0 to 7."""
    powers = np.arange(2 * len(NODES))
    values = NODES[:, None] ** powers
    slopes = powers * NODES[:, None] ** np.maximum(powers - 1, 0)
    return np.linalg.inv(np.concatenate([values, slopes]))
