"""Joints along curves and over surfaces as studies write them.

These are the arguments of the functions in `jaxkin.joints.curve_joints` and `jaxkin.joints.surface_joints`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import Followed, Patch
from jaxkin.geometry.pose import Transform
from jaxkin.joints.curve_joints import FOLLOWERS
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind


def _curve(joint: Joint, number: int) -> Followed:
    curve = joint.curves[number]
    if curve is None:
        raise ValueError(f"movement {number} of joint {joint.name!r} has no curve")
    return curve


def axes_of(joint: Joint, number: int = 0) -> Transform:
    """Compute the axes in which the points of a curve or a surface are given, in the world as assembled."""
    curve = _curve(joint, number)
    if isinstance(curve, Patch):
        origin = np.eye(4)
        origin[:3, 3] = curve.place
        return np.asarray(joint.frames_1[number], float) @ origin
    x, y, angle = np.asarray(curve.place, float)
    cos, sin = np.cos(angle), np.sin(angle)
    place = np.array([[cos, -sin, 0.0, x], [sin, cos, 0.0, y], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    return np.asarray(joint.frames_1[number], float) @ place


def _closed(curve: Followed) -> bool | list[bool]:
    return list(curve.closed) if isinstance(curve, Patch) else curve.closed


def _follower(joint: Joint) -> str:
    knife, roller, flat = FOLLOWERS
    if MOVEMENTS[joint.movements[-1]].only_slides:
        return flat
    return roller if _beside(joint) else knife


def _radius(joint: Joint) -> float | None:
    """Find the radius of a ball or a roller; None for a point, and for other followers."""
    if isinstance(patch := _curve(joint, 0), Patch):
        return None if patch.height is None else abs(float(patch.height))
    return _beside(joint) if _follower(joint) == FOLLOWERS[1] else None


def _beside(joint: Joint) -> float:
    frames = np.asarray(joint.frames_1, float)
    return float(np.linalg.norm(frames[1, :3, 3] - frames[0, :3, 3]))


def _on_part2(joint: Joint) -> Transform:
    """Find the axes of the second profile, or the frame of the follower."""
    if joint.kind is JointKind.CURVE_ON_CURVE:
        return axes_of(joint, 1)
    return np.asarray(joint.frames_1, float)[-1]


def _direction2(joint: Joint) -> list[float] | None:
    if joint.kind is JointKind.CURVE_ON_CURVE:
        return axes_of(joint, 1)[:3, 0].tolist()
    return _on_part2(joint)[:3, 2].tolist() if _follower(joint) == FOLLOWERS[-1] else None


CURVE_ARGUMENTS: dict[str, Callable[[Joint, Transform], object]] = {
    "profile": lambda joint, _: np.asarray(_curve(joint, 0).points, float).tolist(),
    "surface": lambda joint, _: np.asarray(_curve(joint, 0).points, float).tolist(),
    "closed": lambda joint, _: _closed(_curve(joint, 0)),
    "follower": lambda joint, _: _follower(joint),
    "radius": lambda joint, _: _radius(joint),
    "point2": lambda joint, _: _on_part2(joint)[:3, 3].tolist(),
    "direction2": lambda joint, _: _direction2(joint),
    "profile2": lambda joint, _: np.asarray(_curve(joint, 1).points, float).tolist(),
    "closed2": lambda joint, _: _curve(joint, 1).closed,
    "contact": lambda _, pose: pose[:3, 3].tolist(),
}
"""Keyword argument -> what it was, from a joint and its first frame; None where it was not given."""
