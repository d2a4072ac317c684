"""Divide the equations of a loop system into the blocks in which they are solved: one for each group of its order.

No block depends on an unknown of a later block, so the Jacobian is block lower triangular. To solve three systems of
three equations costs a tenth of solving one of nine.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from jaxkin.solve.system.loop_system import LoopSystem


class EquationBlock(NamedTuple):
    """Equations, and the unknowns that they are solved for once the unknowns of earlier blocks are known."""

    rows: tuple[int, ...]
    """Rows of the Jacobian, as `Closure.residual` has them."""
    columns: tuple[int, ...]
    """Columns of the Jacobian, rising."""


@lru_cache(maxsize=256)
def equation_blocks(system: LoopSystem) -> tuple[EquationBlock, ...]:
    """List the blocks of a system in order of solution, without blocks that have no unknowns left."""
    return tuple(block for block in blocks_of_groups(system) if block.columns)


def blocks_of_groups(system: LoopSystem) -> tuple[EquationBlock, ...]:
    """Make the block of each group of `LoopSystem.order`; its columns are empty if no unknown is left."""
    known: set[int] = set()
    found = []
    for group in system.order:
        held = set[int]().union(*(system.columns_of(number) for number in group))
        unknown = tuple(column for column in system.used if column in held and column not in known)
        found.append(EquationBlock(tuple(sorted(row for number in group for row in system.rows[number])), unknown))
        known.update(unknown)
    return tuple(found)
