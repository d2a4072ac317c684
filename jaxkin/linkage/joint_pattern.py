"""Name single loops by the letters of their joints: planar dyad RRP, spherical dyad RRR, spatial loop RSSR.

R is a revolute, P a prismatic, H a helical, C a cylindrical, E a planar, U a universal and S a spherical pair, V a
constant velocity joint; other joints are the pairs that they are made of, in brackets.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.linkage.first_order import IN_SUBGROUP
from jaxkin.linkage.solve_order import Group
from jaxkin.topology.graph import Circuit

OF_ELEMENT = {"rotate": "R", "translate": "P", "screw": "H"}
"""Kind of an elementary motion -> letter of the joint that has this motion alone."""


def letter(movements: Sequence[str], coordinates: Collection[int]) -> str:
    """Return the letter of a joint of which only the given coordinates are free.

    A movement whose coordinates are all free has the letter of its joint. A movement with driven coordinates is
    named by its remaining elementary motions, leftmost factor first: a planar pair driven by its angle is (PP), and one
    driven by x is (PR), not C, since its two axes differ.
    """
    letters, first = "", 0
    for name in movements:
        movement = MOVEMENTS[name]
        moving = [element for element in movement.elements if first + element.coordinate in coordinates]
        own = movement.letter if len(moving) == len(movement.elements) else None
        letters += own or "".join(OF_ELEMENT[element.kind] for element in moving)
        first += len(movement.coordinates)
    return letters if len(letters) < 2 else f"({letters})"


def loop_name(group: Group, letters: Mapping[int, str], kind: str) -> str:
    """Name a group of one loop, `kind` ("planar", "spherical", "Schoenflies", "spatial") first.

    `letters` maps the number of a joint to its letter, for its unknown coordinates where it has any. A dyad connects
    two bodies whose displacements are known, and is named by its unknown joints alone; other loops are named by all
    joints.
    """
    (loop,) = group.loops
    is_dyad = kind in ("planar", "spherical") and len(group.unknowns) == group.rank == IN_SUBGROUP
    return f"{kind} {'dyad' if is_dyad else 'loop'} {_pattern(group, loop, letters, is_dyad)}"


def _pattern(group: Group, loop: Circuit, letters: Mapping[int, str], only_unknown: bool) -> str:
    """Join the letters of the joints in order of travel, known joints first: RSSR.

    The unknown joints begin behind a known one. Of the two directions of travel, the pattern is the one that is later
    in the alphabet, so that a dyad RRP is not called PRR as well.
    """
    joints = [joint for joint, _ in loop]
    begin = next((k for k in range(len(joints)) if joints[k] in group.joints and joints[k - 1] not in group.joints), 0)
    joints = [*joints[begin:], *joints[:begin]]
    unknown = [letters[joint] for joint in joints if joint in group.joints]
    known = [] if only_unknown else [letters[joint] for joint in joints if joint not in group.joints]
    return "".join([*known, *max(unknown, unknown[::-1])])
