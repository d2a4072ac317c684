"""The line of nodes through the assembled pose: what is known of a drive before any pose is asked for.

A full turn of an input that is an angle is one line for all ranges, so that it is computed once for a mechanism, with
NumPy. Where the geometry is traced, the line is part of the program.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.arithmetic import namespace
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.branch_certificate import (
    LEAST_DISCRIMINANT,
    NodeRows,
    are_steep,
    certify_line,
    surely_passes,
    unwrapped,
)
from jaxkin.solve.closed_form.complex_numbers import Complex, argument
from jaxkin.solve.closed_form.group_formulas import GroupFormula, group_formulas
from jaxkin.solve.closed_form.solve_groups import Solved, assembled_roots, solve_once
from jaxkin.solve.system.loop_system import LoopSystem

NODES = 129
"""Inputs at which the discriminants are computed, 2.8 degrees apart on a full turn: they cost as much as 129 poses."""
CLOSED_START = 1e-9
"""Largest coordinate that the formulas give for the assembled input, radians or characteristic lengths, of loops that
are closed there: rounding, and what files were rounded to."""
LEAST_ASSEMBLED_ROOT = 0.05
"""Least absolute value of the signed root in the assembled pose (such as the sine of an elbow) of loops that changed
dimensions leave open there: nearer to zero, its sign does not tell which branch the pose is on."""


class Windings(NamedTuple):
    """The unknown angles at the nodes, which are equally spaced: by them principal values get their full turns."""

    begin: Float[Array | np.ndarray, ""]
    """Input of the first node, radians or characteristic lengths."""
    spacing: Float[Array | np.ndarray, ""]
    """Difference of the inputs of neighbouring nodes."""
    angles: NodeRows
    """Unknown angles at all nodes, radians, right to 0.08, unwrapped along the line."""
    begun: Float[Array | np.ndarray, " angles"]
    """The full turns in `angles` at the node of the assembled pose: multiples of 2 pi, radians."""
    ended: Float[Array | np.ndarray, " angles"]
    """The same where the assembled pose is again, a full turn of the input later; `begun` where that is a length."""


class InputLine(NamedTuple):
    """What discriminants and unknown angles at the nodes say of the motion along them."""

    signs: Float[Array | np.ndarray, "groups 1"]
    """The sign of the branch of every group."""
    begins: Bool[Array | np.ndarray, ""]
    """Whether the assembled pose is without doubt on a branch that can be followed."""
    passes: Bool[Array | np.ndarray, ""]
    """Whether the motion passes the whole line; where the geometry is traced, whether it does so by a wide margin."""
    discriminants: NodeRows
    """Of every group at every node."""
    steep: Bool[Array | np.ndarray, " intervals"]
    """Intervals in which an angle turns too far to be unwrapped."""
    windings: Windings


class PassedLine(NamedTuple):
    """What of a line is asked for by inputs up to which the motion passes it without doubt: see `passed_range`."""

    signs: Float[Array | np.ndarray, "groups 1"]
    """The sign of the branch of every group."""
    windings: Windings


def passed_range(system: LoopSystem, line: InputLine) -> tuple[float, float]:
    """Find the lowest and the highest input up to which the motion passes a line of known numbers without doubt.

    Radians or characteristic lengths; infinite where it passes the whole line, and (0, 0) where it does not begin.
    """
    if not line.begins:
        return 0.0, 0.0
    if line.passes:
        return -np.inf, np.inf
    below, above = certify_line(line.discriminants, np.asarray(line.steep), *ends(system)).blocked
    begin, spacing = line.windings.begin, line.windings.spacing
    lowest = begin + spacing * (below + 1) - (TURN if system.periodic else 0.0)
    return float(lowest), float(begin + spacing * above)


def full_turn(system: LoopSystem, axes: AssembledAxes) -> InputLine:
    """Compute the line of an input that is an angle: from the assembled pose a full turn on."""
    return line_and_poses(system, axes, turn_nodes(), np.zeros(0))[0]


def turn_nodes() -> Float[np.ndarray, " nodes"]:
    """Space nodes over a full turn, from the assembled pose on, radians."""
    return np.linspace(0.0, TURN, NODES)


def nodes_to_either_side(farthest: Float[Array | np.ndarray, ""] | float) -> Float[Array | np.ndarray, " nodes"]:
    """Space nodes as far as the input `farthest` (radians or characteristic lengths) on either side."""
    return namespace(farthest).maximum(farthest, np.finfo(float).tiny) * np.linspace(-1.0, 1.0, NODES)


def ends(system: LoopSystem) -> tuple[int, int]:
    """Return the nodes that are the assembled pose: from the first one lines lead upwards, from the last downwards."""
    return (0, NODES - 1) if system.periodic else (NODES // 2, NODES // 2)


def unknown_angles(system: LoopSystem) -> list[int]:
    """List the columns of the angles that are found by formulas."""
    found = [formula for formula in group_formulas(system) if isinstance(formula, GroupFormula)]
    return [
        column
        for formula in found
        for column, letter in zip(formula.columns, formula.letters, strict=True)
        if letter == "R"
    ]


def principal_angles(solved: Solved, columns: Sequence[int]) -> Float[Array, "columns poses"]:
    """Compute angles from their turns in a program, radians in (-pi, pi].

    All are in one array: so they are a few operations of the program, not a few each.
    """
    turns = [jax.tree.map(jnp.asarray, solved.coordinates[column].turn) for column in columns]
    if not turns:
        return jnp.zeros((0, *solved.discriminants[0].shape))
    return jnp.asarray(argument(Complex(*(jnp.stack(parts) for parts in zip(*turns, strict=True)))))


def line_and_poses(
    system: LoopSystem,
    axes: AssembledAxes,
    nodes: Float[Array | np.ndarray, " nodes"],
    values: Float[Array | np.ndarray, " poses"],
) -> tuple[InputLine, Solved]:
    """Compute the line of the nodes, and the poses of further inputs, in radians and characteristic lengths.

    Nodes and poses are solved together: a program holds the formulas once for both.
    """
    xp = namespace(axes.centre, nodes, values)
    roots, together = solve_on_branch(system, axes, xp.concatenate([nodes, values]))

    def cut(begin: int, end: int | None) -> Solved:
        # what is the same for all inputs has one entry
        return jax.tree.map(lambda row: row if row.shape[0] == 1 else row[begin:end], together)

    return _line(system, nodes, roots, cut(0, NODES)), cut(NODES, None)


def solve_on_branch(
    system: LoopSystem, axes: AssembledAxes, inputs: Float[Array | np.ndarray, " inputs"]
) -> tuple[Float[Array | np.ndarray, "groups 1"], Solved]:
    """Compute the signed roots in the assembled pose, and poses on its branch."""
    xp = namespace(axes.centre, inputs)
    roots = xp.stack([xp.ravel(root)[:1] for root in assembled_roots(system, axes)])
    return roots, solve_once(system, axes, xp.sign(roots), inputs[None])


class LineStart(NamedTuple):
    """What is known of a line where the assembled pose is."""

    begins: Bool[Array | np.ndarray, ""]
    """As that of the line."""
    coordinates: Float[Array | np.ndarray, " columns"]
    """Of all columns, radians in (-pi, pi] and characteristic lengths: zero, unless dimensions were changed."""


def line_start(roots: Float[Array | np.ndarray, "groups 1"], solved: Solved, node: int) -> LineStart:
    """Judge where a line begins, from the signed roots in the assembled pose, which is a node of those solved."""
    xp = namespace(roots)
    start = xp.stack([coordinate.at(node) for coordinate in solved.coordinates])
    is_open = xp.max(xp.abs(start)) > CLOSED_START
    clear = xp.min(xp.abs(roots)) > LEAST_ASSEMBLED_ROOT
    movable = xp.min(xp.stack([each[node] for each in solved.discriminants])) > LEAST_DISCRIMINANT
    return LineStart(movable & (clear | ~is_open), start)


def steep_intervals(system: LoopSystem, solved: Solved, nodes: int) -> Bool[Array | np.ndarray, " intervals"]:
    """Tell in which intervals between nodes an unknown angle turns too far to be unwrapped."""
    return are_steep([solved.coordinates[column].turn for column in unknown_angles(system)], nodes)


def _line(
    system: LoopSystem,
    nodes: Float[Array | np.ndarray, " nodes"],
    roots: Float[Array | np.ndarray, "groups 1"],
    solved: Solved,
) -> InputLine:
    """Read the line from its nodes, which are solved, and from the signed roots in the assembled pose."""
    first, last = ends(system)
    xp = namespace(roots, nodes)
    angles, steep = unknown_angles(system), steep_intervals(system, solved, NODES)
    nearby = unwrapped([solved.coordinates[column].turn for column in angles])
    discriminants: NodeRows = solved.discriminants
    if xp is np:
        discriminants, nearby = np.stack(discriminants), np.array(nearby).reshape(-1, NODES)
        passes = certify_line(discriminants, steep, first, last).passes
    else:
        passes = surely_passes(discriminants, steep)
    begins, start = line_start(roots, solved, first)
    # the line is unwrapped from its first node on
    assembled = start[np.array(angles, int)]
    begun, ended = (
        TURN * xp.round((xp.array([row[node] for row in nearby], float) - assembled) / TURN) for node in (first, last)
    )
    windings = Windings(nodes[0], nodes[1] - nodes[0], nearby, begun, ended)
    return InputLine(xp.sign(roots), begins, passes, discriminants, steep, windings)
