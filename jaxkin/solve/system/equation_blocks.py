"""The equations of a loop system in the blocks in which they are solved: one block for each group of its order.

No block holds an unknown of a later one: the Jacobian is block lower triangular. Three systems of three equations cost
a tenth of one of nine.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from jaxkin.solve.system.loop_system import LoopSystem


class EquationBlock(NamedTuple):
    """Equations, and the unknowns that they are solved for when those of the blocks before are known."""

    rows: tuple[int, ...]
    """Rows of the Jacobian, as `Closure.residual` has them."""
    columns: tuple[int, ...]
    """Columns of the Jacobian, rising."""


@lru_cache(maxsize=256)
def equation_blocks(system: LoopSystem) -> tuple[EquationBlock, ...]:
    """The blocks of a system in the order in which they are solved; equations without any unknown left are in none."""
    return tuple(block for block in blocks_of_groups(system) if block.columns)


def blocks_of_groups(system: LoopSystem) -> tuple[EquationBlock, ...]:
    """The block of each group of `LoopSystem.order`; without columns where nothing is left to be solved for."""
    known: set[int] = set()
    found = []
    for group in system.order:
        held = {column for loop in group for joint, _ in system.loops[loop] for column in system.span(joint)}
        unknown = tuple(column for column in system.used if column in held and column not in known)
        found.append(EquationBlock(tuple(sorted(row for loop in group for row in system.rows[loop])), unknown))
        known.update(unknown)
    return tuple(found)
