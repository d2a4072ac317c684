"""Joint clearance as geometry: the centre of a pin or a ball that lies beside the centre of its hole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import jax.numpy as jnp
import numpy as np

from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.linkage import Linkage

ACROSS = {
    JointKind.REVOLUTE: (0, 1),
    JointKind.CYLINDRICAL: (0, 1),
    JointKind.SPHERICAL: (0, 1, 2),
}
"""Axes of the joint frame along which a pin has room in its hole, or a ball in its socket."""


def directions_of_play(linkage: Linkage, name: object) -> int:
    """Count the directions in which the pin of a joint has room; ValueError where the joint has no pin."""
    joints = {joint.name: joint for joint in linkage.joints}
    if name not in joints:
        raise ValueError(f"clearances: there is no joint {name!r}{nearest(str(name), joints)}")
    kind = joints[str(name)].kind
    if kind not in ACROSS:
        known = ", ".join(kind.value for kind in ACROSS)
        raise ValueError(f"clearances: joint {name!r} is {kind.value}, and clearance is known of {known} joints only")
    return len(ACROSS[kind])


def with_pins_moved(linkage: Linkage, offsets: Mapping[str, Any]) -> Linkage:
    """Move the pins of some joints in their holes: the frame on part 2, along its own axes x, y (and z of a ball).

    The axis stays parallel to that of the hole. An offset goes along with part 2.
    """

    def moved(joint: Joint) -> Joint:
        if joint.name not in offsets:
            return joint
        offset = offsets[joint.name]
        xp = jnp if traced(joint, offset) else np
        frame = xp.asarray(joint.frames_2[-1])
        shift = frame[:3, list(ACROSS[joint.kind])] @ xp.asarray(offset)
        column = xp.concatenate([frame[:3, 3] + shift, xp.ones(1)])
        frames = [*joint.frames_2[:-1], xp.concatenate([frame[:, :3], column[:, None]], axis=1)]
        return replace(joint, frames_2=xp.stack(frames))

    return linkage.with_joints([moved(joint) for joint in linkage.joints], [moved(joint) for joint in linkage.ideal])
