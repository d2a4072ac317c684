"""Loops that can be closed one after another.

A loop that brings as many new coordinates as it has equations follows from the loops before it, as a dyad does in a
planar linkage (an Assur group). The Jacobian is then block triangular, and three systems of three equations cost a
tenth of one of nine.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations
from typing import NamedTuple

from jaxkin.solve.system import CENTRE, LoopSystem

TOGETHER = 2
"""Loops that are tried as a block: what follows only from more of them at once is solved with all that is left."""


class Block(NamedTuple):
    """Equations, and the coordinates that they are solved for when those of the blocks before are known."""

    rows: tuple[int, ...]
    columns: tuple[int, ...]


@lru_cache(maxsize=256)
def blocks(system: LoopSystem) -> tuple[Block, ...]:
    """The blocks in an order in which they can be solved; all but the last have as many columns as rows."""
    rows, columns = _rows(system), _columns(system)
    left, known, found = list(range(len(system.loops))), set(), []

    def block(group: tuple[int, ...]) -> Block:
        unknown = set().union(*(columns[loop] for loop in group)) - known
        return Block(tuple(sorted(row for loop in group for row in rows[loop])), tuple(sorted(unknown)))

    while left:
        tried = (group for size in range(1, TOGETHER + 1) for group in combinations(left, size))
        group = next((group for group in tried if _is_square(block(group))), tuple(left))
        found.append(block(group))
        known.update(found[-1].columns)
        left = [loop for loop in left if loop not in group]
    return tuple(found)


def _is_square(block: Block) -> bool:
    return len(block.rows) == len(block.columns)


def _columns(system: LoopSystem) -> list[set[int]]:
    """The columns that each loop is solved for."""
    return [{column for joint, _ in loop for column in system.span(joint)} & set(system.used) for loop in system.loops]


def _rows(system: LoopSystem) -> list[list[int]]:
    """The equations of each loop, as in `Closure.residual`."""
    number = range(len(system.loops))
    if system.plane is not None:
        return [[*range(3 * loop, 3 * loop + 3)] for loop in number]
    whole = [loop for loop in number if system.cuts[loop] is None]
    rows = [[CENTRE * (len(whole) + loop) + i for i in range(CENTRE)] for loop in number]
    for place, loop in enumerate(whole):
        rows[loop] = [*range(3 * place, 3 * place + 3), *rows[loop]]
    return rows
