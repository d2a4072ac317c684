"""What driven joints can move: loops with a driven or coupled joint are solved, all others keep their shape."""

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

    Couplings carry the motion on to the joints and loops that they tie. A loop without a driven joint keeps its shape,
    even where its parts are carried along.
    """
    columns = {column for column, joint in enumerate(structure.joints) if joint in driven}
    loop_groups = tuple(group for group in structure.loop_groups if not columns.isdisjoint(group.joints))
    solved = {joint for group in loop_groups for joint in group.joints}
    driving = set(driven) | {structure.joints[joint] for joint in solved}
    moved: set[str] = set()
    for element in structure.elements:
        if element.joint is not None:
            ends = {structure.row_of[part] for part in structure.joint_parts[structure.joints.index(element.joint)]}
            if element.joint in driving or ends & moved:
                moved.add(element.upper)
        in_motion = any(structure.loops[loop].joints[0].joint in solved for loop in element.loops)
        if in_motion or element.upper in moved:
            moved.update(element.parts if element.upper in moved else element.parts[1:])
    return Moving(loop_groups, tuple(part for part in structure.part_names if structure.row_of[part] in moved))
