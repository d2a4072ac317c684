"""Take one step of the continuation: predict a pose along the input path, correct it, then accept or refuse it.

Follow the branch: a step is accepted if the corrected pose is near its prediction and no determinant of a block of the
closure Jacobian has changed its sign. Without the test of signs, a long step where two branches nearly meet would lead
straight on to the other branch. A refused step is repeated with a shorter length. The tangent at the last pose and the
curve or chord of the last poses predict in turn after refusals, since either may fail where the other does not.

Meet a limit: where a step along the tangent is refused at the shortest length, the motion has a limit. Beyond the limit
only the damped corrector goes on, towards poses of least residual (an unreachable interval).

Jump: where the loops close again behind an unreachable interval, the pose is JUMPED, because no motion of the input
leads there. The sign of a determinant could not tell this: poses on two circuits can have the same sign.

All fronts step together, as the last axis of the arrays. The correctors of a step evaluate the closure of all fronts at
one place in the code, which keeps the compiled program small.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

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
    stopped_at_limit,
)
from jaxkin.solve.continuation.input_slopes import input_slopes, slopes_of_branch
from jaxkin.solve.continuation.predictor import History, interpolable, predict_state
from jaxkin.solve.correctors.levenberg_marquardt import LevenbergMarquardtResult, levenberg_marquardt
from jaxkin.solve.correctors.newton import newton
from jaxkin.solve.lockstep import any_in_lockstep, computed_once
from jaxkin.solve.status import Status, classify, closes_before_limits, rounding_residual
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.state import State, difference, drive, rate, retract, select_poses

LONGEST_STEP = 0.3
"""Longest step of the continuation, radians or characteristic lengths: a full turn takes twenty-one such steps."""
SHORTEST_STEP = 1e-6
"""Shortest step, radians or characteristic lengths: if a step of this length is refused, the motion has a limit. There
coordinates change as the square root of the distance from the limit, so that following them stops about 1e-3 before the
pose where the branch ends."""
SHORTEST_FIRST_STEP = 1e-10
"""Shortest step from the assembled pose, in place of `SHORTEST_STEP`: that pose may lie as near to a limit as this."""
BEYOND_LIMIT_STEP = 0.15
"""Length of steps beyond a limit, radians or characteristic lengths: half of `LONGEST_STEP`: none is predicted."""
NEAR_LIMIT = 4 * SHORTEST_STEP
"""Largest distance, radians or characteristic lengths, from the last pose before a limit to a target that may still be
on this side of the limit. The limit is about one refused step away; refused steps are shortened to a third
(`REFUSED_FACTOR`), so the one refused before that may have been three times as long as `SHORTEST_STEP`."""
CROSSING = 1e-3
"""Longest step, radians or characteristic lengths, that is accepted although a determinant changes its sign or falls to
zero. At a change point, where two branches cross, the determinant changes its sign on the branch itself. Lengths with
relative errors of 1e-6 turn the crossing into two branches about 1e-3 apart, the root of the error."""
LEAST_RATIO = 0.5
"""Least ratio of the determinants of a block at both ends of a step that was predicted by a curve far from its chord.
Near a limit poses in a long step cannot be interpolated: one in 34,400 of random mechanisms was JUMPED without this."""

WANTED_DEVIATION = 0.1
"""Ratio of deviation to travel that the step length is chosen for, less than half of `MAX_DEVIATION`. The deviation is
the distance of a corrected pose from its prediction; the travel is the predicted change of the pose (`_Attempt`)."""
MAX_DEVIATION = 0.25
"""Ratio of deviation to travel above which a step is refused: the corrected pose may be on another branch."""
MAX_TRAVEL = 1.0
"""Largest travel of a step, radians or characteristic lengths: beside a limit slopes are nearly infinite, and so is the
change that a tangent predicts."""
UNKNOWN_TRAVEL = 80.0
"""Ratio of travel to step length where no slope is known: a first step of 1e-3 may then deviate by 0.02 (with
`MAX_DEVIATION`) from the pose that it started from."""
DEVIATION_ROUNDINGS = 50
"""Deviation that is always accepted, in units of rounding: the travel of very short steps is rounding itself."""
REFUSED_FACTOR = 0.35
"""Length of the next step over that of a step that was refused."""
GROWTH = (0.5, 4.0)
"""Smallest and largest ratio of the length of the next step to that of an accepted step."""

TARGET_ROUNDINGS = 64
"""Residual norm, in units of rounding, to which poses of the trace are corrected. These poses are starting points of
predictions, which need no higher accuracy."""
MAX_START_DISTANCE = 0.1
"""Distance, radians or characteristic lengths, by which Newton's method may move the assembled pose to close it. If the
method moves it farther, the damped corrector closes the assembled pose instead, since it stays nearer."""


class _Attempt(NamedTuple):
    """The predicted step of each front, before its correction."""

    closing: Bool[Array, " fronts"]
    """Whether the front is at the assembled pose, which this step closes."""
    following: Bool[Array, " fronts"]
    """Whether the front follows the branch."""
    beyond: Bool[Array, " fronts"]
    """Whether the front is beyond a limit."""
    moved: Float[Array, " fronts"]
    """Change of the distance along the input path, with its sign."""
    at: Float[Array, " fronts"]
    """Distance along the input path at the end of the step."""
    direction: Float[Array, "driven fronts"]
    """Derivative of the inputs with respect to that distance, at the end of the step."""
    tangent: State
    """Derivative of the state with respect to that distance, at the beginning of the step."""
    predicted: State
    """State at the end of the step as predicted, with its inputs set."""
    along_tangent: Bool[Array, " fronts"]
    """Whether the step is predicted along the tangent, because another prediction was refused."""
    bent: Bool[Array, " fronts"]
    """Whether the prediction follows a curve that is far from its chord (`predictor.AGREEMENT`)."""
    sloped: Bool[Array, " fronts"]
    """Whether the prediction used a slope; if not, the predicted state is that of the beginning with new inputs."""
    travel: Float[Array, " fronts"]
    """Largest predicted change of a coordinate or of a ball's angle, at least the step length (`UNKNOWN_TRAVEL`)."""


def substep(problem: ContinuationProblem, fronts: Fronts, target: Float[Array, " fronts"]) -> Fronts:
    """Take one step of every front that has not arrived; a front whose step is refused stays where it is.

    `target` is the distance along the input path at which each front is to arrive. States are closed to a residual norm
    of `TARGET_ROUNDINGS` units of rounding. `Fronts.residual_norm` may be extrapolated from that of the iteration
    before, and then is not measured at `Fronts.state`.
    """
    system = problem.system
    attempt = _attempt(problem, fronts, target)
    found = _corrected(problem, attempt)
    distance = jnp.abs(attempt.moved)
    # Such a target may be on this side of the limit: closed, its pose is CLOSED and not JUMPED.
    beside_limit = attempt.beyond & (fronts.status == Status.CLOSED.value) & (distance <= NEAR_LIMIT)
    status = classify(found.residual_norm, found.stationary, ~fronts.anchored | beside_limit)
    closed = closes_before_limits(status)

    ratio = determinant_ratio(fronts.jacobian, found.closure.jacobian, equation_blocks(system))
    slope = input_slopes(system, found.state, found.closure, attempt.direction)
    slope = slopes_of_branch(system, slope, ratio, fronts, found.state, attempt.moved)
    end_slope = rate(system, found.state, slope)
    # every field of the fronts depends on the decision: XLA would compute it anew for each
    good, step = computed_once(
        lambda moved: _decision(fronts, attempt._replace(moved=moved), found.state, end_slope, closed, ratio),
        attempt.moved,
    )
    shortest = jnp.where(fronts.at == 0, SHORTEST_FIRST_STEP, SHORTEST_STEP)
    lost = attempt.following & ~good & attempt.along_tangent & (distance <= shortest)

    uncertain = attempt.closing | attempt.beyond  # fronts not on the branch: each step decides their status anew
    entered = uncertain & closed
    final = good | uncertain
    stage = jnp.where(entered, FOLLOWING, jnp.where(lost | attempt.closing, BEYOND_LIMIT, fronts.stage))
    last = fronts.history
    width = jnp.where(attempt.moved != 0, attempt.moved, last.width)
    earlier_width = jnp.where(fronts.has_before, last.width, jnp.inf)
    passed = History(fronts.state, attempt.tangent, width, last.tangent, earlier_width)
    return Fronts(
        state=select_poses(final, found.state, fronts.state),
        status=jnp.where(uncertain, status, fronts.status),  # a front on the branch stays CLOSED or JUMPED
        residual_norm=jnp.where(final, found.residual_norm, fronts.residual_norm),
        jacobian=jnp.where(final, found.closure.jacobian, fronts.jacobian),
        at=jnp.where(final, attempt.at, fronts.at),
        slope=jnp.where(final, slope, fronts.slope),
        history=select_poses(good, passed, fronts.history),
        determinant_ratio=jnp.where(good, ratio, fronts.determinant_ratio),
        has_before=(fronts.has_before | good) & (stage == FOLLOWING) & ~entered,
        refusals=jnp.where(attempt.following & ~good, fronts.refusals + 1, 0),
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
    length = jnp.where(beyond, jnp.minimum(BEYOND_LIMIT_STEP * problem.stride, left), 0.0)
    length = jnp.where(following, jnp.minimum(fronts.step, left), length)
    moved = jnp.where(target < fronts.at, -length, length)
    at = jnp.where((jnp.abs(moved) >= left) & (following | beyond), target, fronts.at + moved)
    inputs, direction = problem.path(at)

    tangent = rate(system, fronts.state, fronts.slope)
    along_tangent = fronts.refusals % 2 == 1
    sloped = fronts.has_before | along_tangent
    predicted, bent = predict_state(
        fronts.state,
        tangent,
        fronts.history,
        jnp.where(following & sloped, moved, 0.0),
        along_tangent | ~fronts.has_before,
        may_bend=fronts.refusals == 0,
    )
    predicted = drive(system, retract(system, predicted, jnp.zeros_like(predicted.x)), inputs)
    distance = jnp.abs(moved)
    travel = jnp.maximum(difference(predicted, fronts.state), distance)
    travel = jnp.where(sloped, travel, UNKNOWN_TRAVEL * distance)
    return _Attempt(
        closing, following, beyond, moved, at, direction, tangent, predicted, along_tangent, bent, sloped, travel
    )


def _corrected(problem: ContinuationProblem, attempt: _Attempt) -> LevenbergMarquardtResult:
    """Correct predicted states by Newton's method; what that leaves open by the damped one, if limits are followed."""
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

    if problem.follow_limits is False:
        return quick
    return lax.cond(any_in_lockstep(left_open) & problem.follow_limits, damped, lambda: quick)


def _decision(
    fronts: Fronts,
    attempt: _Attempt,
    state: State,
    slope: State,
    closed: Bool[Array, " fronts"],
    ratio: Float[Array, "blocks fronts"],
) -> tuple[Bool[Array, " fronts"], Float[Array, " fronts"]]:
    """Tell which fronts that follow the branch have made an acceptable step, and choose the length of the next one.

    A step is accepted if its pose is closed and near the prediction, if the prediction is not too far away, and if the
    step crosses no singular pose. `ratio` is the determinant of each block of the Jacobian at the end of the step over
    that at the beginning. Lengths are radians or characteristic lengths.
    """
    distance = jnp.abs(attempt.moved)
    deviation = difference(state, attempt.predicted)
    slack = DEVIATION_ROUNDINGS * float(jnp.finfo(deviation.dtype).eps)
    # Extrapolate each determinant linearly. If it falls to zero within the step, the step may have passed over an
    # unreachable interval, with two changes of sign, although the signs at its ends agree.
    falls = fronts.has_before & (1 + (1 - 1 / fronts.determinant_ratio) * attempt.moved / fronts.history.width < 0)
    crossed = jnp.any((ratio < 0) | falls, axis=0) & (distance > CROSSING)
    crossed |= attempt.bent & jnp.any(ratio < LEAST_RATIO, axis=0)
    near = deviation <= MAX_DEVIATION * attempt.travel + slack
    sampled = interpolable(fronts.state, attempt.tangent, state, slope, attempt.moved) | (distance <= CROSSING)
    good = attempt.following & closed & near & (attempt.travel <= MAX_TRAVEL) & ~crossed & sampled
    return good, _next_step(fronts, attempt, good, deviation - slack)


def _next_step(
    fronts: Fronts, attempt: _Attempt, good: Bool[Array, " fronts"], deviation: Float[Array, " fronts"]
) -> Float[Array, " fronts"]:
    """Choose the length of the next step such that the ratio of deviation to travel becomes `WANTED_DEVIATION`.

    `deviation` is without rounding. The deviation of a prediction by three slopes is proportional to the fourth power
    of the step length and the travel to the first, so their ratio to the third.
    """
    growth = jnp.cbrt(WANTED_DEVIATION * attempt.travel / jnp.maximum(deviation, 1e-30))
    growth = jnp.clip(jnp.where(attempt.sloped, growth, 2.0), *GROWTH)
    step = jnp.where(good, jnp.minimum(growth * fronts.step, LONGEST_STEP), fronts.step)
    return jnp.where(attempt.following & ~good, REFUSED_FACTOR * jnp.abs(attempt.moved), step)
