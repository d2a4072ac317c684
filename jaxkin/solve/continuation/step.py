"""One step of the continuation from the assembled pose towards a target, as long as it is safe.

A step is predicted (`predictor`), corrected, and taken only if the corrected pose is near the prediction and no
determinant of the Jacobian has changed its sign: where two branches nearly meet, a long step would lead straight on to
the other branch. After a refused step the tangent is tried instead of the curve through two poses, by turns with it,
and the step is shortened. Where the shortest step fails, the motion has a limit. Beyond a limit the damped corrector
alone goes on, towards the least residual; where the loops close again behind such an unreachable interval, the pose has
JUMPED: no motion of the input led there. (The sign of a determinant would not tell: two circuits can share it.)

All fronts (`fronts`) take their steps together. Each step evaluates the closure at one place, which keeps the compiled
code small.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure.closure import Closure, Geometry, closure
from jaxkin.solve.continuation.determinant_sign import determinant_ratio
from jaxkin.solve.continuation.fronts import (
    BEYOND_LIMIT,
    CLOSING,
    FIRST_STEP,
    FOLLOWING,
    RESTING,
    ContinuationProblem,
    Fronts,
    arrived,
    assembled_fronts,
    stopped_at_limit,
)
from jaxkin.solve.continuation.predictor import predict_state
from jaxkin.solve.correctors.levenberg_marquardt import (
    LevenbergMarquardtResult,
    damping_floor,
    levenberg_marquardt,
    select_poses,
)
from jaxkin.solve.correctors.newton import newton
from jaxkin.solve.linear.blocks import solve_blocks
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status, classify, is_closed, rounding_residual
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, difference, drive, driven_rate, rate, retract

LONGEST_STEP = 0.3
"""Longest step, radians or characteristic lengths: a full turn takes twenty-one of them."""
SHORTEST_STEP = 1e-6
"""Shortest step, radians or characteristic lengths: where it fails too, the motion has a limit. The coordinates go as
the root of the distance from a limit, so they are followed to 1e-3 of it."""
SHORTEST_FIRST_STEP = 1e-10
"""Shortest step from the assembled pose, in place of `SHORTEST_STEP`: a mechanism may be assembled so near a limit."""
BEYOND_LIMIT_STEP = 0.15
"""Step beyond a limit, radians or characteristic lengths: half the longest step, since no predictor leads there."""
NEAR_LIMIT = 4 * SHORTEST_STEP
"""Distance from a limit to which the motion is followed at least: steps that are refused are shortened threefold."""
CROSSING = 1e-3
"""Longest step that may pass from one branch to another that crosses it: at a change point, or where two branches miss
each other by less than this, as they do for lengths that are off by 1e-6."""

WANTED_DEVIATION = 0.1
"""Deviation of the corrected pose from its prediction that the step length is controlled for, over the travel."""
MAX_DEVIATION = 0.25
"""Deviation at which a step is refused, over the travel: farther away the pose may be on another branch."""
MAX_TRAVEL = 1.0
"""Largest predicted change of a coordinate, radians or characteristic lengths: beside a limit the tangent, where it is
nearly infinite, leads anywhere."""
UNKNOWN_TRAVEL = 80.0
"""Travel over the step length where no slope is known: a first step of 1e-3 may be off by 0.02."""
DEVIATION_ROUNDINGS = 50
"""Units of rounding by which a corrected pose may differ from its prediction however short the step is."""
REFUSED_FACTOR = 0.35
"""Factor of the step length after a step that was refused."""
GROWTH = (0.5, 4.0)
"""Smallest and largest factor of the step length after a step that was taken."""

TARGET_ROUNDINGS = 64
"""Units of rounding in the residual of a pose on the branch: it is a place to begin from, and needs no more."""
MAX_START_DISTANCE = 0.1
"""Distance from the assembled pose, radians or characteristic lengths, above which its closure by Newton's method is
not trusted: the damped corrector, which stays nearer, closes it instead."""


class _Attempt(NamedTuple):
    """A step as it is tried, before it is corrected."""

    closing: Bool[Array, " fronts"]
    following: Bool[Array, " fronts"]
    beyond: Bool[Array, " fronts"]
    moved: Float[Array, " fronts"]
    """Change of the distance, with its sign."""
    at: Float[Array, " fronts"]
    direction: Float[Array, "driven fronts"]
    tangent: State
    predicted: State
    sloped: Bool[Array, " fronts"]
    """Whether the prediction made use of a slope."""
    travel: Float[Array, " fronts"]
    """Largest predicted change of a coordinate, or what stands for it where no slope is known."""


def substep(problem: ContinuationProblem, fronts: Fronts, target: Float[Array, " fronts"]) -> Fronts:
    """Take one step of every front that has not arrived; a front whose step is refused stays where it is.

    A state is closed to some units of rounding, no better, and its residual may be extrapolated instead of measured.
    """
    system = problem.system
    attempt = _attempt(problem, fronts, target)
    found = _corrected(problem, attempt)
    distance = jnp.abs(attempt.moved)
    # a target nearer than the shortest step, just inside a limit
    beside_limit = attempt.beyond & (fronts.status == Status.CLOSED.value) & (distance <= NEAR_LIMIT)
    status = classify(found.residual_norm, found.stationary, ~fronts.anchored | beside_limit)
    closed = is_closed(status)

    ratio = determinant_ratio(fronts.jacobian, found.closure.jacobian, equation_blocks(system))
    good, deviation, slack = _accepted(fronts, attempt, found.state, closed, ratio)
    step = _next_step(fronts, attempt, good, deviation - slack)
    shortest = jnp.where(fronts.at == 0, SHORTEST_FIRST_STEP, SHORTEST_STEP)
    lost = attempt.following & ~good & fronts.along_tangent & (distance <= shortest)

    uncertain = attempt.closing | attempt.beyond  # their statuses are found anew
    entered = uncertain & closed
    final = good | uncertain
    stage = jnp.where(entered, FOLLOWING, jnp.where(lost | attempt.closing, BEYOND_LIMIT, fronts.stage))
    slope = input_slopes(system, found.state, found.closure, attempt.direction)
    return Fronts(
        state=select_poses(final, found.state, fronts.state),
        status=jnp.where(uncertain, status, fronts.status),  # a branch is kept while it is followed
        residual_norm=jnp.where(final, found.residual_norm, fronts.residual_norm),
        jacobian=jnp.where(final, found.closure.jacobian, fronts.jacobian),
        at=jnp.where(final, attempt.at, fronts.at),
        slope=jnp.where(final, slope, fronts.slope),
        before=select_poses(good, fronts.state, fronts.before),
        before_tangent=select_poses(good, attempt.tangent, fronts.before_tangent),
        width=jnp.where(good & (attempt.moved != 0), attempt.moved, fronts.width),
        determinant_ratio=jnp.where(good, ratio, fronts.determinant_ratio),
        has_before=(fronts.has_before | good) & (stage == FOLLOWING) & ~entered,
        along_tangent=attempt.following & ~good & ~fronts.along_tangent,
        step=jnp.where(entered, FIRST_STEP, step),
        stage=stage.astype(jnp.int32),
        anchored=fronts.anchored | entered,
    )


def _attempt(problem: ContinuationProblem, fronts: Fronts, target: Float[Array, " fronts"]) -> _Attempt:
    """Choose the step of every front and predict the state at its end."""
    system = problem.system
    left = jnp.abs(target - fronts.at)
    resting = arrived(fronts, target) | stopped_at_limit(fronts, problem.follow_limits)
    stage = jnp.where(resting, RESTING, fronts.stage)
    closing, following, beyond = stage == CLOSING, stage == FOLLOWING, stage == BEYOND_LIMIT
    length = jnp.where(beyond, jnp.minimum(BEYOND_LIMIT_STEP, left), 0.0)
    length = jnp.where(following, jnp.minimum(fronts.step, left), length)
    moved = jnp.where(target < fronts.at, -length, length)
    at = jnp.where((jnp.abs(moved) >= left) & (following | beyond), target, fronts.at + moved)
    inputs, direction = problem.path(at)

    tangent = rate(system, fronts.state, fronts.slope)
    sloped = fronts.has_before | fronts.along_tangent
    predicted = predict_state(
        fronts.state,
        tangent,
        fronts.before,
        fronts.before_tangent,
        fronts.width,
        jnp.where(following & sloped, moved, 0.0),
        fronts.along_tangent | ~fronts.has_before,
    )
    predicted = drive(system, retract(system, predicted, jnp.zeros_like(predicted.x)), inputs)
    distance = jnp.abs(moved)
    travel = jnp.maximum(difference(predicted, fronts.state), distance)
    travel = jnp.where(sloped, travel, UNKNOWN_TRAVEL * distance)
    return _Attempt(closing, following, beyond, moved, at, direction, tangent, predicted, sloped, travel)


def _corrected(problem: ContinuationProblem, attempt: _Attempt) -> LevenbergMarquardtResult:
    """Bring the predicted states to closure by Newton's method, or where that fails by the damped corrector."""
    options, predicted = problem.options, attempt.predicted
    target_residual = rounding_residual(predicted.x.dtype, TARGET_ROUNDINGS)
    state, closed, residual_norm = newton(problem, predicted, target_residual, extrapolate_residual=True)
    quick = LevenbergMarquardtResult(state, closed, residual_norm, jnp.zeros(residual_norm.shape, bool))
    closes = residual_norm <= target_residual
    near = closes & (difference(state, predicted) <= MAX_START_DISTANCE)
    left_open = attempt.beyond | attempt.closing & ~near | attempt.following & ~closes

    def damped() -> LevenbergMarquardtResult:
        steps = jnp.where(attempt.beyond, options.limit_steps, options.damped_steps)
        steps = jnp.where(attempt.closing, options.rescue_steps, steps)
        return select_poses(left_open, levenberg_marquardt(problem, predicted, steps, target_residual), quick)

    return lax.cond(any_in_lockstep(left_open) & problem.follow_limits, damped, lambda: quick)


def _accepted(
    fronts: Fronts,
    attempt: _Attempt,
    state: State,
    closed: Bool[Array, " fronts"],
    ratio: Float[Array, "blocks fronts"],
) -> tuple[Bool[Array, " fronts"], Float[Array, " fronts"], float]:
    """Tell which fronts that follow the motion keep their branch; the deviation from the prediction, and its rounding.

    A step is accepted if it closes near the prediction (without a slope: within a tiny step) and crosses no singular
    pose. `ratio` holds the determinants of the Jacobian at the end of the step over those at its beginning.
    """
    distance = jnp.abs(attempt.moved)
    deviation = difference(state, attempt.predicted)
    slack = DEVIATION_ROUNDINGS * float(jnp.finfo(deviation.dtype).eps)
    # a determinant that would fall to zero on the way, though it has kept its sign, may have passed an interval that
    # cannot be reached: extrapolated linearly from the last two steps
    falls = fronts.has_before & (1 + (1 - 1 / fronts.determinant_ratio) * attempt.moved / fronts.width < 0)
    crossed = jnp.any((ratio < 0) | falls, axis=0) & (distance > CROSSING)
    near = deviation <= MAX_DEVIATION * attempt.travel + slack
    return attempt.following & closed & near & (attempt.travel <= MAX_TRAVEL) & ~crossed, deviation, slack


def _next_step(
    fronts: Fronts, attempt: _Attempt, good: Bool[Array, " fronts"], deviation: Float[Array, " fronts"]
) -> Float[Array, " fronts"]:
    """Length of the next step, for which the deviation from the prediction is to be `WANTED_DEVIATION`.

    The deviation of a cubic goes as the fourth power of the step, its ratio to the travel as the third.
    """
    growth = jnp.cbrt(WANTED_DEVIATION * attempt.travel / jnp.maximum(deviation, 1e-30))
    growth = jnp.clip(jnp.where(attempt.sloped, growth, 2.0), *GROWTH)
    step = jnp.where(good, jnp.minimum(growth * fronts.step, LONGEST_STEP), fronts.step)
    return jnp.where(attempt.following & ~good, REFUSED_FACTOR * jnp.abs(attempt.moved), step)


def reach(
    system: LoopSystem, geometry: Geometry, targets: Float[Array, "driven fronts"], options: SolverOptions
) -> tuple[State, Int[Array, " fronts"], Float[Array, " fronts"]]:
    """Reach each target from the assembled pose in a straight line; returns states, statuses and residuals.

    `targets` are inputs in radians and characteristic lengths.
    """
    distance = jnp.max(jnp.abs(targets), axis=0, initial=0.0)
    direction = targets / jnp.where(distance > 0, distance, 1.0)

    def path(at: Float[Array, " fronts"]) -> tuple[Array, Array]:
        return jnp.where(at == distance, targets, at * direction), direction

    problem = ContinuationProblem(system, geometry, options, path)
    fronts = lax.while_loop(
        lambda fronts: any_in_lockstep(~arrived(fronts, distance)),
        lambda fronts: substep(problem, fronts, distance),
        assembled_fronts(system, targets.shape[-1], targets.dtype),
    )
    return fronts.state, fronts.status, closure(system, geometry, fronts.state).residual_norm


def input_slopes(
    system: LoopSystem, state: State, closed: Closure, direction: Float[Array, "driven poses"]
) -> Float[Array, "columns poses"]:
    """Derivative of all coordinates of closed states while the inputs change in a direction (least norm)."""
    change, columns = driven_rate(system, state, direction)
    right = jnp.sum(closed.jacobian * columns[None], axis=1)
    return change - solve_blocks(closed.jacobian, right, damping_floor(right.dtype), equation_blocks(system))
