"""From a mechanism's structure elements to the loop systems of the solver."""

from __future__ import annotations

from jaxkin.motion.mechanism import Mechanism
from jaxkin.solve.sweep import Joints
from jaxkin.solve.system import Form, LoopSystem
from jaxkin.topology.structure import Block


def block_system(mechanism: Mechanism, block: Block, driven: tuple[tuple[int, int], ...], form: Form) -> LoopSystem:
    """The loops of a structure element; `driven` are (joint, coordinate), in any order.

    An element of planar `form` is solved in its plane, unless something is driven along the normal.
    """
    joints = [mechanism.all_joints[joint] for joint in block.joints]
    firsts, column = {}, 0
    for index, joint in zip(block.joints, joints, strict=True):
        firsts[index] = column
        column += joint.freedoms
    loops = tuple(tuple((block.joints.index(joint), sign) for joint, sign in loop) for loop in block.loops)
    columns = tuple(sorted(firsts[joint] + coordinate for joint, coordinate in driven))
    if form.plane is not None and not set(columns) <= set(form.plane):
        form = form._replace(plane=None)
    return LoopSystem(tuple(joint.movements for joint in joints), loops, columns, form)


def block_joints(mechanism: Mechanism, block: Block) -> Joints:
    """Frames and pitches of the block's joints."""
    joints = [mechanism.all_joints[joint] for joint in block.joints]
    return Joints(*(tuple(getattr(joint, leaf) for joint in joints) for leaf in Joints._fields))
