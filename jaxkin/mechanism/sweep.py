"""The sweep: displacements of all joints for given displacements of some, over a whole range (Section 5)."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes, lax
from jaxtyping import Array, Float

from jaxkin._arguments import by_name, yes_or_no
from jaxkin._traced import inside_trace, traced
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.trig import TURN
from jaxkin.linkage.coordinates import InputValues, given_values, named, with_finite_inputs
from jaxkin.mechanism.collect import Collected, DisplacementSources, GroupSolution, collect
from jaxkin.mechanism.describe import why_infeasible
from jaxkin.mechanism.drive_plan import DrivenLoopGroup, DrivePlan, plan_drive
from jaxkin.mechanism.joint_limits import with_limited
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.targets import with_targets
from jaxkin.solve.correctors.least_residual import least_residual
from jaxkin.solve.execution.compiler import jit_options
from jaxkin.solve.execution.known_numbers import KnownRange, Outcome, compile_together
from jaxkin.solve.execution.programs import may_use_formulas, prefers_formulas, solve
from jaxkin.solve.options import SolverOptions, options_with
from jaxkin.solve.status import ClosureTolerance, default_tolerance, in_doubt, rounding_residual

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

DEFAULT_ROUNDINGS = 16
"""Units of rounding in the residual of a pose that is improved no further if no tolerance is asked for: 3.6e-15
in float64, where rounding alone leaves about 1e-15 for each elementary motion."""
FAR_ROUNDINGS = 4
"""Distance between neighbouring numbers at the largest driven angle that a closed pose may have as its residual, if no
tolerance is asked for: within the first turn it is the default tolerance of float32. At 100 turns neighbours are 6e-5
apart there, and poses close no better."""


def sweep(
    mechanism: Mechanism,
    drive: Mapping[Any, object],
    *,
    options: SolverOptions | None = None,
    tolerance: float | jax.Array | None = None,
    method: str | None = None,
    throw: bool = False,
) -> Motion:
    """Compute the motion of all parts while some joint coordinates run through given displacements.

    `drive` maps "joint" (if it has one coordinate) or "joint.coordinate" to an array of one value a pose: radians, or
    lengths in the unit of the mechanism, measured from the assembled pose; or a target (`jk.pose("part")`,
    `jk.point("part", at)`, `jk.orientation("part")`) to poses, points or rotations, of which joints follow. Several
    arrays must have equal length. The motion is followed from the assembled pose; a single input may come in any order,
    several are followed in the order given. Only loops that a driven joint moves are solved; coordinates that nothing
    drives stay at rest.

    A pose is closed where its residual is at most the `tolerance`, and improved no further; by default 1e-12 (2e-6 in
    float32), and improved down to rounding. `method` names another way to find poses (`jaxkin.solve.options.METHODS`):
    for comparison, none is as fast or watches the branch; `jk.work_precision` shows what either costs. Both are
    shorthands for fields of `options`, a `jk.SolverOptions`, which has all settings of the solver. The motion keeps its
    options, and effects of the motion use them.

    Works inside `jax.jit`, `vmap` and `grad`. A pose that cannot be reached, or is beyond the limits of a joint, is
    reported in `motion.status`; with `throw=True` it raises PoseError instead (see `Motion.check`). A pose whose
    displacements are NaN or infinite is NONFINITE and NaN itself, and all others are what they would be without it.
    Raises ValueError for a drive that makes no sense (see `jaxkin.linkage.coordinates.resolve`), for one that the loops
    have no freedoms for (see `jaxkin.mobility.infeasible_drive`; not where the geometry is traced), for options of
    wrong values, and for `throw=True` where numbers are traced.
    """
    warn_of_float32()
    throw = yes_or_no(throw, "throw")
    motion = with_limited(follow_drive(mechanism, drive, options_with(options, tolerance, method), tolerance))
    if throw:
        motion.check()
    return motion


def follow_drive(
    mechanism: Mechanism, drive: Mapping[Any, object], options: SolverOptions, tolerance: Any = None
) -> Motion:
    """Compute the motion of a sweep, without regard to the limits of joints; a traced `tolerance` is given beside the
    options."""
    mechanism, drive = with_targets(mechanism, by_name(drive, "driven displacements", "{'A': angles}"))
    if inside_trace() and not traced((mechanism, *drive.values(), tolerance)):
        # a motion of known numbers is a constant of the program that is traced
        with jax.ensure_compile_time_eval():
            return _follow(mechanism, drive, options, tolerance)
    return _follow(mechanism, drive, options, tolerance)


def _follow(mechanism: Mechanism, drive: Mapping[str, Any], options: SolverOptions, tolerance: Any) -> Motion:
    """Solve the loop groups that a drive without targets moves, and collect them: by formulas in one program, else each
    by `programs.solve`."""
    plan = plan_drive(mechanism.linkage, named(drive))
    values = given_values(plan.driven, drive)
    if plan.infeasible:
        raise ValueError(why_infeasible(mechanism, plan.infeasible))
    traced_tolerance = tolerance is not None and traced(tolerance)
    asked = closure_tolerance(tolerance if traced_tolerance else options.tolerance, _largest_angle(plan.driven, values))
    loop_groups = plan.loop_groups if values[0].shape[0] else ()
    followed, finite = with_finite_inputs(values)
    known = not traced_tolerance and all(isinstance(each, np.ndarray) for each in followed)
    # by formulas for all loop groups in one program; where some have none, each loop group decides in `programs.solve`
    if loop_groups and plan.formula_sweep is not None and known and may_use_formulas(options, followed[0]):
        kept = None if finite is None else np.asarray(finite)
        found = plan.formula_sweep.solve(followed, kept, asked, options.cores)
        if found is not None:
            found = found if finite is None else found._replace(inputs=values)
            return _motion(mechanism, plan, found, options)
    inputs = [padded([followed[i] for i in loop_group.inputs]) for loop_group in loop_groups]
    whole = known and not inside_trace()
    if whole and len(loop_groups) > 1:
        compile_together(
            KnownRange(loop_group.system, options, loop_group.joints, each, asked)
            for loop_group, each in zip(loop_groups, inputs, strict=True)
            if isinstance(each, np.ndarray) and (loop_group.axes is None or not prefers_formulas(options, each))
        )
    solutions = [
        solve(loop_group.system, options, loop_group.joints, each, asked, loop_group.axes, loop_group.line)
        for loop_group, each in zip(loop_groups, inputs, strict=True)
    ]
    loop_groups, solutions = _of_least_residual(loop_groups, solutions, asked)
    columns = tuple(loop_group.columns for loop_group in loop_groups)
    sources = DisplacementSources(plan.freedoms, tuple(plan.driven.values()), columns)
    collected = _whole_collect() if whole and not traced(solutions) else _collect
    return _motion(mechanism, plan, collected(sources, values, finite, solutions), options)


def _motion(mechanism: Mechanism, plan: DrivePlan, found: Collected, options: SolverOptions) -> Motion:
    """Make the motion of what was collected; if the assembled pose is a dead point, some statuses are `in_doubt`."""
    # under `grad` JAX hands arrays of the host through as they are
    arrays = (each if isinstance(each, jax.Array) else jnp.asarray(each) for each in found.inputs)
    inputs = dict(zip(plan.driven, arrays, strict=True))
    displacements, status = found.displacements(plan.freedoms), found.status
    if plan.at_dead_point:
        status = in_doubt(status)
    return Motion(mechanism, inputs, displacements, status, found.residual, options=options)


def _of_least_residual(
    loop_groups: Sequence[DrivenLoopGroup], solutions: Sequence[GroupSolution], asked: ClosureTolerance
) -> tuple[list[DrivenLoopGroup], list[GroupSolution]]:
    """Replace solutions of ideal joints by the poses of least residual of the joints that were given; of loop groups
    whose given joints disagree (`DrivenLoopGroup.given`)."""
    every, found = list(loop_groups), list(solutions)
    for number, (loop_group, (rows, outcome)) in enumerate(zip(loop_groups, solutions, strict=True)):
        if loop_group.given is None:
            continue
        system, columns, joints = loop_group.given
        zeros = jnp.zeros_like(rows[0])
        begun = [rows[loop_group.columns.index(each)] if each in loop_group.columns else zeros for each in columns]
        poses, status, residual_norm = least_residual(
            system, joints, loop_group.joints, jnp.stack(begun), outcome.status, asked.max_residual
        )
        every[number], found[number] = loop_group._replace(columns=columns), (poses, Outcome(status, residual_norm))
    return every, found


def _largest_angle(driven: Iterable[str], values: Sequence[InputValues]) -> float:
    """Find the largest driven angle, radians, of numbers that are known; zero where it is within a turn, or traced."""
    angles = [
        np.abs(np.asarray(each))
        for name, each in zip(driven, values, strict=True)
        if not (is_length(name.rpartition(".")[2]) or traced(each))
    ]
    largest = max((np.max(each, initial=0.0, where=np.isfinite(each)) for each in angles), default=0.0)
    return float(largest) if largest > TURN else 0.0


def closure_tolerance(asked: Any, largest_angle: float = 0.0) -> ClosureTolerance:
    """Make the tolerance of a number, known or traced; for None that of the floating-point precision.

    The latter is at least `FAR_ROUNDINGS` times the distance between neighbouring numbers at `largest_angle`, radians.
    """
    dtype = dtypes.canonicalize_dtype(float)
    if asked is None or isinstance(asked, float):
        spacing = 0.0 if asked is not None else float(np.spacing(np.asarray(largest_angle, dtype)))
        return _known_tolerance(asked, dtype, spacing if FAR_ROUNDINGS * spacing > default_tolerance(dtype) else 0.0)
    asked = jnp.asarray(asked, dtype)
    return ClosureTolerance(asked, asked)


@lru_cache(maxsize=64)
def _known_tolerance(asked: float | None, dtype: np.dtype, spacing: float) -> ClosureTolerance:
    """Make the tolerance of a known number: of numbers of the host, since to make arrays of the device takes longer."""
    if asked is None:
        largest = max(default_tolerance(dtype), FAR_ROUNDINGS * spacing)
        residuals = largest, rounding_residual(dtype, DEFAULT_ROUNDINGS)
        return ClosureTolerance(*(np.asarray(residual, dtype) for residual in residuals))
    known = np.asarray(asked, dtype)
    return ClosureTolerance(known, known)


_collect = jax.jit(collect, static_argnums=0)


@cache
def _whole_collect():
    """Make the program that collects numbers that are known: it is not part of another one."""
    return jax.jit(collect, static_argnums=0, **jit_options())


def padded(rows: list[InputValues]) -> Float[Array | np.ndarray, "driven padded"]:
    """Repeat the last pose up to one of few lengths, so that ranges of similar length share a compiled program.

    Lengths are powers of two from 32 to 256 poses, above that multiples of an eighth of one, above 32768 of a 32nd.
    Traced inputs, and all inside a function that is traced, are left alone: their program is compiled for their length
    anyway. Without a drive: one pose for all.
    """
    if not rows:
        return jnp.zeros((0, 1), float)
    poses = rows[0].shape[0]
    power = 2 ** max(5, (poses - 1).bit_length())
    part = power if power <= 256 else power // (8 if power <= 2**15 else 32)
    length = -(-poses // part) * part
    if not traced(rows):
        if inside_trace():
            return np.stack(rows)
        # on the host: there it costs a copy, not a program for every length
        filled = np.empty((len(rows), length), rows[0].dtype)
        for whole, row in zip(filled, rows, strict=True):
            whole[:poses], whole[poses:] = row, row[-1]
        return filled
    inputs = jnp.stack(rows)
    return inputs if traced(lax.stop_gradient(inputs)) else jnp.pad(inputs, ((0, 0), (0, length - poses)), mode="edge")


_warned = False


def warn_of_float32() -> None:
    """Warn, once in a process, where JAX computes in float32."""
    global _warned  # noqa: PLW0603
    if _warned or dtypes.canonicalize_dtype(float) == jnp.float64:
        return
    _warned = True
    warnings.warn(
        "jaxkin computes in float32: loops close to about 5e-7 of the size. For 1e-15 write "
        'jax.config.update("jax_enable_x64", True) before the first array is made.',
        stacklevel=4,
    )
