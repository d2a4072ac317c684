"""Replace frames and points of joints, on both of their parts or on one part only; those of profiles and surfaces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import jax.numpy as jnp
import numpy as np

from jaxkin._arguments import by_name, numbers
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.geometry.patches import Patch
from jaxkin.geometry.pose import RIGID_TOLERANCE, is_rigid
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.patch_contact import placed_patch
from jaxkin.joints.profiles import check_simple, placed_profile
from jaxkin.linkage.linkage import Linkage

FrameKey = str | tuple[str, str]
"""A joint, or a part and a joint: the frame of the joint on both of its parts, or on this one."""

_PROFILES = {("profile",): 0, ("profile2",): 1, ("surface",): 0}
"""How the keys of the profiles and of the surface of a joint end, and which of those that it has is meant."""


def with_frames(linkage: Linkage, frames: Mapping[Any, Any]) -> Linkage:
    """Replace the frames of some joints: see `Mechanism.with_frames`."""
    for place, pose in by_name(frames, "frames", "{'A': pose}").items():
        linkage = _placed(linkage, place, _pose(place, pose), lambda _, new: new)
    return linkage


def with_points(linkage: Linkage, points: Mapping[Any, Any]) -> Linkage:
    """Move some joints to given points: see `Mechanism.with_points`."""

    def moved(pose, point):
        xp = jnp if traced(pose, point) else np
        column = xp.concatenate([xp.asarray(point), xp.ones(1)])
        return xp.concatenate([xp.asarray(pose)[:, :3], column[:, None]], axis=1)

    for place, point in by_name(points, "points", "{'A': (x, y, z)}").items():
        if (found := find_profile(linkage, place)) is not None:
            linkage = _with_profile(linkage, place, *found, point)
            continue
        if not traced(point):
            given, expected = point, "three finite numbers (x, y, z)"
            point = numbers(given, f"the point of {place!r}", expected)
            if point.shape != (3,) or not np.all(np.isfinite(point)):
                raise ValueError(f"the point of {place!r} must be {expected}, got {given!r}")
        linkage = _placed(linkage, place, point, moved)
    return linkage


def find_profile(linkage: Linkage, place: object) -> tuple[int, int] | None:
    """Find the column of a joint and the number of its movement for a key (joint, "profile"), "profile2" or "surface".

    None for keys that name neither a profile nor a surface; ValueError for a joint without one.
    """
    names = linkage.structure.joints
    if not isinstance(place, tuple) or place[1:] not in _PROFILES or place[0] not in names or place[1] in names:
        return None
    joint = linkage.joints[names.index(place[0])]
    wanted, over = _PROFILES[place[1:]], place[1:] == ("surface",)
    having = [n for n, curve in enumerate(joint.curves) if curve is not None and isinstance(curve, Patch) == over]
    if wanted >= len(having):
        has = f"{len(having)} of them" if having else "none"
        raise ValueError(f"there is no {place[1]} of joint {joint.name!r} ({joint.kind}), which has {has}")
    return names.index(place[0]), having[wanted]


def _with_profile(linkage: Linkage, place: Any, column: int, number: int, points: Any) -> Linkage:
    """Replace the points of a profile, or of a surface, by as many others in the same axes.

    ValueError for points that make none.
    """
    joint = linkage.joints[column]
    curve = joint.curves[number]
    if curve is None:
        raise ValueError(f"movement {number} of joint {joint.name!r} has no profile")
    if np.shape(points) != np.shape(curve.points):
        raise ValueError(
            f"the points of {place!r} must be as many as before, of shape {np.shape(curve.points)}, got shape "
            f"{np.shape(points)}; another number of points is another joint, made anew"
        )
    if isinstance(curve, Patch):
        if not traced(points):
            points = np.asarray(placed_patch(joint.name, points, curve.closed).patch.points)
    elif not traced(points):
        checked = placed_profile(joint.name, place[1], points, np.zeros(3), curve.closed)
        if joint.kind is not JointKind.POINT_ON_CURVE:
            check_simple(joint.name, place[1], checked)
        points = np.asarray(checked.curve.points)
    changed = replace(curve, points=points)
    curves = tuple(changed if k == number else each for k, each in enumerate(joint.curves))
    joints = [replace(joint, curves=curves) if k == column else each for k, each in enumerate(linkage.joints)]
    return linkage.with_joints(joints)


def _placed(linkage: Linkage, place: FrameKey, given, change) -> Linkage:
    """Replace the frame at a place by `change(frame, given)`; ValueError where it is not clear which frame is meant."""
    column, side = locate(linkage, place)
    joint = linkage.joints[column]
    if side is None and len(joint.movements) > 1:
        choices = " or ".join(repr((part, joint.name)) for part in joint.parts)
        raise ValueError(
            f"joint {joint.name!r} ({joint.kind}) has {len(joint.movements)} frames: say on which part, as {choices}"
        )
    for each in ("frames_1", "frames_2") if side is None else (side,):
        poses = list(getattr(joint, each))
        end = 0 if each == "frames_1" else -1
        poses[end] = change(poses[end], given)
        stacked = (jnp if traced(poses) else np).stack(poses)
        joint = replace(joint, frames_1=stacked) if each == "frames_1" else replace(joint, frames_2=stacked)
    joints: list[Joint] = list(linkage.joints)
    joints[column] = joint
    return linkage.with_joints(joints)


def locate(linkage: Linkage, place: FrameKey) -> tuple[int, str | None]:
    """Find the column of a joint, and which copy of its frame is meant: None for both. ValueError for unknown names."""
    if not isinstance(place, str) and not (isinstance(place, tuple) and len(place) == 2):
        raise ValueError(f"a frame is named by its joint, 'A', or by (part, joint), ('crank', 'A'), got {place!r}")
    part, name = (None, place) if isinstance(place, str) else place
    names = linkage.structure.joints
    if name not in names:
        raise ValueError(f"there is no joint {name!r}{nearest(name, names)}")
    column = names.index(name)
    parts = linkage.joints[column].parts
    if part is None:
        return column, None
    if part not in parts:
        raise ValueError(f"joint {name!r} is between {parts[0]!r} and {parts[1]!r}, not on {part!r}")
    return column, "frames_1" if part == parts[0] else "frames_2"


def _pose(place: FrameKey, pose):
    """Check that numbers are a rigid 4x4 pose (ValueError); traced ones are not checked."""
    if traced(pose):
        return pose
    array = numbers(pose, f"the frame of {place!r}", "a 4x4 pose of finite numbers")
    if array.shape != (4, 4) or not np.all(np.isfinite(array)):
        raise ValueError(f"the frame of {place!r} must be a 4x4 pose of finite numbers, got shape {array.shape}")
    if not is_rigid(array):
        raise ValueError(
            f"the frame of {place!r} is no rigid pose: its first three columns must be a right-handed rotation "
            f"(orthonormal within {RIGID_TOLERANCE:g}), its last row 0, 0, 0, 1"
        )
    return array
