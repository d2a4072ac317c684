"""Make the loop systems of the solver from the loop groups of a linkage."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import NamedTuple

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage
from jaxkin.linkage.loop_class import LoopClass, renumbered
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.topology.graph import Circuit
from jaxkin.topology.structure import LoopGroup

Columns = tuple[tuple[int, int], ...]
"""(joint, coordinate) of each column, numbered as in the linkage."""


class SolvedCoordinates(NamedTuple):
    """The coordinates of a loop group that are columns of its loop system, and those that rest."""

    columns: Columns
    movements: tuple[tuple[str, ...], ...]
    """For each joint of the loop group its movements, without translations along the normal of a planar group."""
    planar: bool
    """Whether all columns act in one plane."""
    at_rest: Columns
    """Coordinates along the normal of the plane, which rest and are no columns of the system."""


def solved_coordinates(
    linkage: Linkage, loop_group: LoopGroup, driven: Columns, loop_class: LoopClass
) -> SolvedCoordinates:
    """Select the coordinates of a loop group that are solved or driven; `driven` are (joint, coordinate).

    A planar loop group is solved in its plane, with all coordinates along the normal at rest, unless a coordinate along
    the normal is driven.
    """
    every = [(index, k) for index in loop_group.joints for k in range(linkage.joints[index].freedoms)]
    plane = {every[column] for column in loop_class.plane or ()}
    planar = loop_class.plane is not None and plane.issuperset(driven)
    if not planar:
        plane = set(every)
    movements = []
    for index in loop_group.joints:
        chain, first = [], 0
        for name in linkage.joints[index].movements:
            count = len(MOVEMENTS[name].coordinates)
            whole = plane.issuperset((index, first + k) for k in range(count))
            left = name if whole else MOVEMENTS[name].without_normal
            if left is None:
                raise ValueError(f"the movement {name} has no translation along the normal of a plane that could rest")
            chain.append(left)
            first += count
        movements.append(tuple(chain))
    inside, outside = ([place for place in every if (place in plane) == yes] for yes in (True, False))
    return SolvedCoordinates(tuple(inside), tuple(movements), planar, tuple(outside))


def group_system(
    linkage: Linkage,
    loop_group: LoopGroup,
    driven: Columns,
    loop_class: LoopClass,
    groups: Sequence[Sequence[Circuit]] = (),
) -> tuple[LoopSystem, Columns]:
    """Make the loop system of a loop group, and list its columns; `driven` are (joint, coordinate), in any order.

    `groups` are the sets of loops that are solved together, in order of solution, with joints numbered as in the
    linkage; by default all loops of the structure are solved together.
    """
    columns, movements, planar, _ = solved_coordinates(linkage, loop_group, driven, loop_class)
    circuits = tuple(loop for group in groups for loop in group) or loop_group.loops
    loop_class = renumbered(
        loop_class._replace(plane=tuple(range(len(columns))) if planar else None),
        loop_group.loops,
        circuits,
        linkage.solved_joints,
    )
    number = {joint: place for place, joint in enumerate(loop_group.joints)}
    loops = tuple(tuple((number[joint], sign) for joint, sign in loop) for loop in circuits)
    ends = [0, *accumulate(map(len, groups))]
    order = tuple(tuple(range(first, last)) for first, last in pairwise(ends))
    given = tuple(sorted(columns.index(place) for place in driven))
    return LoopSystem(movements, loops, given, loop_class, order), columns


def group_joints(joints: Sequence[Joint], loop_group: LoopGroup) -> Joints:
    """Select the frames and pitches of the joints of a loop group from all `joints` of the linkage."""
    inside = [joints[joint] for joint in loop_group.joints]
    return Joints(*(tuple(getattr(joint, leaf) for joint in inside) for leaf in Joints._fields))
