"""Joints as FreeCAD's solver has them: a kind, and a marker on each of two parts, whose axes are z.

The joints are those of `jaxkin.io.marker_joints`, the other way round.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.geometry.pose import Transform
from jaxkin.io.asmt import MOTIONS, SIZES
from jaxkin.io.marker_joints import ANGLE, COORDINATES, KINDS
from jaxkin.io.robot_model import placed
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind

JOINT_OF = {kind: name for name, kind in KINDS.items()} | {
    JointKind.SCREW: "CylindricalJoint",  # beside which the thread is a tie
    JointKind.CONSTANT_ANGLE: ANGLE,
}
"""Kind of joint -> what ASMT calls it."""

ACROSS = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
"""Rotation whose z axis is the first axis of a universal joint, y."""

ALONG = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Rotation whose z axis is the second axis of a universal joint, x."""


class MarkedJoint(NamedTuple):
    """A joint of the file, but for the parts of its markers."""

    kind: str
    markers: tuple[Transform, Transform]
    sizes: tuple[tuple[str, float], ...] = ()


def is_known(joint: Joint, moved: Sequence[int]) -> bool:
    """Tell whether the format has a joint, with its limits, and with motors for the coordinates that are `moved`."""
    columns = COORDINATES.get(joint.kind, ())
    used = [*moved, *(number for number, ends in enumerate(joint.limits) if np.isfinite(ends).any())]
    driven = MOTIONS.values()
    return joint.kind in JOINT_OF and all(k < len(columns) and columns[k] in driven for k in used)


def marked(joint: Joint) -> MarkedJoint:
    """Find the markers of a joint that the format has, and the angle that it keeps."""
    kind, frames = JOINT_OF[joint.kind], np.asarray(joint.frames_1, float)
    if joint.kind is JointKind.UNIVERSAL:
        across, along = (frames[0] @ placed(turn, np.zeros(3)) for turn in (ACROSS, ALONG))
        return MarkedJoint(kind, (across, along))
    if joint.kind is JointKind.CONSTANT_ANGLE:
        one, other = frames[:, :3, 2]
        angle = float(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other))
        return MarkedJoint(kind, (frames[0], frames[1]), ((SIZES["angle"], angle),))
    return MarkedJoint(kind, (frames[0], frames[0]))
