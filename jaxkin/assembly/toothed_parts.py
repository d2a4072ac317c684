"""How bodies with teeth turn and slide against each other: the joints that carry wheels and racks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Points
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

PARALLEL_AXES = 1e-3
"""Largest sine of the angle between axes that count as parallel, and cosine of that between an axis and a slide that
count as perpendicular: ten times the radians to which contacts count directions as parallel by default."""
MODULE = 0.12
"""How far the module of a wheel, from its own radius and teeth, may be from that of the pair, from the distance of the
axes: profiles are shifted by up to half a module, which is 6 % of a wheel of 17 teeth."""


class Turn(NamedTuple):
    """A turn of a body against another one."""

    coordinate: str
    """Name "joint.coordinate"."""
    carrier: str
    """The other body."""
    point: Points
    axis: Points
    """Unit vector about which the body turns by the coordinate, against the carrier."""


class Slide(NamedTuple):
    """A slide of a body against another one."""

    coordinate: str
    """Name "joint.coordinate"."""
    carrier: str
    """The other body."""
    direction: Points
    """Unit vector along which the body slides by the coordinate, against the carrier."""


def turns_of(mechanism: Mechanism, body: Mapping[str, str]) -> dict[str, list[Turn]]:
    """List the turns of each body about the axes of its revolute and cylindrical joints."""
    found: dict[str, list[Turn]] = {}
    for joint in mechanism.all_joints:
        if joint.kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL):
            first, second = (body[part] for part in joint.parts)
            point, axis = _line(joint)
            name = f"{joint.name}.phi"
            found.setdefault(second, []).append(Turn(name, first, point, axis))
            found.setdefault(first, []).append(Turn(name, second, point, -axis))
    return found


def _line(joint: Joint) -> tuple[Points, Points]:
    """Find the axis of a joint: a point of it, and its direction."""
    pose = np.asarray(joint.frames_1, float)[0]
    return pose[:3, 3], pose[:3, 2]


def slides_of(mechanism: Mechanism, body: Mapping[str, str]) -> dict[str, list[Slide]]:
    """List the slides of each body along the axes of its prismatic and cylindrical joints."""
    found: dict[str, list[Slide]] = {}
    for joint in mechanism.all_joints:
        if joint.kind in (JointKind.PRISMATIC, JointKind.CYLINDRICAL):
            first, second = (body[part] for part in joint.parts)
            along = _line(joint)[1]
            found.setdefault(second, []).append(Slide(f"{joint.name}.z", first, along))
            found.setdefault(first, []).append(Slide(f"{joint.name}.z", second, -along))
    return found


def is_around(part: Part, turn: Turn) -> bool:
    """Tell whether an axis passes through the bounding box of a part, as that of a wheel does."""
    low, high = part.box[0] - turn.point, part.box[1] - turn.point
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.sort(np.stack([low, high]) / turn.axis, axis=0)
    within = np.where(turn.axis == 0, (low <= 0) & (high >= 0), True)
    ends = np.where(turn.axis == 0, [[-np.inf], [np.inf]], ends)
    return bool(np.all(within) and ends[0].max() <= ends[1].min())
