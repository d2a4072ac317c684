"""Make the loop systems of the solver from the loop groups of a linkage."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import NamedTuple

from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.partial_movement import remaining
from jaxkin.joints.joint import Joint
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.first_order import Columns
from jaxkin.linkage.linkage import Linkage
from jaxkin.linkage.loop_class import LoopClass, renumbered
from jaxkin.solve.system.joints import CouplingNumbers, Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.topology.graph import Circuit
from jaxkin.topology.structure import LoopGroup

SolvedTogether = tuple[Sequence[Circuit], Sequence[int]]
"""Loops, and numbers of couplings in the linkage, that are solved together."""


class SolvedCoordinates(NamedTuple):
    """The coordinates of a loop group that are columns of its loop system, and those that rest."""

    columns: Columns
    movements: tuple[tuple[str, ...], ...]
    """For each joint of the loop group its movements, without those that leave the plane of a planar group."""
    planar: bool
    """Whether all columns act in one plane."""
    at_rest: Columns
    """Coordinates that leave the plane, which rest and are no columns of the system."""


def solved_coordinates(
    linkage: Linkage, loop_group: LoopGroup, driven: Columns, loop_class: LoopClass
) -> SolvedCoordinates:
    """Select the coordinates of a loop group that are solved or driven.

    A loop group with a plane is solved in the plane, with all other coordinates at rest, unless one of these is driven
    or coupled.
    """
    every = [(index, k) for index in loop_group.joints for k in range(linkage.joints[index].freedoms)]
    kept, planar = set(every), False
    tied = [place for number in loop_group.couplings for place in coupled_places(linkage, number)]
    for columns in (loop_class.plane, loop_class.decoupled_plane):
        if columns is not None and loop_group.loops:
            plane = {every[column] for column in columns}
            if plane.issuperset([*driven, *tied]):
                kept, planar = plane, True
                break
    movements = []
    for index in loop_group.joints:
        chain, names = [], linkage.joints[index].movements
        for name, own in zip(names, coordinate_ranges(names), strict=True):
            left = remaining(name, [k for k, coordinate in enumerate(own) if (index, coordinate) in kept])
            if left is None:
                raise ValueError(f"no movement is left of the movement {name} where what leaves the plane rests")
            chain.append(left)
        movements.append(tuple(chain))
    inside, outside = ([place for place in every if (place in kept) == yes] for yes in (True, False))
    return SolvedCoordinates(tuple(inside), tuple(movements), planar, tuple(outside))


def group_system(
    linkage: Linkage,
    loop_group: LoopGroup,
    driven: Columns,
    loop_class: LoopClass,
    groups: Sequence[SolvedTogether] = (),
) -> tuple[LoopSystem, Columns]:
    """Make the loop system of a loop group, and list its columns; `driven` are (joint, coordinate), in any order.

    `groups` are the sets of loops and couplings that are solved together, in order of solution, with joints and
    couplings numbered as in the linkage; by default all loops of the loop group are solved together.
    """
    columns, movements, planar, _ = solved_coordinates(linkage, loop_group, driven, loop_class)
    circuits = tuple(loop for loops, _ in groups for loop in loops) or loop_group.loops
    if planar:
        loop_class = LoopClass(plane=tuple(range(len(columns))))
    else:
        loop_class = loop_class._replace(plane=None, decoupled_plane=None)
        loop_class = renumbered(loop_class, loop_group.loops, circuits, linkage.solved_joints)
    number = {joint: place for place, joint in enumerate(loop_group.joints)}
    loops = tuple(tuple((number[joint], sign) for joint, sign in loop) for loop in circuits)
    ends = [0, *accumulate(len(loops) for loops, _ in groups)]
    behind = {coupling: len(circuits) + place for place, coupling in enumerate(loop_group.couplings)}
    order = tuple(
        (*range(first, last), *(behind[coupling] for coupling in couplings))
        for (first, last), (_, couplings) in zip(pairwise(ends), groups, strict=True)
    )
    given = tuple(sorted(columns.index(place) for place in driven))
    tied = tuple(
        tuple(columns.index(place) for place in coupled_places(linkage, number)) for number in loop_group.couplings
    )
    return LoopSystem(movements, loops, given, loop_class, order, tied), columns


def coupled_places(linkage: Linkage, number: int) -> Columns:
    """List the coordinates that a coupling ties."""
    return tuple(coordinate(linkage, name) for name in linkage.couplings[number].coordinates)


def group_joints(linkage: Linkage, joints: Sequence[Joint], loop_group: LoopGroup) -> Joints:
    """Select the numbers of a loop group from all `joints` (given or ideal) and the couplings of the linkage."""
    inside = [joints[joint] for joint in loop_group.joints]
    couplings = [linkage.couplings[number] for number in loop_group.couplings]
    leaves = [tuple(getattr(joint, leaf) for joint in inside) for leaf in ("frames_1", "frames_2", "pitch")]
    numbers = tuple(CouplingNumbers(*(getattr(each, leaf) for leaf in CouplingNumbers._fields)) for each in couplings)
    return Joints(*leaves, couplings=numbers, curves=tuple(joint.curves for joint in inside))
