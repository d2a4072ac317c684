"""Which formula the groups of a loop system have (static: decided by the joints and the class of the loops)."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from jaxkin.linkage.first_order import IN_SUBGROUP
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.equation_blocks import EquationBlock, blocks_of_groups
from jaxkin.solve.system.loop_system import LoopSystem


class GroupFormula(NamedTuple):
    """A group of one loop whose unknowns are given by a formula."""

    name: str
    """"planar dyad", "spherical triangle" or "rod"."""
    chain: int
    """Number of the chain of `ChainTables` that holds the unknowns."""
    other_chain: int | None
    """Number of the chain that is a rod to this one, from ball to ball; None where the loop is one chain."""
    rows: tuple[int, ...]
    """Rows of the chain that hold the unknowns, in order of travel."""
    columns: tuple[int, ...]
    """Their columns."""
    letters: str
    """R of a turn and P of a slide, in order of travel."""


@lru_cache(maxsize=256)
def group_formulas(system: LoopSystem) -> tuple[GroupFormula | str, ...]:
    """Find the formula of every group that has unknowns, in order of solution; or say in words why there is none."""
    blocks = zip(system.order, blocks_of_groups(system), strict=True)
    return tuple(_formula(system, loops, block) for loops, block in blocks if block.columns)


def why_not_all(system: LoopSystem) -> str | None:
    """Tell why the poses of a system are not computed by formulas alone; None where they are."""
    if not group_formulas(system):
        return "nothing is unknown"
    if len(system.driven) != 1:
        return "formulas follow a single input only"
    if system.turned_balls:
        return "a ball turns in a loop"
    if any(isinstance(found, str) for found in group_formulas(system)):
        return "not all loops that are solved with it have one"
    return None


def _formula(system: LoopSystem, loops: tuple[int, ...], block: EquationBlock) -> GroupFormula | str:
    """Find the formula of a group, given the numbers of its loops and couplings; or say why there is none."""
    if any(number >= len(system.loops) for number in loops):
        return "a coupling"
    loop, *others = loops
    if system.curves:
        return "a curve is travelled along"
    if others:
        return f"its {len(loops)} loops are solved together"
    if system.planar:
        return _of_chain(system, "planar dyad", loop, None, block, IN_SUBGROUP)
    if loop in system.sections.spherical:
        return _of_chain(system, "spherical triangle", loop, None, block, IN_SUBGROUP)
    if loop in system.sections.rod_length:
        first, second = chain_tables(system).rods
        other = int(second[list(first).index(loop)])
        held = set(chain_tables(system).column[:, loop])
        chains = (loop, other) if held.issuperset(block.columns) else (other, loop)
        return _of_chain(system, "rod", *chains, block, 1)
    return "a loop in space without a rod between two balls"


def _of_chain(
    system: LoopSystem, name: str, chain: int, other_chain: int | None, block: EquationBlock, unknowns: int
) -> GroupFormula | str:
    """Make the formula for the unknowns of a block, which one chain is to hold; or say in words why there is none."""
    if len(block.columns) != unknowns:
        return f"{len(block.columns)} unknowns, where the formula of the {name} is for {unknowns}"
    table = chain_tables(system)
    rows = [row for row in range(len(table.column)) if table.column[row, chain] in block.columns]
    if len(rows) > unknowns:
        return "a coordinate drives several turns"
    if len(rows) != unknowns or np.any(table.screw[rows, chain]):
        return f"the formula of the {name} is for turns and slides"
    letters = "".join("R" if table.turn[row, chain] else "P" for row in rows)
    if letters == "PPP":
        return "three slides in one plane"
    if np.any(table.ball[:, [each for each in (chain, other_chain) if each is not None]] < len(system.turned_balls)):
        return "a ball turns in the loop"
    columns = tuple(int(table.column[row, chain]) for row in rows)
    return GroupFormula(name, chain, other_chain, tuple(rows), columns, letters)
