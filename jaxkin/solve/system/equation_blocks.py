"""Planar loops that can be closed one after another.

A loop that brings three new coordinates follows from the loops before it, as a dyad does in a linkage (an Assur group).
The Jacobian is then block triangular, and three systems of three equations cost a tenth of one of nine. In space to
count is not enough: there, equations that seem to fit are often redundant, and coordinates idle.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from jaxkin.solve.system.loop_system import IN_PLANE, LoopSystem


class Block(NamedTuple):
    """Equations, and the coordinates that they are solved for when those of the blocks before are known."""

    rows: tuple[int, ...]
    columns: tuple[int, ...]


@lru_cache(maxsize=256)
def blocks(system: LoopSystem) -> tuple[Block, ...]:
    """The blocks in an order in which they can be solved; the last holds all loops that follow from no others.

    Equations in which nothing is left to be solved for are in none.
    """
    if not system.planar:
        return (Block(tuple(range(system.equations)), system.used),) if system.used else ()
    held = [{column for joint, _ in loop for column in system.span(joint)} & set(system.used) for loop in system.loops]
    left, known, found = list(range(len(held))), set(), []
    while left:
        group = next(([loop] for loop in left if len(held[loop] - known) == IN_PLANE), left)
        rows = [IN_PLANE * loop + row for loop in group for row in range(IN_PLANE)]
        unknown = set().union(*(held[loop] for loop in group)) - known
        if unknown:
            found.append(Block(tuple(rows), tuple(sorted(unknown))))
        known |= unknown
        left = [loop for loop in left if loop not in group]
    return tuple(found)
