"""Which angles of planar loops are measured, and which are left: all turns of a closed loop together are none.

Of each group the last angle is what the others leave. It is counted on from the assembled pose as they are, so that it
needs no arc tangent, and no full turns of its own. That is for inputs within a turn: many turns on, it would be the
small difference of large angles.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Float

from jaxkin.solve.closed_form.arithmetic import Number
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.chain_motions import moving_rows
from jaxkin.solve.closed_form.group_formulas import GroupFormula, group_formulas
from jaxkin.solve.closed_form.input_line import unknown_angles
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem


class LeftAngle(NamedTuple):
    """An unknown angle that follows from all other angles of its loop."""

    column: int
    chain: int
    """Number of the chain of `ChainTables` that is the loop."""
    row: int
    """Row of the chain that holds the angle."""
    others: tuple[tuple[int, int], ...]
    """Row and column of all other angles of the loop."""


@lru_cache(maxsize=256)
def left_angles(system: LoopSystem) -> tuple[LeftAngle, ...]:
    """List the angles that are left, in order of solution: one of each group of a planar system."""
    if not system.planar:
        return ()
    known, table, found = {*system.driven, *unknown_angles(system)}, chain_tables(system), []
    for formula in group_formulas(system):
        if isinstance(formula, GroupFormula):
            chain, own = formula.chain, max(k for k, letter in enumerate(formula.letters) if letter == "R")
            columns = {row: int(table.column[row, chain]) for row in moving_rows(system, chain)}
            others = [
                (row, column)
                for row, column in columns.items()
                if row != formula.rows[own] and table.turn[row, chain] and column in known
            ]
            found.append(LeftAngle(formula.columns[own], chain, formula.rows[own], tuple(others)))
    return tuple(found)


@lru_cache(maxsize=256)
def measured_angles(system: LoopSystem) -> tuple[int, ...]:
    """List the columns of unknown angles that are computed from their turns: all that are not left."""
    left = {angle.column for angle in left_angles(system)}
    return tuple(column for column in unknown_angles(system) if column not in left)


def sums_of_loops(
    system: LoopSystem, axes: AssembledAxes, start: Float[Array | np.ndarray, " columns"]
) -> list[Number]:
    """Add up the angles of each loop that leaves one, from all coordinates in the assembled pose."""
    sums = []
    for angle in left_angles(system):
        sense = axes.sense[angle.row, angle.chain]
        rest = [sense * axes.sense[row, angle.chain] * start[column] for row, column in angle.others]
        sums.append(start[angle.column] + sum(rest))
    return sums


def with_left_angles(
    system: LoopSystem,
    axes: AssembledAxes,
    sums: Sequence[Number] | Float[Array | np.ndarray, " left"],
    angles: Mapping[int, Float[Array | np.ndarray, " poses"]],
) -> dict[int, Float[Array | np.ndarray, " poses"]]:
    """Add the angles that are left to those of the input and of the measured columns, which are counted on from the
    assembled pose; by column. `sums` are those of the loops."""
    known = dict(angles)
    for whole, angle in zip(sums, left_angles(system), strict=True):
        sense = axes.sense[angle.row, angle.chain]
        for row, column in angle.others:
            whole = whole - sense * axes.sense[row, angle.chain] * known[column]
        known[angle.column] = whole
    return known
