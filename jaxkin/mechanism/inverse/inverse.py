"""Solve inverse problems: joints for targets that are more, or fewer, than the freedoms, within limits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from jaxkin._arguments import by_name, check_mechanism, one_number, several, whole_number, yes_or_no
from jaxkin._names import counted
from jaxkin._traced import traced
from jaxkin.linkage.coordinates import coordinates
from jaxkin.mechanism.inverse.aims import aims_of
from jaxkin.mechanism.inverse.bounded import Bounds
from jaxkin.mechanism.inverse.problem import InverseProblem
from jaxkin.mechanism.inverse.solution import CLOSED, REACHED, InversePoses, from_assembled, from_random, from_unlimited
from jaxkin.mechanism.joint_limits import with_limited
from jaxkin.mechanism.motion import Motion
from jaxkin.mobility.open_loops import left_open
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

SAME_SOLUTION = 1e-6
"""Largest difference of the coordinates of two solutions that are one, radians and sizes: far above `REACHED`."""


@dataclass(frozen=True, eq=False)
class Inverse:
    """Poses whose joints fit targets as well as they can."""

    motion: Motion
    """The poses: of each the solution that was found from the assembled pose, unless another one fits better."""
    errors: Float[np.ndarray, " poses"]
    """Root of the sum of squared errors of all targets with their weights: radians, and lengths over `size`."""
    stationary: Bool[np.ndarray, " poses"]
    """At which poses no small movement within loops and limits lessens the error."""
    at_limits: Mapping[str, Bool[np.ndarray, " poses"]]
    """At which poses a coordinate is at one of its limits, for those that are at some pose."""
    solutions: tuple[Float[np.ndarray, "_ columns"], ...]
    """Of each pose all solutions that fit as well as the best one, displacements of `columns`; those of the motion
    come first."""
    columns: tuple[str, ...]
    """All coordinates of the mechanism, "joint.coordinate"."""
    size: float
    """Length that counts as much as a radian: the extent of the joints."""

    @property
    def reached(self) -> Bool[np.ndarray, " poses"]:
        """At which poses all targets are met."""
        return (self.errors <= REACHED) & np.asarray(self.motion.on_branch)

    def __str__(self) -> str:
        reached, poses = int(self.reached.sum()), len(self.errors)
        lines = [f"{reached} of {poses} poses reach their targets"]
        if reached < poses:
            worst = int(np.nanargmax(self.errors))
            lines.append(
                f"  largest error {self.errors[worst]:.3g} (radians, and lengths over {self.size:.4g}), pose {worst}"
            )
        if (moving := reached + int(self.stationary[~self.reached].sum())) < poses:
            lines.append(f"  at {poses - moving} poses the error can still be less: give more iterations")
        lines += [
            f"  {name} is at a limit at {counted(np.sum(which), 'pose')}" for name, which in self.at_limits.items()
        ]
        if (several := max((len(found) for found in self.solutions), default=0)) > 1:
            lines.append(f"  up to {several} solutions a pose")
        if (lost := poses - int(np.asarray(self.motion.on_branch).sum())) > 0:
            lines.append(f"  the loops do not close at {counted(lost, 'pose')}")
        return "\n".join(lines)


def inverse(
    mechanism: Mechanism,
    targets: Mapping[Any, object],
    *,
    weights: Mapping[Any, float | int | Sequence[float | int]] | None = None,
    inputs: Iterable[str] | None = None,
    rest: Mapping[str, float | int] | None = None,
    limits: bool = True,
    starts: int = 1,
    seed: int = 0,
    iterations: int = 100,
) -> Inverse:
    """Find poses whose parts and joints are where targets ask for, as nearly as the loops and limits let them.

    `targets` are those of `sweep`: `jk.pose`, `jk.point`, `jk.orientation` of parts, and joints by name. Where they are
    as many as the freedoms, and can be met, `sweep` finds the same poses, with derivatives. Where they are more, or out
    of reach, no small movement within loops and limits lessens the sum of squared errors, lengths over the extent of
    the joints (`stationary` tells where `iterations` were too few for that); where they are fewer, the inputs move as
    little as they can.

    - `weights`: factors of the errors of targets, 1 where none is given; `(place, orientation)` for a pose. A weight of
      zero leaves an error out.
    - `inputs`: the coordinates whose movement is least; by default the motors of the mechanism, else those that can
      drive it.
    - `rest`: displacements of inputs from which their movement is measured, by default those of the assembled pose.
    - `limits`: whether coordinates stay within the limits of their joints.
    - `starts`: how many starts there are: the assembled pose, and others at random (`seed`) from which other branches
      are found, so other working modes too, and smaller errors farther away. Where a hinge stops at a limit short of
      the targets, it is tried the other way round, too.
    - `iterations`: of each start, at most.

    Loops are closed at every pose; its status is UNREACHABLE where they are not, and MISFIT where they are those of the
    nearest joints that agree, because the given ones do not. Runs on the host; the balls have their three angles, which
    are singular a quarter turn of phi from the assembled pose. Raises ValueError for names that are not there, values
    of another shape, and inside `jit`, `vmap` and `grad`.
    """
    check_mechanism(mechanism, "inverse kinematics")
    if not isinstance(targets, Mapping) or not targets:
        raise ValueError(f"targets map jk.pose, jk.point, jk.orientation or joints to values, got {targets!r}")
    named = [*targets.values(), *by_name(weights or {}, "weights", "{'A': 10.0}").values()]
    if traced(mechanism, named, *by_name(rest or {}, "places of rest", "{'A': 0.1}").values()):
        raise ValueError("inverse is for numbers: inside jit, vmap and grad sweep over targets instead")
    starts, iterations = whole_number(starts, "starts", 1), whole_number(iterations, "iterations", 1)
    seed, limits = whole_number(seed, "seed"), yes_or_no(limits, "limits")
    wanted = several(inputs or mechanism.motors or _drivable(mechanism), "inputs", "coordinates")
    if not wanted:
        raise ValueError("the mechanism has no freedom, so no target can move it; print(mechanism) says what blocks it")
    chosen = [*coordinates(mechanism.linkage, wanted)]
    problem = _problem(mechanism, targets, weights or {}, chosen, rest or {})
    bounds = problem.limits if limits else problem.unlimited
    found = [from_assembled(problem, bounds, iterations)]
    stopped = _at_limits(found[0].x, bounds) & problem.turns
    if np.any((found[0].error > REACHED) & stopped.any(axis=1)):
        found.append(from_unlimited(problem, bounds, iterations))
    found += from_random(problem, bounds, iterations, starts - 1, seed)
    every = InversePoses(*(np.stack(each) for each in zip(*found, strict=True)))
    errors = np.where(every.closure <= CLOSED, every.error, np.inf)
    least = errors.min(axis=0)
    best = np.where(errors[0] <= least + REACHED, 0, errors.argmin(axis=0))
    poses = np.arange(problem.poses)
    x = every.x[best, poses]
    at = _at_limits(x, bounds)
    return Inverse(
        _motion(mechanism, problem, x, every.closure[best, poses], chosen),
        every.error[best, poses],
        every.stationary[best, poses],
        {name: at[:, column] for column, name in enumerate(problem.names) if at[:, column].any()},
        tuple(
            _distinct(problem, bounds, every.x[:, pose], errors[:, pose], int(best[pose])) * problem.units
            for pose in poses
        ),
        problem.names,
        problem.size,
    )


def _problem(
    mechanism: Mechanism, targets: Mapping[Any, Any], weights: Any, inputs: Sequence[str], rest: Any
) -> InverseProblem:
    """Make the problem of targets of known numbers, with its inputs and where these rest; ValueError as `inverse`."""
    problem = InverseProblem(mechanism, aims_of(mechanism, targets, by_name(weights, "weights", "{'A': 10.0}")))
    for name in inputs:
        problem.inputs[problem.column(name)] = True
    for name, value in by_name(rest, "places of rest", "{'A': 0.1}").items():
        column = problem.column(name)
        if not problem.inputs[column]:
            raise ValueError(f"rest names {name!r}, which is no input; the inputs are {', '.join(inputs)}")
        problem.rest[column] = float(one_number(value, f"the place of rest of {name!r}")) / problem.units[column]
    return problem


def _drivable(mechanism: Mechanism) -> Sequence[str]:
    """Find the coordinates that determine the motion together, or all where the loops cannot be closed."""
    if left_open(mechanism.linkage) is None:
        return mechanism.mobility().drivable
    return [name for joint in mechanism.all_joints for name in joint.full_names]


def _motion(
    mechanism: Mechanism, problem: InverseProblem, x: np.ndarray, closure: np.ndarray, inputs: Sequence[str]
) -> Motion:
    """Make the motion whose poses were found, with the displacements of the inputs as its own."""
    q = jnp.asarray(x * problem.units)
    split = np.cumsum([joint.freedoms for joint in mechanism.all_joints])[:-1]
    closed = Status.MISFIT if mechanism.linkage.ideal else Status.CLOSED
    status = np.where(closure <= CLOSED, closed.value, Status.UNREACHABLE.value).astype(np.int32)
    inputs_of = {name: q[:, problem.names.index(name)] for name in inputs}
    rows = tuple(jnp.split(q, split, axis=1))
    found = jnp.asarray(status), jnp.asarray(closure)
    return with_limited(Motion(mechanism, inputs_of, rows, *found, SolverOptions(), swept=False))


def _at_limits(x: Float[np.ndarray, "poses columns"], bounds: Bounds) -> Bool[np.ndarray, "poses columns"]:
    """Tell which coordinates are at one of their limits."""
    return (x <= bounds.low + REACHED) | (x >= bounds.high - REACHED)


def _distinct(
    problem: InverseProblem, bounds: Bounds, x: Float[np.ndarray, "starts columns"], errors: np.ndarray, first: int
) -> Float[np.ndarray, "solutions columns"]:
    """Collect the solutions that fit as well as the first one, which comes first; the others turned back near zero."""
    kept: list[np.ndarray] = []
    for number in [first, *np.argsort(errors)]:
        if errors[number] > errors[first] + REACHED or not np.isfinite(errors[number]):
            continue
        one = x[number] if number == first else problem.turned_back(x[number], bounds)
        off = [problem.turned_back(one - other, problem.unlimited) for other in kept]
        if all(np.abs(each).max(initial=0.0) > SAME_SOLUTION for each in off):
            kept.append(one)
    return np.stack(kept) if kept else np.zeros((0, x.shape[1]))
