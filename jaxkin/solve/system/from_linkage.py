"""From a mechanism's structure elements to the loop systems of the solver."""

from __future__ import annotations

from collections.abc import Sequence

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage
from jaxkin.solve.range.solve_range import Joints
from jaxkin.solve.system.loop_system import Form, LoopSystem
from jaxkin.topology.structure import Block

RESTING = {"T_z": "I", "T_z_phi": "T_phi"}
"""What is left of a movement whose translation along z is one along the normal of the plane."""

Columns = tuple[tuple[int, int], ...]
"""(joint, coordinate) of each."""


def block_system(
    linkage: Linkage, block: Block, driven: tuple[tuple[int, int], ...], form: Form
) -> tuple[LoopSystem, Columns]:
    """The loops of a structure element, and its columns; `driven` are (joint, coordinate), in any order.

    An element of planar `form` is solved in its plane, unless something is driven along the normal: what would move
    along it rests, and has no columns.
    """
    every = [(index, k) for index in block.joints for k in range(linkage.joints[index].freedoms)]
    loops = tuple(tuple((block.joints.index(joint), sign) for joint, sign in loop) for loop in block.loops)
    plane = None if form.plane is None else {every[column] for column in form.plane}
    if plane is not None and not plane.issuperset(driven):
        plane = None
    columns, movements = [], []
    for index in block.joints:
        chain, first = [], 0
        for name in linkage.joints[index].movements:
            own = [(index, first + k) for k in range(len(MOVEMENTS[name].coordinates))]
            inside = own if plane is None else [column for column in own if column in plane]
            chain.append(name if inside == own else RESTING[name])
            columns += inside
            first += len(own)
        movements.append(tuple(chain))
    form = form._replace(plane=None if plane is None else tuple(range(len(columns))))
    given = tuple(sorted(columns.index(place) for place in driven))
    return LoopSystem(tuple(movements), loops, given, form), tuple(columns)


def block_joints(joints: Sequence[Joint], block: Block) -> Joints:
    """Frames and pitches of the block's joints, of all joints of the mechanism."""
    inside = [joints[joint] for joint in block.joints]
    return Joints(*(tuple(getattr(joint, leaf) for joint in inside) for leaf in Joints._fields))
