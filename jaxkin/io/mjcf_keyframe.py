"""The pose of a MuJoCo model where the one that is written is beyond the ranges of its joints: that of a keyframe."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import listed
from jaxkin.geometry.pose import Pose, rotation
from jaxkin.io.robot_model import RobotJoint, RobotModel, placed, quaternion
from jaxkin.io.robot_pose import posed
from jaxkin.joints.kinds import JointKind

HOME = "home"
"""Name that keyframes of the usual pose have by custom: it is preferred."""

SLACK = 1e-9
"""Radians or metres by which the written pose may be beyond a range: rounding of degrees."""

FREE = 7
"""Numbers of a free joint in `qpos`: its place and its quaternion."""


def at_keyframe(
    model: RobotModel, root: Element, file: str, order: Sequence[str], tree: int
) -> tuple[RobotModel, tuple[str, ...]]:
    """Move a model to a keyframe where the pose that is written is beyond limits; notes say so.

    `order` names the joints in the order of `qpos`, "" for a free one, whose body stays where it is written. The first
    `tree` joints of the model are its tree. Keyframes with other numbers than the model has coordinates are left out.
    """
    beyond = [each.name for each in model.joints if any(low > SLACK or high < -SLACK for low, high in each.limits)]
    keys = sorted(root.iterfind("keyframe/key"), key=lambda key: key.get("name") != HOME)
    if not beyond or not keys:
        return model, ()
    what = f"{file}: the pose that is written is beyond the ranges of {listed(list(map(repr, beyond)))}"
    by_name = {each.name: each for each in model.joints}
    for key in keys:
        steps = _steps(key, [by_name.get(name) for name in order])
        if steps is not None:
            note = f"{what}: the assembled pose is that of <key name={key.get('name', '')!r}>"
            return posed(model, steps, tree), (note,)
    return model, (f"{what}, and no keyframe has the numbers of all joints",)


def _steps(key: Element, joints: Sequence[RobotJoint | None]) -> dict[str, tuple[Pose, tuple[float, ...]]] | None:
    """Read the displacements of the joints of a keyframe; None where its numbers are not theirs."""
    try:
        numbers = np.array((key.get("qpos") or "").split(), float)
    except ValueError:
        return None
    sizes = [FREE if each is None else 4 if each.kind is JointKind.SPHERICAL else 1 for each in joints]
    if len(numbers) != sum(sizes) or not np.isfinite(numbers).all():
        return None
    found = {}
    for each, own in zip(joints, np.split(numbers, np.cumsum(sizes)[:-1]), strict=True):
        if each is None:
            continue
        if each.kind is JointKind.SPHERICAL:
            found[each.name] = placed(quaternion(own, "qpos") if own.any() else np.eye(3), (0, 0, 0)), ()
            continue
        by = float(own[0]) - (each.values[0] if each.values else 0.0)
        z = np.array([0.0, 0.0, 1.0])
        step = placed(rotation(z, by), (0, 0, 0)) if each.kind is JointKind.REVOLUTE else placed(np.eye(3), by * z)
        found[each.name] = step, (by,)
    return found
