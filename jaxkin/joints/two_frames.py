"""Joints given by a frame on each of their two parts: coordinates that count from where the parts are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from jaxkin.geometry.pose import Transform, inverse, rotation, unit
from jaxkin.geometry.trig import TURN
from jaxkin.joints.axis_frame import PERPENDICULAR
from jaxkin.joints.kinds import JointKind

Z = np.array([0.0, 0.0, 1.0])
"""The axis of joint frames."""
_IN_SPACE = (JointKind.CARTESIAN, JointKind.SCHOENFLIES)
"""Joints that slide along all three axes of their frame."""
_ACROSS = (JointKind.PLANAR, JointKind.RECTANGULAR, *_IN_SPACE)
"""Joints that slide along x and y of their frame."""


class TwoFrames(NamedTuple):
    """The frames of a joint on its two parts, with coordinates zero where the parts are."""

    frame_1: Transform
    frame_2: Transform
    values: tuple[float, ...]
    """What the frames as they were given make the coordinates there: angles in -pi to pi, that of a screw with whole
    turns; empty for a ball and a universal joint, of which only the point, or the axes, are given."""


def two_frames(kind: JointKind, first: Transform, second: Transform, pitch: float = 0.0) -> TwoFrames:
    """Move the frames of a joint along what it leaves free, until they differ only in what it forbids.

    `first` and `second` (4, 4) are the frames on part 1 and part 2, in world coordinates, where the parts are now; the
    axis of a joint is z, of a universal joint z on each part. Frames that agree in what the joint forbids coincide
    afterwards: the joint is closed. A screw of this `pitch`, its advance per turn, is closed at any advance, as nothing
    says where its thread begins. Raises ValueError for the axes of a universal joint that are not perpendicular.
    """
    if kind is JointKind.SPHERICAL:
        return TwoFrames(_at(first[:3, 3]), _at(second[:3, 3]), ())
    if kind is JointKind.UNIVERSAL:
        return TwoFrames(*_cross(first, second), ())
    between = inverse(first) @ second
    angle = float(np.arctan2(between[1, 0], between[0, 0]))
    x, y, advance = between[:3, 3].tolist()
    if kind in _ACROSS:
        first = first @ _at(np.array([x, y, advance if kind in _IN_SPACE else 0.0]))
    if kind is JointKind.SCREW and pitch:  # its advance tells the whole turns, which frames do not
        angle += TURN * round(advance / pitch - angle / TURN)
    turns = kind in (
        JointKind.REVOLUTE,
        JointKind.CYLINDRICAL,
        JointKind.PLANAR,
        JointKind.SCHOENFLIES,
        JointKind.SCREW,
    )
    slides = kind in (JointKind.PRISMATIC, JointKind.CYLINDRICAL, JointKind.SCREW)
    back = np.eye(4)
    back[:3, :3] = rotation(Z, -angle) if turns else np.eye(3)
    back[2, 3] = -advance if slides else 0.0
    values = {
        JointKind.REVOLUTE: (angle,),
        JointKind.PRISMATIC: (advance,),
        JointKind.CYLINDRICAL: (advance, angle),
        JointKind.PLANAR: (x, y, angle),
        JointKind.RECTANGULAR: (x, y),
        JointKind.CARTESIAN: (x, y, advance),
        JointKind.SCHOENFLIES: (x, y, advance, angle),
        JointKind.SCREW: (angle,),
    }
    return TwoFrames(first, second @ back, values.get(kind, ()))


def _at(point: np.ndarray) -> Transform:
    pose = np.eye(4)
    pose[:3, 3] = point
    return pose


def _cross(first: Transform, second: Transform) -> tuple[Transform, Transform]:
    """Make the frames of a universal joint: y along the axis on part 1, x along the axis on part 2."""
    y, x = first[:3, 2], second[:3, 2]
    if abs(float(x @ y)) > PERPENDICULAR:
        raise ValueError(f"the axes of a universal joint must be perpendicular, the cosine between them is {x @ y:.3g}")
    x = unit(x - (x @ y) * y)
    turn = np.stack([x, y, np.cross(x, y)], axis=1)
    one, other = first.copy(), second.copy()
    one[:3, :3] = other[:3, :3] = turn
    return one, other
