"""Search downhill from all starts at once, and again with other multipliers as long as constraints ask for it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from jaxkin._progress import ProgressBar
from jaxkin.design.augmented_lagrangian import MET, Penalty, Verdict, renewed, worth_more
from jaxkin.design.optimisers import LevenbergMarquardt, Optimiser
from jaxkin.design.solvers import CHUNK, Solver

PATIENCE = 30
"""Iterations before a start may retire because its loss falls too slowly."""
NOTHING = 1e-30
"""Absolute loss up to which nothing is left to improve."""
MAX_SEARCHES = 12
"""Largest number of searches, each with the multipliers that follow from the end of the one before."""


class Designs(NamedTuple):
    """The best design that each start led to, in all searches so far."""

    vectors: Float[np.ndarray, "starts variables"]
    losses: Float[np.ndarray, " starts"]
    violations: Float[np.ndarray, " starts"]

    def improved(self, vectors: Float[np.ndarray, "starts variables"], verdict: Verdict) -> Designs:
        """Replace the designs of those starts whose new ones are better."""
        better = _better(verdict.losses, verdict.violations, self.losses, self.violations)
        return Designs(
            np.where(better[:, None], vectors, self.vectors),
            np.where(better, verdict.losses, self.losses),
            np.where(better, verdict.violations, self.violations),
        )

    @property
    def best(self) -> int:
        """Number of the best feasible design; of the one of least violation where none is feasible."""
        losses = np.where(np.isfinite(self.losses), self.losses, np.inf)
        feasible = self.violations <= MET
        return int(np.argmin(np.where(feasible, losses, np.inf)) if feasible.any() else np.argmin(self.violations))


def search_with_multipliers(
    downhill: Solver,
    vectors: Float[np.ndarray, "starts variables"],
    penalty: Penalty,
    solver: Optimiser,
    bar: ProgressBar,
) -> tuple[Designs, str, list[np.ndarray]]:
    """Search again, with the multipliers at which the search before ended, until constraints are met or no start may
    get better.

    Returns the best designs, why the last search ended, and the losses after each iteration of all searches.
    """
    starts, history, reason = len(vectors), list[np.ndarray](), ""
    designs = Designs(vectors, *np.full((2, starts), np.inf))
    active, unsettled = np.ones(starts, bool), np.full(starts, np.inf)
    for number in range(1, MAX_SEARCHES + 1):
        vectors, reason, losses = search(downhill, vectors, penalty, active, solver, bar)
        history += losses
        verdict = downhill.judge(vectors, penalty.shifts)
        designs = designs.improved(vectors, verdict)
        best = designs.best
        on_target = solver.target is not None and designs.losses[best] <= solver.target
        if number > 1:
            reason += f", in the last of {number} searches for what constraints touch"
        active = worth_more(penalty, verdict)
        if (on_target and designs.violations[best] <= MET) or not active.any():
            break
        penalty, unsettled = renewed(penalty, verdict, unsettled), verdict.unsettled
    return designs, reason, history


def unsearched(
    downhill: Solver, vectors: Float[np.ndarray, "starts variables"], constraints: int
) -> tuple[Designs, str, list[np.ndarray]]:
    """Judge the starts as they are: what `search_with_multipliers` returns where no variable changes anything."""
    starts = len(vectors)
    verdict = downhill.judge(vectors, np.zeros((starts, constraints)))
    reason = "there was nothing to search for: no variable that may change has an influence on the loss of any start"
    return Designs(vectors, verdict.losses, verdict.violations), reason, [np.zeros((0, starts))]


def search(
    downhill: Solver,
    vectors: Float[np.ndarray, "starts variables"],
    penalty: Penalty,
    active: Bool[np.ndarray, " starts"],
    stop: Optimiser,
    bar: ProgressBar,
) -> tuple[Float[np.ndarray, "starts variables"], str, list[np.ndarray]]:
    """Improve the active starts; returns all designs, why the search ended, and the losses after each iteration.

    A start retires where its loss stays as it is, or at its pace will not reach the best one in the iterations left: it
    costs nothing more.
    """
    history = list[np.ndarray]()
    state = downhill.begin(vectors, penalty)
    iterations, tolerance, target = stop.iterations, stop.tolerance, stop.target
    last = np.full(len(vectors), np.finfo(float).max)
    for done in range(CHUNK, iterations + CHUNK, CHUNK):
        state, losses = downhill.advance(state, penalty, active)
        history.append(losses)
        now = np.where(active, losses[-1], last)
        least = float(np.min(now))
        bar.show(done, f"loss {least:.3e}")
        if target is not None and least <= target:
            found = downhill.judge(downhill.vectors(state), penalty.shifts)
            if np.any((found.losses <= target) & (found.violations <= MET)):
                return downhill.vectors(state), f"the target {target:g} was reached after {done} iterations", history
        settled = (now >= last - tolerance * np.abs(last)) | (np.abs(now) <= NOTHING)
        expected = _expected(last, now, (iterations - done) / CHUNK, isinstance(stop, LevenbergMarquardt))
        hopeless = (expected > least) & (done >= PATIENCE) & (now > least * (1 + 1e-6))
        active = active & ~(settled | hopeless)
        last = now
        if not active.any():
            reason = (
                f"converged after {done} iterations: every start improved by less than {tolerance:g} relative in "
                f"{CHUNK} of them, or too slowly to reach the best one"
            )
            return downhill.vectors(state), reason, history
    improving = f"{active.sum()} starts were" if active.sum() > 1 else "1 start was"
    return downhill.vectors(state), f"all {iterations} iterations were used; {improving} still improving", history


def _expected(last, now, rounds: float, squares: bool):
    """Estimate the losses after further rounds of `CHUNK` iterations, from those before and after the last round.

    Sums of squares fall by a share of themselves, to zero at most. Other losses have no such bound, and may be negative
    or have a constant added: what they fell by says as much, and they are taken to go on falling by it.
    """
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        return now * np.minimum(now / last, 1.0) ** rounds if squares else now - rounds * (last - now)


def _better(losses, violations, losses_before, violations_before):
    """Find the starts whose design is feasible at less loss than before, or else violates less."""
    feasible, feasible_before = violations <= MET, violations_before <= MET
    return np.where(feasible, ~feasible_before | (losses < losses_before), violations < violations_before)
