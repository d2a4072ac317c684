"""The pose of a MuJoCo model where the one that is written is beyond the ranges of its joints: that of a keyframe."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from jaxtyping import Float

from jaxkin._names import listed
from jaxkin.geometry.pose import Transform, rotation
from jaxkin.io.robot_model import RobotJoint, RobotModel, placed, quaternion
from jaxkin.io.robot_pose import posed
from jaxkin.joints.kinds import JointKind

HOME = "home"
"""Name that keyframes of the usual pose have by custom: it is preferred, in attached models behind their prefix."""

SLACK = 1e-9
"""Radians or metres by which the written pose may be beyond a range: rounding of degrees."""

FREE = 7
"""Numbers of a free joint in `qpos`: its place and its quaternion."""

BALL = 4
"""Numbers of a ball in `qpos`: its quaternion."""

JointStep = tuple[Transform, tuple[float, ...]]
"""Displacement of a joint, and of its coordinates, as `posed` has them."""


def keys_into_joints(root: Element) -> None:
    """Write what the keyframes of a model to attach say of each joint into its element: `<key name= qpos=>`.

    There it goes wherever the joint goes, as MuJoCo has it: a body that is attached without others brings the numbers
    of its own joints. Elements say their types, without classes. Keyframes of other lengths are left out.
    """
    joints = [joint for world in root.iterfind("worldbody") for joint in _in_order_of_qpos(world)]
    types = ["free" if each.tag == "freejoint" else each.get("type", "hinge") for each in joints]
    sizes = [{"free": FREE, "ball": BALL}.get(each, 1) for each in types]
    for key in root.iterfind("keyframe/key"):
        if (numbers := _numbers(key.get("qpos"), sum(sizes))) is not None:
            for joint, own in zip(joints, np.split(numbers, np.cumsum(sizes)[:-1]), strict=True):
                SubElement(joint, "key", name=key.get("name", ""), qpos=" ".join(map(repr, own.tolist())))


def _in_order_of_qpos(body: Element) -> Iterator[Element]:
    """Yield the joints of a body, those in its frames among them, then those of the bodies inside."""
    inside = [*_of_frames(body)]
    yield from (each for each in inside if each.tag in ("joint", "freejoint"))
    for each in inside:
        if each.tag == "body":
            yield from _in_order_of_qpos(each)


def _of_frames(body: Element) -> Iterator[Element]:
    for each in body:
        if each.tag == "frame":
            yield from _of_frames(each)
        else:
            yield each


def at_keyframe(
    model: RobotModel,
    root: Element,
    file: str,
    order: Sequence[str],
    tree: int,
    attached: Mapping[str, Mapping[str, str]],
) -> tuple[RobotModel, tuple[str, ...]]:
    """Move a model to a keyframe where the pose that is written is beyond limits; notes say so.

    `order` names the joints in the order of `qpos`, "" for a free one, whose body stays where it is written. The first
    `tree` joints of the model are its tree. `attached` are the keyframes of models that are attached: by name, the
    numbers of their joints. Several of these are taken where each moves joints of its own. Keyframes with other numbers
    than the model has coordinates are left out.
    """
    beyond = {each.name for each in model.joints if any(low > SLACK or high < -SLACK for low, high in each.limits)}
    written = root.findall("keyframe/key")
    if not beyond or not (written or attached):
        return model, ()
    what = f"{file}: the pose that is written is beyond the ranges of {listed(list(map(repr, sorted(beyond))))}"
    by_name = {each.name: each for each in model.joints}
    keys = [(key.get("name", ""), _whole(key, [by_name.get(name) for name in order])) for key in written]
    keys += [(name, _of_joints(numbers, by_name)) for name, numbers in attached.items()]
    steps: dict[str, JointStep] = {}
    taken = []
    for name, found in sorted(keys, key=lambda key: (key[0] != HOME, not key[0].endswith(HOME))):
        if (beyond & found.keys()) - steps.keys() and not found.keys() & steps.keys():
            steps |= found
            taken.append(f"<key name={name!r}>")
    if not taken:
        return model, (f"{what}, and no keyframe has the numbers of all joints",)
    return posed(model, steps, tree), (f"{what}: the assembled pose is that of {' and '.join(taken)}",)


def _whole(key: Element, joints: Sequence[RobotJoint | None]) -> dict[str, JointStep]:
    """Read the displacements of all joints of a keyframe; nothing where its numbers are not theirs."""
    sizes = [FREE if each is None else _size(each) for each in joints]
    numbers = _numbers(key.get("qpos"), sum(sizes))
    if numbers is None:
        return {}
    parts = np.split(numbers, np.cumsum(sizes)[:-1])
    return {each.name: _step(each, own) for each, own in zip(joints, parts, strict=True) if each is not None}


def _of_joints(numbers: Mapping[str, str], joints: Mapping[str, RobotJoint]) -> dict[str, JointStep]:
    """Read the displacements of the joints that a keyframe of an attached model names."""
    found = {}
    for name, said in numbers.items():
        if name in joints and (own := _numbers(said, _size(joints[name]))) is not None:
            found[name] = _step(joints[name], own)
    return found


def _size(joint: RobotJoint) -> int:
    return BALL if joint.kind is JointKind.SPHERICAL else 1


def _numbers(said: str | None, size: int) -> Float[np.ndarray, " numbers"] | None:
    """Read finite numbers; None for other texts, and for more or fewer of them."""
    try:
        numbers = np.array((said or "").split(), float)
    except ValueError:
        return None
    return numbers if len(numbers) == size and np.isfinite(numbers).all() else None


def _step(joint: RobotJoint, own: Float[np.ndarray, " numbers"]) -> JointStep:
    """Compute the displacement of a joint from its numbers in `qpos`."""
    if joint.kind is JointKind.SPHERICAL:
        return placed(quaternion(own, "qpos") if own.any() else np.eye(3), (0, 0, 0)), ()
    by = float(own[0]) - (joint.values[0] if joint.values else 0.0)
    z = np.array([0.0, 0.0, 1.0])
    turned = joint.kind is JointKind.REVOLUTE
    return (placed(rotation(z, by), (0, 0, 0)) if turned else placed(np.eye(3), by * z)), (by,)
