"""What is special about the loops of a linkage, found while the frames of its joints are numbers: see `Form`."""

from __future__ import annotations

from collections.abc import Sequence

import jax
import numpy as np

from jaxkin._traced import traced
from jaxkin.joints.joint import Joint
from jaxkin.linkage.planes import plane_columns, turn_about_one_direction
from jaxkin.linkage.rods import idle_spins
from jaxkin.solve.system.loop_system import Form
from jaxkin.topology.structure import Structure


def loop_classes(joints: Sequence[Joint], structure: Structure) -> tuple[Form, ...] | None:
    """The class of each loop group; None where the frames are traced, or those of many mechanisms."""
    if not all(isinstance(joint.before, np.ndarray | jax.Array) for joint in joints):
        return None
    if traced(joints):  # by `grad` alone the numbers are there; of what is not traced `jit` would make a tracer
        joints = jax.lax.stop_gradient(tuple(joints))
    if any(traced(joint) or joint.before.ndim != 3 for joint in joints):
        return None
    row_of = structure.row_of
    fixed = row_of[structure.fixed[0]]
    bodies = {part: fixed if part in structure.fixed else row for part, row in row_of.items()}
    found = []
    for block in structure.blocks:
        inside = [joints[joint] for joint in block.joints]
        directed = tuple(
            number
            for number, loop in enumerate(block.loops)
            if turn_about_one_direction([joints[joint] for joint, _ in loop])
        )
        found.append(Form(plane_columns(inside), idle_spins(inside, bodies), directed, cut=True))
    return tuple(found)
