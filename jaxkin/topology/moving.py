"""What driven joints can move: loops with a driven joint are solved, all other loops keep their shape."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from jaxkin.topology.structure import LoopGroup, Structure


@dataclass(frozen=True)
class Moving:
    """The loops and parts of a structure that some driven joints can move."""

    loop_groups: tuple[LoopGroup, ...]
    """The loop groups that have to be solved, in the order of `Structure.elements`."""
    parts: tuple[str, ...]
    """Parts that can leave their place: those of the loops to be solved, those below a driven joint, and all that hang
    on either."""


def moving(structure: Structure, driven: Collection[str]) -> Moving:
    """Find what the driven joints (by name) can move while all other joints outside of solved loops rest.

    A loop without a driven joint keeps its shape, even where its parts are carried along.
    """
    columns = {column for column, joint in enumerate(structure.joints) if joint in driven}
    remaining = iter(structure.loop_groups)
    loop_groups: list[LoopGroup] = []
    moved: set[str] = set()
    for element in structure.elements:
        if element.joint is not None:
            ends = {structure.row_of[part] for part in structure.joint_parts[structure.joints.index(element.joint)]}
            if element.joint in driven or ends & moved:
                moved.add(element.upper)
        solved = False
        if element.loops:
            loop_group = next(remaining)
            if solved := not columns.isdisjoint(loop_group.joints):
                loop_groups.append(loop_group)
        if solved or element.upper in moved:
            moved.update(element.parts if element.upper in moved else element.parts[1:])
    return Moving(tuple(loop_groups), tuple(part for part in structure.part_names if structure.row_of[part] in moved))
