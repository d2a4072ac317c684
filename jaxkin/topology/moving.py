"""What a drive can move at all: loops that hold a driven joint are solved, all others are carried along or rest."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from jaxkin.topology.structure import LoopGroup, Structure


@dataclass(frozen=True)
class Moving:
    """The share of a structure that some driven joints can move."""

    loop_groups: tuple[LoopGroup, ...]
    """Structure elements whose loops are to be solved, in the order of `elements`."""
    parts: tuple[str, ...]
    """Parts that can leave their place: those of these loops, and all that hang on them or below a driven joint."""


def moving(structure: Structure, driven: Collection[str]) -> Moving:
    """What the named joints can move, all other joints that are in no solved loop being at rest.

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
