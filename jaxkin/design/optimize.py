"""Find the best design: searches downhill from many starts, and a fine sweep that judges the result.

`optimize` makes a `Problem` (loss, violations and their derivatives as functions of one vector) and a `Solver` of it
(Levenberg-Marquardt or L-BFGS steps of all starts), chooses the starts from random designs, and searches, again with
other multipliers as long as constraints ask for it (`search_with_multipliers`).
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin._arguments import by_name, check_known, check_mechanism, several, whole_number
from jaxkin._progress import ProgressBar
from jaxkin.design.augmented_lagrangian import MET, Penalty, Verdict
from jaxkin.design.constraints import Constraint
from jaxkin.design.lbfgs import bounded
from jaxkin.design.least_squares import least_squares
from jaxkin.design.objective import Objective
from jaxkin.design.optimisers import LBFGS, LevenbergMarquardt, Optimiser
from jaxkin.design.problem import HOPELESS, Problem, design_problem
from jaxkin.design.result import Optimum, judged_range
from jaxkin.design.search import NOTHING, search_with_multipliers, unsearched
from jaxkin.design.solvers import TOGETHER, Solver
from jaxkin.design.variables import Variables, spread, variables
from jaxkin.solve.options import SolverOptions, options_with

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion

POOL = 8
"""Random designs for each start: the best of them are the starts."""
NO_INFLUENCE = 1e-13
"""Derivative of the loss over the whole width of a variable, over the largest one or the loss itself (of a sum of
squares, over its root), up to which the variable has no influence: rounding."""
MASK = (
    "roots and norms of zero and arcs of 1 have none, nor has jnp.where(ok, jnp.sqrt(x), 0.0) where x is zero; write "
    "jnp.sqrt(jnp.where(ok, x, 1.0)) within, or start from another design"
)
"""What may be done about derivatives that are no numbers."""


def optimize(
    loss: Objective | Callable[..., Any],
    mechanism: Mechanism,
    *,
    drive: Mapping[str, Any],
    lengths: Mapping[Any, Any] | None = None,
    points: Mapping[Any, Any] | None = None,
    extras: Mapping[str, Any] | None = None,
    ties: Mapping[Any, Any] | None = None,
    constraints: Sequence[Constraint] = (),
    starts: int = 1,
    seed: int = 0,
    solver: Optimiser | None = None,
    options: SolverOptions | None = None,
    progress: bool | None = None,
) -> Optimum:
    """Find the design of least loss.

    `loss` is an objective of `jaxkin.design`, or a function `loss(motion)` or `loss(motion, extras)` that returns one
    number. With `solver=jk.design.LevenbergMarquardt()` it returns residuals, the squares of which are added up:
    objectives are solved so by default, and all else by `jk.design.LBFGS()`. Either says how many iterations, when to
    stop, and what violations weigh.

    What may change: `lengths`, a mapping of keys of `mechanism.lengths` to bounds (lower, upper); `points`, one of
    joints or (part, joint) to bounds of (x, y, z), or of (joint, "profile") to bounds of its points (x, y), as in
    `with_points`; driven displacements and `extras` given as `Free(start, lower, upper)`. A drive may also be a
    function of the extras: `lambda extras: extras["first"] + steps`. `ties` gives a key the value of a variable, or a
    function of it: `{("rocker", "C", "D"): ("crank", "A", "B")}`, `{"Q": ("P", mirrored)}`. Constraints are functions
    like the loss whose values must not be negative; `jaxkin.design` has some. A second argument that has a value of its
    own, as in `lambda motion, joint=joint: ...`, is not given the extras, but where it is called `extras`.

    `starts` designs are improved side by side in one compiled program: the given one, and the best of many drawn at
    random between the bounds. What is minimised is

        loss + penalty * (sum over poses of residual^2 + sum over parts of misfit^2 + sum over constraints of lack^2)

    where `residual` is the closure residual (Eq. 12, lengths over the size of the loop) of a pose that cannot close,
    `misfit` that of lengths that cannot hold together, and `lack` by how much a constraint is below its shift. Designs
    that cannot move everywhere cost something and can be left again by their derivatives. Shifts are zero in the first
    search, and are then moved by an augmented Lagrangian (`jaxkin.design.augmented_lagrangian`), until the best design
    violates nothing by more than 1e-6, root of the sum of squares: so is an optimum on the bound of a constraint found
    on its bound. What cannot be met is told, with its size, and the design is not `feasible`.

    A start retires when it improves too little, or at its pace will not reach the best one. The search ends when all
    have, when the best feasible loss is at or below the target, or after all iterations. The verdict, `Optimum.moves`,
    is that of a fine sweep. `options` says how poses are found, as in `Mechanism.sweep`. `progress` draws a bar; by
    default where errors go to a terminal.

    A later call for a problem of the same structure runs the program that is there: other numbers of the mechanism,
    bounds, drive, targets and constraints compile nothing anew. Functions of your own are traced in each call, and
    compiled anew where they compute something else.

    Raises ValueError for variables, bounds and losses that make no sense, and for derivatives that are NaN for every
    start; warns of variables without any influence.
    """
    if solver is not None and not isinstance(solver, Optimiser):
        raise ValueError(f"solver must be jk.design.LevenbergMarquardt(...) or jk.design.LBFGS(...), got {solver!r}")
    if not (callable(loss) or isinstance(loss, Objective)):
        raise ValueError(f"the loss must be an objective of jk.design, or a function of the motion, got {loss!r}")
    check_mechanism(mechanism, "best designs")
    driven = by_name(drive, "driven displacements", "{'A': angles}")
    check_known("best designs", "jk.optimize", mechanism, loss, *driven.values())
    starts, seed = whole_number(starts, "starts", 1), whole_number(seed, "seed")
    if solver is None:
        solver = LevenbergMarquardt() if isinstance(loss, Objective) else LBFGS()
    squares = isinstance(solver, LevenbergMarquardt)
    chosen = variables(mechanism, drive, lengths or {}, points or {}, extras or {}, ties or {})
    began = time.perf_counter()
    constraints = several(constraints, "constraints", "functions", "[jk.design.above(...)]")
    problem = design_problem(loss, squares, mechanism, chosen, constraints, options_with(options))
    first = problem.motion(chosen.start)[:2]
    downhill = (least_squares if squares else bounded)(problem, min(TOGETHER, starts))
    pool = spread(chosen, starts * POOL if starts > 1 else 1, seed)
    constraint_count = problem.constraint_count(*first)
    verdict = downhill.judge(pool, np.zeros((len(pool), constraint_count)))
    if not np.isfinite(verdict.losses[0]):
        _check_finite(problem, *first)
    if np.any(verdict.charged[0] >= HOPELESS):
        _check_known(problem, *first)
    vectors, weight = _best_of(pool, verdict, starts)
    penalty = Penalty.plain(solver.penalty if solver.penalty is not None else weight, starts, constraint_count)
    least_loss = np.min(np.abs(verdict.losses[np.isfinite(verdict.losses)]), initial=np.inf)
    size = np.sqrt(least_loss) if squares else least_loss
    if _some_matter(downhill, vectors, penalty, chosen, size):
        bar = ProgressBar(solver.iterations, progress, "compiling")
        designs, reason, history = search_with_multipliers(downhill, vectors, penalty, solver, bar)
        bar.close()
    else:
        designs, reason, history = unsearched(downhill, vectors, constraint_count)
    losses, violations, best = designs.losses, designs.violations, designs.best
    vector = designs.vectors[best]
    motion, found, misfits = problem.motion(vector)
    unknown = _unknown_slopes(downhill, vector[None], Penalty.plain(weight, 1, constraint_count), chosen)
    if unknown and not (squares and losses[best] <= NOTHING):
        reason += f"; {_said_of_unknown(unknown)} at the best design, which need not be the best around: {MASK}"
    if violations[best] > MET:
        reason += (
            f"; the best design violates {_violated(problem.gaps(motion, misfits), problem.margins(motion, found))}"
        )
    values = chosen.values(vector)
    return Optimum(
        mechanism=motion.mechanism,
        value=float(losses[best]),
        violation=float(violations[best]),
        history=np.concatenate(history),
        reason=reason,
        seconds=time.perf_counter() - began,
        values=dict(zip(chosen.names, vector.tolist(), strict=True)),
        extras={name: np.asarray(value) for name, value in found.items()},
        drive={name: np.asarray(value) for name, value in values.inputs.items()},
        losses=losses,
        violations=violations,
        moves=judged_range(motion),
        motion=motion,
        initial=first,
        loss=loss,
    )


def _check_finite(problem: Problem, motion: Motion, extras: dict[str, Any]) -> None:
    """Refuse a loss that is no finite number for the design given."""
    judged = jax.jit(problem.of_motion)(motion, extras)
    if not bool(jnp.all(jnp.isfinite(judged))):
        raise ValueError(
            f"the loss of the design given is {float(jnp.sum(judged))}: it must be a finite number there; mask poses "
            "that do not close (motion.closed) and divisions by zero in the loss, or start from another design"
        )


def _check_known(problem: Problem, motion: Motion, extras: dict[str, Any]) -> None:
    """Refuse a constraint that is NaN or -inf for the design given: no direction in which it would be met is known."""
    for name, rows in jax.jit(lambda *given: dict(problem.margins(*given)))(motion, extras).items():
        if unknown := int((jnp.isnan(rows) | (rows <= -HOPELESS)).sum()):
            found = "NaN" if jnp.isnan(rows).any() else f"{float(rows.min()):.3g}"
            raise ValueError(
                f"{name} is {found} for the design given, {unknown} of its {rows.size} numbers: it must be a number "
                "there; mask poses that do not close (motion.closed) or have no forces, or start from another design"
            )


def _best_of(pool: np.ndarray, verdict: Verdict, starts: int) -> tuple[np.ndarray, float]:
    """Find the given design and the best of the pool, and the weight of violations: a hundred times the median of
    their absolute losses."""
    losses, violations = verdict.losses, verdict.violations
    usual = float(np.median(np.abs(losses[np.isfinite(losses)])))
    weight = 100.0 * usual if usual > 0 else 1.0
    total = np.where(np.isfinite(losses), losses, np.inf) + weight * violations**2
    order = [0, *(index for index in np.argsort(total, kind="stable") if index != 0)][:starts]
    return pool[np.array(order)], weight


def _violated(gaps: list[tuple[str, Any]], margins: list[tuple[str, Any]]) -> str:
    """Say what a design violates, the most first, and what may be done."""
    most = {name: float(np.max(rows, initial=0.0)) for name, rows in gaps}
    most |= {name: float(np.nan_to_num(np.max(-np.asarray(rows), initial=0.0), nan=np.inf)) for name, rows in margins}
    order = sorted((name for name in most if most[name] > 0), key=lambda name: -most[name])
    said = ", ".join(f"{name} by up to {most[name]:.3g}" for name in order)
    return f"{said}: give more starts, wider bounds, or a larger penalty= of the solver"


def _some_matter(downhill: Solver, vectors, penalty: Penalty, chosen: Variables, size: float) -> bool:
    """Tell whether any variable has influence on the loss of any start, and warn of those without.

    `size` is that of the loss, infinite where it is not known. What is zero already cannot fall: it warns of nothing.
    """
    slopes = np.asarray(downhill.slopes(downhill.begin(vectors, penalty)))
    influence, free = np.max(np.abs(slopes), axis=0), chosen.upper > chosen.lower
    # where terms cancel, as the mean does in a relative error, rounding is left of what is none
    none = influence <= NO_INFLUENCE * max(np.max(influence), size if np.isfinite(size) else 0.0)
    idle = [name for name, without in zip(chosen.names, none & free, strict=True) if without]
    if idle and size > 0:
        unknown = _unknown_slopes(downhill, vectors, penalty, chosen)
        if unknown := [name for name in unknown if name in idle]:
            raise ValueError(f"{_said_of_unknown(unknown)} for the design given and all other starts: {MASK}")
        warnings.warn(
            f"the loss does not depend on {', '.join(idle)}: the derivative is zero for every start, and "
            "nothing will change there; leave it out, or let the loss depend on it",
            stacklevel=3,
        )
    return bool(np.any(free & ~none))


def _unknown_slopes(downhill: Solver, vectors, penalty: Penalty, chosen: Variables) -> list[str]:
    """Find the variables by which what is minimised has no derivative at any of the designs, though it is a number."""
    unknown = np.all(downhill.unknown(vectors, penalty), axis=0) & (chosen.upper > chosen.lower)
    return [name for name, without in zip(chosen.names, unknown, strict=True) if without]


def _said_of_unknown(names: list[str]) -> str:
    return f"the loss or a constraint is a number, and its derivative by {', '.join(names)} is none"
