"""The names of single loops by the letters of their joints: planar dyad RRP, spherical dyad RRR, spatial loop RSSR.

R is a revolute, P a prismatic, H a helical, C a cylindrical, E a planar, U a universal and S a spherical pair; other
joints are the pairs that they are made of, in brackets.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.linkage.first_order import IN_SUBGROUP
from jaxkin.linkage.solve_order import Group
from jaxkin.topology.graph import Circuit

OF_ELEMENT = {"rotate": "R", "translate": "P", "screw": "H"}
"""Kind of an elementary motion -> letter of the pair that has this motion alone."""


def letter(movements: Sequence[str], coordinates: Collection[int]) -> str:
    """The letter of a joint, of which only some coordinates move.

    A movement that is free as a whole has the letter of its lower pair. One of which a coordinate is driven is what its
    other elementary motions are, leftmost factor first: a planar pair driven by its angle is (PP), driven by x it is
    (PR), no C, whose axes are one.
    """
    letters, first = "", 0
    for name in movements:
        movement = MOVEMENTS[name]
        moving = [element for element in movement.elements if first + element.coordinate in coordinates]
        letter_of_pair = movement.letter if len(moving) == len(movement.elements) else None
        letters += letter_of_pair or "".join(OF_ELEMENT[element.kind] for element in moving)
        first += len(movement.coordinates)
    return letters if len(letters) < 2 else f"({letters})"


def loop_name(group: Group, letters: Mapping[int, str], kind: str) -> str:
    """The name of a group of one loop, `kind` ("planar", "spherical", "Schoenflies", "spatial") first.

    `letters` are those of the joints by number: of their unknown coordinates where they have any. A dyad hangs between
    bodies whose places are known, and is named by its unknown joints alone; other loops are named by all their joints.
    """
    (loop,) = group.loops
    is_dyad = kind in ("planar", "spherical") and len(group.unknowns) == group.rank == IN_SUBGROUP
    return f"{kind} {'dyad' if is_dyad else 'loop'} {_pattern(group, loop, letters, is_dyad)}"


def _pattern(group: Group, loop: Circuit, letters: Mapping[int, str], only_unknown: bool) -> str:
    """The letters in order of travel, from the first joint behind a known one on; of both ways round the later one in
    the alphabet, so that a dyad RRP is not called PRR as well. A loop begins with its known joint: RSSR."""
    joints = [joint for joint, _ in loop]
    begin = next((k for k in range(len(joints)) if joints[k] in group.joints and joints[k - 1] not in group.joints), 0)
    joints = [*joints[begin:], *joints[:begin]]
    unknown = [letters[joint] for joint in joints if joint in group.joints]
    known = [] if only_unknown else [letters[joint] for joint in joints if joint not in group.joints]
    return "".join([*known, *max(unknown, unknown[::-1])])
