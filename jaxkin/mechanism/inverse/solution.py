"""Solve an inverse problem from one start or another: least errors within loops and limits, pose by pose."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.mechanism.inverse.bounded import Bounds
from jaxkin.mechanism.inverse.problem import InverseProblem
from jaxkin.mechanism.inverse.saddles import step_off
from jaxkin.mechanism.inverse.step import InverseStep, StepEquations, is_stationary, step, tangent

STAGES = 8
"""Steps in which targets are moved from the assembled pose to where they are asked for, so that its branch is kept."""
STAGE_ITERATIONS = 3
"""Iterations of each stage but the last one: Newton's method follows a target that moves by an eighth of its way."""
LARGEST = 0.5
"""Radians, or sizes of the mechanism, that a coordinate moves in one iteration at most."""
REACHED = 1e-9
"""Weighted error, in radians and sizes of the mechanism, up to which a target counts as reached."""
CONVERGED = 1e-13
"""Largest step, in radians and sizes, after which nothing changes any more: rounding."""
RESTORATIONS = 3
"""Newton's steps by which the loops are closed after each step at most."""
CLOSED = 1e-12
"""Closure residual up to which a pose is closed: the default tolerance of `sweep`."""
LEAST = 1e-9
"""Cosine between the errors and what a movement changes of them, up to which a pose is where they are least."""
AT_REST = 1e-9
"""Movement of the inputs to where they rest, radians and sizes, that is none where errors are least but not zero."""
ROUNDED = 1e-14
"""Error, in radians and sizes, that is rounding: a step that leaves no more is right, whatever it was before. Rounding
would refuse the last steps of inputs to where they rest, which change errors by less."""
DAMPING = 1e-3
"""Damping after the first step that is refused."""
GOOD = 0.5
"""Share of the foreseen decrease of squared errors below which a step is damped more the next time."""
FURTHER = 10.0
"""How much the squared errors may rise, over the fourth power of a step: along targets that are met the inputs move to
where they rest, and errors of the second order in that step are for the next one to mend."""
ESCAPES = 3
"""How often a pose steps off where its errors are stationary and not least."""


class InversePoses(NamedTuple):
    """Poses as they were found from one start."""

    x: Float[np.ndarray, "poses columns"]
    """Coordinates in radians and sizes."""
    error: Float[np.ndarray, " poses"]
    """Weighted error of the targets."""
    closure: Float[np.ndarray, " poses"]
    """Closure residual of all loops."""
    stationary: Bool[np.ndarray, " poses"]
    """Whether no movement within loops and limits lessens the error, to first order."""


def from_assembled(problem: InverseProblem, bounds: Bounds, iterations: int) -> InversePoses:
    """Solve from the assembled pose, along targets that move from there to where they are asked for."""
    x = np.clip(np.zeros((problem.poses, len(problem.units))), *bounds)
    x, _ = step_off(problem, x, bounds, 1 / STAGES, REACHED)
    for stage in range(1, STAGES):
        x = _iterated(problem, x, bounds, stage / STAGES, STAGE_ITERATIONS)
    return _finished(problem, x, bounds, iterations)


def from_unlimited(problem: InverseProblem, bounds: Bounds, iterations: int) -> InversePoses:
    """Solve without limits from the assembled pose, and from there within them, after whole turns that lead into them.

    A hinge that stops on its way to a place may get there the other way round.
    """
    x = problem.turned_back(from_assembled(problem, problem.unlimited, iterations).x, bounds)
    return _finished(problem, np.clip(x, *bounds), bounds, iterations)


def from_random(
    problem: InverseProblem, bounds: Bounds, iterations: int, count: int, seed: int
) -> Iterator[InversePoses]:
    """Solve from starts at random within the limits: as far as `InverseProblem.reach` to both sides of zero, or as near
    to it as the limits let that be."""
    rng, reach = np.random.default_rng(seed), problem.reach
    low = np.maximum(bounds.low, np.minimum(-reach, bounds.high - 2 * reach))
    high = np.minimum(bounds.high, np.maximum(reach, bounds.low + 2 * reach))
    for _ in range(count):
        x = rng.uniform(low, high, (problem.poses, len(problem.units)))
        yield _finished(problem, x, bounds, iterations)


def _finished(
    problem: InverseProblem, x: Float[np.ndarray, "poses columns"], bounds: Bounds, iterations: int
) -> InversePoses:
    """Solve for the whole targets, and again from beside poses whose errors are stationary and not least."""
    x = _iterated(problem, x, bounds, 1.0, iterations)
    for _ in range(ESCAPES):
        x, stepped = step_off(problem, x, bounds, 1.0, REACHED)
        if not stepped.any():
            break
        x = _iterated(problem, x, bounds, 1.0, iterations)
    now, _ = problem.equations(x, 1.0)
    error, closure = (np.linalg.norm(each, axis=1) for each in (now.targets, now.closure))
    return InversePoses(x, error, closure, (error <= REACHED) | is_stationary(now, tangent(now), x, bounds))


def _iterated(
    problem: InverseProblem, x: Float[np.ndarray, "poses columns"], bounds: Bounds, share: float, iterations: int
) -> Float[np.ndarray, "poses columns"]:
    """Iterate for targets that are `share` of the way to where they are asked for, each pose until it rests."""
    damping, left = np.zeros(len(x)), np.arange(len(x))
    met, met_at = np.zeros(len(x), bool), x.copy()
    now, merit = problem.equations(x, share)
    for number in range(iterations):
        here = now.at(left)
        errors = np.sum(here.targets**2, axis=1)
        # errors that cannot vanish settle slowly, and only where nothing else moves on
        settled = errors <= REACHED**2
        met[left] |= settled
        met_at[left[settled]] = x[left[settled]]
        found = step(
            here, x[left], bounds, damping[left], problem.inputs & (settled | (2 * number < iterations))[:, None]
        )
        largest = np.abs(found.move).max(axis=1, initial=0.0)
        goes = (largest > CONVERGED) & (
            settled | (found.to_rest > AT_REST) | ~is_stationary(here, found.tangent, x[left], bounds, LEAST)
        )
        if not goes.any():
            break
        left, errors, largest = left[goes], errors[goes], largest[goes]
        found = InverseStep(*(each[goes] for each in found))
        tried = x.copy()
        tried[left] += found.move * np.minimum(1.0, LARGEST / largest)[:, None]
        tried, there, reached = _restored(problem, np.clip(tried, *bounds), bounds, share)
        right = reached[left] <= ROUNDED**2
        taken = right | (reached[left] <= merit[left] + FURTHER * found.to_rest**4)
        lessened = errors - np.sum(there.targets[left] ** 2, axis=1)
        as_foreseen = right | (lessened >= GOOD * (errors - found.foreseen))
        accepted = np.zeros(len(x), bool)
        accepted[left[taken]] = True
        x, merit = np.where(accepted[:, None], tried, x), np.where(accepted, reached, merit)
        now = StepEquations(*(_where(accepted, new, old) for new, old in zip(there, now, strict=True)))
        damping[left] = np.where(taken & as_foreseen, 0.3 * damping[left], np.maximum(4.0 * damping[left], DAMPING))
        damping[damping < DAMPING / 10] = 0.0
    # at the end of its reach an arm that moves to where it rests may leave targets that were met
    lost = met & (np.linalg.norm(now.targets, axis=1) > REACHED)
    return np.where(lost[:, None], met_at, x)


def _restored(
    problem: InverseProblem, x: Float[np.ndarray, "poses columns"], bounds: Bounds, share: float
) -> tuple[Float[np.ndarray, "poses columns"], StepEquations, Float[np.ndarray, " poses"]]:
    """Close the loops again after a step along their tangent; also returns equations and merit there."""
    now, merit = problem.equations(x, share)
    for _ in range(RESTORATIONS):
        apart = np.flatnonzero(np.linalg.norm(now.closure, axis=1) > CLOSED)
        if not len(apart):
            break
        here = now.at(apart)
        alone = here._replace(targets=here.targets[:, :0], targets_jacobian=here.targets_jacobian[:, :0])
        move = step(alone, x[apart], bounds, np.zeros(len(apart)), np.zeros((1, x.shape[1]), bool)).move
        x[apart] = np.clip(x[apart] + move, *bounds)
        now, merit = problem.equations(x, share)
    return x, now, merit


def _where(accepted: np.ndarray, new: np.ndarray, old: np.ndarray) -> np.ndarray:
    return np.where(accepted.reshape(-1, *[1] * (new.ndim - 1)), new, old)
