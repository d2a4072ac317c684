"""Compile the solver to programs: one finds the poses, with compiler options of its own; one computes displacements.

Only the program of the displacements is differentiated. Where the numbers are known (under `grad` alone, not inside
`jit` or `vmap`), a gradient finds its poses with the compiler options of a sweep.
"""

from __future__ import annotations

from functools import cache, partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin._traced import inside_trace, traced
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes, assembled_axes
from jaxkin.solve.closed_form.formula_displacements import displacements_by_formula, joint_displacements
from jaxkin.solve.closed_form.group_formulas import why_not_all
from jaxkin.solve.closed_form.input_line import InputLine
from jaxkin.solve.closed_form.poses_on_grid import find_poses_on_grid
from jaxkin.solve.closed_form.range_by_formula import (
    FormulaPoses,
    find_poses_and_line,
    find_poses_by_formula,
    line_of,
)
from jaxkin.solve.closed_form.turn_grid import turn_grid
from jaxkin.solve.correctors.nearest_pose import NearestPoses, nearest_poses
from jaxkin.solve.device import on_cpu
from jaxkin.solve.execution.compiler import count_trace, jit_options
from jaxkin.solve.execution.design_batches import all_designs, by_formulas_in_groups
from jaxkin.solve.execution.known_numbers import KnownRange, Outcome, solve_numbers
from jaxkin.solve.options import CONTINUATION, SolverOptions
from jaxkin.solve.range.poses import RangePoses
from jaxkin.solve.range.solve_range import Shard, displacements, find_poses
from jaxkin.solve.status import ClosureTolerance, Status
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem


def solve(
    system: LoopSystem,
    options: SolverOptions,
    joints: Joints,
    inputs: Float[Array | np.ndarray, "driven poses"],
    tolerance: ClosureTolerance,
    axes: AssembledAxes | None = None,
    line: InputLine | None = None,
) -> tuple[Float[Array, "columns poses"] | list[Float[Array, " poses"]], Outcome]:
    """Find the displacements of all joints, one row a column, for given inputs, with status and residual of each pose.

    Inputs and displacements are in radians and in the unit of the mechanism. A program is compiled once for a system,
    the options that it depends on, and a number of poses. `tolerance`, which may be traced, takes the place of
    `options.tolerance`. `axes` are those of the assembled pose, of systems whose groups all have formulas, and `line`
    is that of a full turn: the general program is compiled only if the formulas do not prove that the motion leads to
    every pose.

    Three routes, in this order: formulas in one program, where numbers are known and the formulas prove all poses;
    `solve_numbers`, where numbers are known and nothing is traced; else poses without derivatives, by formulas or by
    the general solver, and displacements from these by the function that is differentiated.
    """
    by_formula = axes is not None and prefers_formulas(options, inputs)
    known = not traced((joints, inputs, tolerance))
    if known and axes is not None and by_formula:
        line = line or line_of(system, axes, np.asarray(inputs))
        displaced, outcome, proven = _formula_program()(system, joints, axes, line, inputs, tolerance)
        if not traced(proven) and proven:
            return displaced, outcome
    # inside a function that is being traced, what a program returns is traced, though it is given numbers
    inside = inside_trace()
    if known and not inside:
        return solve_numbers(KnownRange(system, options, joints, np.asarray(inputs), tolerance), by_formula)
    numbers = lax.stop_gradient((joints, inputs, tolerance))
    inside = inside or traced(numbers)
    if inside:
        by_formula = _formulas_suffice(system, options, inputs, axes, line)
    if by_formula and inside:
        # axes of traced joints are computed once, for the poses and for the displacements that are differentiated
        own = axes if axes is not None and not traced(joints) else assembled_axes(system, joints)
        held = lax.stop_gradient(own) if axes is None else axes
        found = _poses_by_formula(system, held, inputs, numbers[2], line)
        return displacements_by_formula(system, joints, jnp.asarray(inputs), found, own), _outcome(found)
    if by_formula and axes is not None:
        line = line or line_of(system, axes, np.asarray(numbers[1]))
        found = _formula_poses_program()(system, axes, *numbers[1:], line)
        if found.proven:
            # axes are numbers, also where joints are differentiated: then they have no derivatives
            differentiated = None if traced(joints) else axes
            return _formula_displacements_program(system, joints, inputs, found, differentiated), _outcome(found)
    # compiler options apply to whole programs only: inside a traced function, the search is part of its program
    poses = _poses_program(whole=not inside)(system, options.of_program, *numbers)
    return _displacements_program(system, joints, inputs, poses), _outcome(poses)


def project(
    system: LoopSystem,
    options: SolverOptions,
    joints: Joints,
    given: Float[Array | np.ndarray, "columns poses"],
    weights: Float[Array | np.ndarray, " columns"],
    tolerance: ClosureTolerance,
) -> NearestPoses:
    """Find the closed poses nearest to `given` coordinates of all joints: see `correctors.nearest_pose`."""
    known = not (traced((joints, given, weights, tolerance)) or inside_trace())
    return _projection_program(known)(system, options.of_program, joints, given, weights, tolerance)


def prefers_formulas(options: SolverOptions, inputs: Float[Array | np.ndarray, "*driven poses"]) -> bool:
    """Tell whether a loop group that has formulas goes by them where it is solved by itself: CPUs interpolate long
    ranges then, as formulas would have one core for all poses."""
    return may_use_formulas(options, inputs) and (inputs.shape[-1] < options.interpolate_from or not on_cpu())


def may_use_formulas(options: SolverOptions, inputs: Float[Array | np.ndarray, "*driven poses"]) -> bool:
    """Tell whether poses may be computed by formulas, where there are some."""
    return options.formulas and options.method == CONTINUATION and inputs.dtype == np.float64


def _formulas_suffice(
    system: LoopSystem,
    options: SolverOptions,
    inputs: Float[Array | np.ndarray, "driven poses"],
    axes: AssembledAxes | None,
    line: InputLine | None,
) -> bool:
    """Tell whether a traced range is left to formulas alone: the geometry is traced, too, or has no limit in a turn.

    Where only the inputs are traced, a mechanism that has limits gets the general program, which follows them.
    """
    if not may_use_formulas(options, inputs) or why_not_all(system) is not None:
        return False
    return axes is None or (line is not None and bool(line.passes & line.begins))


def _outcome(poses: RangePoses | FormulaPoses) -> Outcome:
    """Select status and residual norm."""
    return Outcome(poses.status, poses.residual_norm)


def _sweep_by_formula(
    system: LoopSystem,
    joints: Joints,
    axes: AssembledAxes,
    line: InputLine,
    inputs: Float[Array, "1 poses"],
    tolerance: ClosureTolerance,
) -> tuple[Float[Array, "columns poses"], Outcome, Bool[Array, ""]]:
    """Compute displacements and outcome by formulas, and whether these prove that all poses are closed."""
    count_trace()
    found = find_poses_by_formula(system, axes, line, inputs, tolerance)
    displaced = joint_displacements(system, joints, axes, found.rows)
    return displaced, _outcome(found), found.proven


def _poses_by_formula(
    system: LoopSystem,
    axes: AssembledAxes,
    inputs: Float[Array | np.ndarray, "1 poses"],
    tolerance: ClosureTolerance,
    line: InputLine | None,
) -> FormulaPoses:
    """Find poses by formulas; where the geometry is traced, there is no `line` yet."""
    count_trace()
    grid = None
    if line is None and system.periodic and isinstance(inputs, np.ndarray):
        grid = turn_grid(inputs[0])
    if grid is not None:
        find_on_grid = partial(find_poses_on_grid, system, grid)
        return by_formulas_in_groups(find_on_grid)(axes, tolerance)

    def find(axes: AssembledAxes, inputs: Array, tolerance: ClosureTolerance, line: InputLine | None) -> FormulaPoses:
        if line is None:
            return find_poses_and_line(system, axes, inputs, tolerance)
        return find_poses_by_formula(system, axes, line, inputs, tolerance)

    return by_formulas_in_groups(find)(axes, lax.stop_gradient(jnp.asarray(inputs)), tolerance, line)


def _poses_of_all_designs(
    system: LoopSystem, options: SolverOptions, joints: Joints, inputs: Array, tolerance: ClosureTolerance
) -> RangePoses:
    """Find poses by the general solver; under `vmap` of joints those of all designs: see `all_designs`."""
    count_trace()

    def find(joints: Joints, inputs: Array, tolerance: ClosureTolerance, follow_limits: Array | bool) -> RangePoses:
        return find_poses(system, options, joints, inputs, tolerance, Shard(follow_limits=follow_limits))

    return all_designs(find, _all_closed)(joints, inputs, tolerance)


def _all_closed(poses: RangePoses) -> Array:
    """Tell whether all poses of a design are CLOSED."""
    return jnp.all(poses.status == Status.CLOSED.value)


_displacements_program = jax.jit(displacements, static_argnames="system")
"""Displacements from poses that were found: the program that is differentiated."""


@cache
def _formula_program():
    """Make the program of a plain sweep whose poses are formulas: poses and displacements."""
    return jax.jit(_sweep_by_formula, static_argnames="system", **jit_options())


@cache
def _formula_poses_program():
    """Make the program that finds poses by formulas."""
    return jax.jit(_poses_by_formula, static_argnames="system", **jit_options())


_formula_displacements_program = jax.jit(displacements_by_formula, static_argnames="system")
"""Displacements from poses that were found by formulas: the program that is differentiated."""


@cache
def _poses_program(whole: bool):
    """Make the function that finds poses without displacements: a program of its own, or part of a traced one."""
    return jax.jit(_poses_of_all_designs, static_argnames=("system", "options"), **(jit_options() if whole else {}))


@cache
def _projection_program(whole: bool):
    """Make the program of the nearest closed poses: one of its own, or part of a traced one."""
    return jax.jit(nearest_poses, static_argnames=("system", "options"), **(jit_options() if whole else {}))
