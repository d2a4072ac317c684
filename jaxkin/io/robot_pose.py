"""A robot in another pose than the zero of its file: its links and joints moved along the tree of the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from jaxkin.geometry.pose import Transform, inverse
from jaxkin.io.robot_model import RobotJoint, RobotModel, placed
from jaxkin.joints.kinds import JointKind


def posed(model: RobotModel, steps: Mapping[str, tuple[Transform, tuple[float, ...]]], tree: int) -> RobotModel:
    """Move the links of a robot by displacements of its joints.

    `steps` maps joints to the displacement (4, 4) of the second link in the frame of the joint, metres, and to that of
    its coordinates, none for a ball. The first `tree` joints of the model are its tree, those nearer to the ground
    first, and links without a joint of it stay; the others are loops, whose frames go along with their links and may
    come apart.
    """
    places = {link.name: np.eye(4) for link in model.links}
    for each in model.joints[:tree]:
        step = steps.get(each.name, (np.eye(4), ()))[0]
        places[each.parts[1]] = places[each.parts[0]] @ each.frame_1 @ step @ inverse(each.frame_1)
    links = tuple(replace(link, pose=places[link.name] @ link.pose) for link in model.links)
    joints = tuple(
        _moved(each, places, steps.get(each.name, (np.eye(4), ()))[1], number < tree)
        for number, each in enumerate(model.joints)
    )
    return replace(model, links=links, joints=joints)


def _moved(each: RobotJoint, places: Mapping[str, Transform], by: tuple[float, ...], in_tree: bool) -> RobotJoint:
    """Move a joint along with its links; a joint of the tree has the same frame on both links again."""
    second = places[each.parts[1]] @ each.frame_2
    first = second if in_tree else places[each.parts[0]] @ each.frame_1
    if each.kind is JointKind.SPHERICAL:  # the place of a ball is all that matters: its angles count from here
        first, second = (placed(np.eye(3), frame[:3, 3]) for frame in (first, second))
    limits = tuple((low - own, high - own) for (low, high), own in zip(each.limits, by, strict=False))
    values = each.values or (0.0,) * len(by)
    return replace(
        each,
        frame_1=first,
        frame_2=second,
        limits=limits if by else each.limits,
        values=tuple(value + own for value, own in zip(values, by, strict=True)) if by else each.values,
    )
