"""Predict each pose from the samples of the branch and correct it, independently of all other poses.

Newton's method closes nearly all poses. Poses that it does not close, because they are beside a limit or beyond one,
are left to the damped corrector, in small groups of their own, so that they do not slow down the others.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.continuation.branch_samples import BranchSamples, predict
from jaxkin.solve.continuation.fronts import ContinuationProblem
from jaxkin.solve.correctors.levenberg_marquardt import levenberg_marquardt, select_poses
from jaxkin.solve.correctors.newton import CLOSED_ROUNDINGS, newton
from jaxkin.solve.device import group_for_device
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.range.poses import MAX_CORRECTION, Poses
from jaxkin.solve.status import ClosureTolerance, Scalar, Status, classify, is_closed, rounding_residual
from jaxkin.solve.system.state import State, difference, drive

DAMPED_GROUP = 32
"""Number of poses that the damped corrector works on at once on CPUs: in most groups Newton's method leaves no more
open."""


def correct_poses(
    problem: ContinuationProblem,
    samples: BranchSamples,
    at: Float[Array, " poses"],
    inputs: Float[Array, "driven poses"],
    tolerance: ClosureTolerance,
) -> Poses:
    """Predict the poses at distances `at` along the path, set their inputs, and correct them to closure.

    `inputs` are in radians and characteristic lengths. Poses that Newton's method does not close are corrected by the
    damped corrector, or are STALLED with `follow_limits=False` of the problem. A pose that the samples do not reach
    (`Prediction.covered`) is STALLED whatever its residual.
    """
    system = problem.system
    prediction = predict(system, samples, at)
    state = drive(system, prediction.state, inputs)
    quick, _, residual_norm = newton(problem, state, tolerance.target_residual)
    near = difference(quick, state) <= MAX_CORRECTION
    closes = residual_norm <= jnp.maximum(rounding_residual(at.dtype, CLOSED_ROUNDINGS), tolerance.target_residual)
    good = closes & near & prediction.covered & is_closed(prediction.status)
    found = Poses(quick, jnp.where(good, prediction.status, Status.STALLED.value), residual_norm)

    def damped() -> Poses:
        corrected, residual_norm, stationary = _correct_some(problem, state, ~good, tolerance.target_residual)
        near = difference(corrected, state) <= MAX_CORRECTION
        same_branch = near & (prediction.status == Status.CLOSED.value)
        status = classify(residual_norm, stationary, same_branch, tolerance.max_residual)
        status = jnp.where(prediction.covered, status, Status.STALLED.value)
        return select_poses(good, found, Poses(corrected, status, residual_norm))

    if problem.follow_limits is False:  # known when the program is made: it holds no damped corrector
        return found
    return lax.cond(any_in_lockstep(~good) & problem.follow_limits, damped, lambda: found)


def _correct_some(
    problem: ContinuationProblem, state: State, chosen: Bool[Array, " poses"], target_residual: Scalar | float
) -> tuple[State, Float[Array, " poses"], Bool[Array, " poses"]]:
    """Correct the `chosen` poses by damped steps, `DAMPED_GROUP` poses at a time on CPUs.

    Returns states, residual norms and which poses are stationary; the entries of poses that are not chosen are
    undefined.
    """
    poses = chosen.shape[0]
    size = min(group_for_device(DAMPED_GROUP), poses)
    order = jnp.argsort(~chosen)
    count = jnp.sum(chosen)
    begin = jax.tree.map(lambda array: array[..., order], state)

    def running(carry) -> Array:
        return any_in_lockstep(carry[0] < count)

    def step(carry):
        number, found = carry
        own = jax.tree.map(lambda array: lax.dynamic_slice_in_dim(array, number, size, axis=-1), begin)
        here = levenberg_marquardt(problem, own, problem.options.rescue_steps, target_residual)
        found = jax.tree.map(
            lambda whole, part: lax.dynamic_update_slice_in_dim(whole, part, number, axis=-1),
            found,
            (here.state, here.residual_norm, here.stationary),
        )
        return number + size, found

    nothing = begin, jnp.zeros(poses, state.x.dtype), jnp.zeros(poses, bool)
    found = lax.while_loop(running, step, (jnp.asarray(0), nothing))[1]
    back = jnp.argsort(order)
    return jax.tree.map(lambda array: array[..., back], found)
