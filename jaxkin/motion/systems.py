"""From a mechanism's structure elements to the loop systems of the solver."""

from __future__ import annotations

import jax.numpy as jnp

from jaxkin.motion.mechanism import Mechanism
from jaxkin.solve.sweep import Joints
from jaxkin.solve.system import LoopSystem
from jaxkin.topology.structure import Block


def block_system(mechanism: Mechanism, block: Block, driven: tuple[tuple[int, int], ...]) -> LoopSystem:
    """The loops of a structure element; `driven` are (joint, coordinate) in rising order of the block's columns."""
    joints = [mechanism.all_joints[joint] for joint in block.joints]
    firsts, column = {}, 0
    for index, joint in zip(block.joints, joints, strict=True):
        firsts[index] = column
        column += joint.freedoms
    loops = tuple(tuple((block.joints.index(joint), sign) for joint, sign in loop) for loop in block.loops)
    columns = tuple(firsts[joint] + coordinate for joint, coordinate in driven)
    return LoopSystem(tuple(joint.movements for joint in joints), loops, columns)


def block_joints(mechanism: Mechanism, block: Block, dtype) -> Joints:
    """Frames and pitches of the block's joints, on the device."""
    joints = [mechanism.all_joints[joint] for joint in block.joints]
    columns = [[jnp.asarray(getattr(joint, leaf), dtype) for joint in joints] for leaf in Joints._fields]
    return Joints(*map(tuple, columns))
