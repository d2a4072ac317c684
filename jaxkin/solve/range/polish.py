"""Predict each pose from the samples of the branch and correct it, independently of all other poses.

Newton's method closes nearly all poses. Poses that it does not close, because they are beside a limit or beyond one,
are left to the damped corrector (`damped_poses`).
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.continuation.branch_samples import BranchSamples, predict
from jaxkin.solve.continuation.fronts import ContinuationProblem
from jaxkin.solve.correctors.newton import newton
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.range.damped_poses import correct_damped
from jaxkin.solve.range.poses import MAX_CORRECTION, RangePoses
from jaxkin.solve.status import (
    CLOSED_ROUNDINGS,
    ClosureTolerance,
    Status,
    classify,
    closes_before_limits,
    rounding_residual,
)
from jaxkin.solve.system.state import State, difference, drive, select_poses


def correct_poses(
    problem: ContinuationProblem,
    samples: BranchSamples,
    at: Float[Array, " poses"],
    inputs: Float[Array, "driven poses"],
    tolerance: ClosureTolerance,
) -> RangePoses:
    """Predict the poses at distances `at` along the path, set their inputs, and correct them to closure.

    `inputs` are in radians and characteristic lengths. Poses that Newton's method does not close are corrected by the
    damped corrector, or are STALLED with `follow_limits=False` of the problem. A pose that the samples do not reach
    (`Prediction.covered`) is STALLED whatever its residual.
    """
    system = problem.system
    prediction = predict(system, samples, at)
    state = drive(system, prediction.state, inputs)
    may_close = closes_before_limits(prediction.status)

    def by_newton() -> tuple[State, Array]:
        quick, _, residual_norm = newton(problem, state, tolerance.target_residual)
        return quick, residual_norm

    if problem.follow_limits is False:  # known when the program is made: it holds no damped corrector
        quick, residual_norm = by_newton()
    else:
        nothing = state, jnp.full(at.shape, jnp.inf, at.dtype)
        quick, residual_norm = lax.cond(any_in_lockstep(may_close), by_newton, lambda: nothing)
    near = difference(quick, state) <= MAX_CORRECTION
    closes = residual_norm <= jnp.maximum(rounding_residual(at.dtype, CLOSED_ROUNDINGS), tolerance.target_residual)
    good = closes & near & prediction.covered & may_close
    found = RangePoses(quick, jnp.where(good, prediction.status, Status.STALLED.value), residual_norm)

    def damped() -> RangePoses:
        corrected, residual_norm, stationary = correct_damped(problem, at, state, ~good, tolerance.target_residual)
        near = difference(corrected, state) <= MAX_CORRECTION
        same_branch = near & (prediction.status == Status.CLOSED.value)
        status = classify(residual_norm, stationary, same_branch, tolerance.max_residual)
        status = jnp.where(prediction.covered, status, Status.STALLED.value)
        return select_poses(good, found, RangePoses(corrected, status, residual_norm))

    if problem.follow_limits is False:
        return found
    return lax.cond(any_in_lockstep(~good) & problem.follow_limits, damped, lambda: found)
