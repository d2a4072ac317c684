"""A range that is equally spaced over a turn: the nodes by which the motion is judged are its own poses.

Designs of a batch are mostly followed over such a range, whose inputs are known though the geometry is traced. Fewer
inputs are solved than with nodes beside the poses, and nothing is looked up between nodes. Statuses are those of
`range_by_formula`.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.branch_certificate import (
    certify_line,
    certify_nodes,
    summed,
    surely_passes,
    turns_leapt,
)
from jaxkin.solve.closed_form.input_line import (
    line_start,
    principal_angles,
    solve_on_branch,
    steep_intervals,
    unknown_angles,
)
from jaxkin.solve.closed_form.loop_angles import measured_angles, sums_of_loops, with_left_angles
from jaxkin.solve.closed_form.range_by_formula import FormulaPoses, FoundAngles, judge
from jaxkin.solve.closed_form.turn_grid import TurnGrid
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.status import ClosureTolerance
from jaxkin.solve.system.loop_system import LoopSystem


def find_poses_on_grid(
    system: LoopSystem, grid: TurnGrid, axes: AssembledAxes, tolerance: ClosureTolerance
) -> FormulaPoses:
    """Find the poses of a grid, as `find_poses_and_line` does of any inputs, of a system whose input is an angle."""
    axes, (driven,) = lax.stop_gradient(axes), system.driven
    last = len(grid.nodes) - 1
    roots, solved = solve_on_branch(system, axes, grid.nodes)
    begins, start = line_start(roots, solved, 0)
    steep, sums = steep_intervals(system, solved, last + 1), sums_of_loops(system, axes, start)
    measured = measured_angles(system)
    principal = principal_angles(solved, measured)
    leapt = turns_leapt(principal)

    def with_turns(
        leaps: Float[Array | np.ndarray, "measured nodes"], by_rising: Bool[Array | np.ndarray, " poses"]
    ) -> dict[int, Float[Array, " poses"]]:
        """Take the full turns out that principal values have leapt up to each node, and select the poses; those that a
        falling input reaches are a full turn of it less."""
        known = {driven: jnp.asarray(grid.nodes), **dict(zip(measured, principal - TURN * leaps, strict=True))}
        rows = with_left_angles(system, axes, sums, known)
        turned = {column: TURN * jnp.round((rows[column][last] - rows[column][0]) / TURN) for column in rows}
        return {
            column: jnp.asarray(grid.poses_of(rows[column])) - jnp.where(by_rising, 0.0, turned[column])
            for column in unknown_angles(system)
        }

    # how often each angle leaps, by how much in all, and, if it leaps once, where
    times = jnp.abs(leapt) @ np.ones(last)
    total, interval = jnp.moveaxis(leapt @ np.stack([np.ones(last), np.arange(last)], axis=1), 1, 0)[..., None]

    def whole_line() -> FoundAngles:
        leaps = jnp.where(np.arange(last + 1) > jnp.abs(interval), total, 0.0)
        begun = jnp.broadcast_to(begins, grid.rising.shape)
        return FoundAngles(with_turns(leaps, grid.rising), begun, begun)

    def parts_of_it() -> FoundAngles:
        line = certify_line(solved.discriminants, jnp.asarray(steep), 0, last)
        reached = jax.tree.map(grid.poses_of, certify_nodes(line, len(solved.discriminants)))
        (from_below, from_above), (after_limit, before_limit) = reached
        direct = jnp.where(grid.rising, from_below, from_above)
        limited = jnp.where(grid.rising, after_limit, before_limit)
        # behind a limit an input is reached if it is, a full turn less or more, on the near side
        around = limited & (from_below | from_above)
        by_rising = jnp.where(direct | line.passes, grid.rising, from_below)
        angles, passed = with_turns(summed(leapt), by_rising), direct | around | line.passes
        return FoundAngles(angles, passed & begins, (passed | (after_limit & before_limit)) & begins)

    # most designs pass the whole line with one leap of an angle at most, and whole groups of them do
    simply = surely_passes(solved.discriminants, steep) & jnp.all(times <= 1)
    found = lax.cond(any_in_lockstep(~simply), parts_of_it, whole_line)
    coordinates = [jax.tree.map(grid.poses_of, each) for each in solved.coordinates]
    coordinates[driven] = coordinates[driven]._replace(known=jnp.asarray(grid.values))
    return judge(system, axes, jnp.sign(roots), found, coordinates, tolerance)
