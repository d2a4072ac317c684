"""Joints between two markers, as FreeCAD's solver has them: a frame on each of two parts, and the name of the joint.

The equations of that solver are products of axes that vanish, so a joint also holds where its axes are opposite.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from jaxkin.geometry.inertial import NONE
from jaxkin.geometry.pose import Transform, unit
from jaxkin.io.robot_model import RobotJoint, RobotLink, along, placed
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.two_frames import two_frames

KINDS = {
    "FixedJoint": JointKind.FIXED, "RevoluteJoint": JointKind.REVOLUTE, "TranslationalJoint": JointKind.PRISMATIC,
    "CylindricalJoint": JointKind.CYLINDRICAL, "SphericalJoint": JointKind.SPHERICAL, "PlanarJoint": JointKind.PLANAR,
    "UniversalJoint": JointKind.UNIVERSAL, "ParallelAxesJoint": JointKind.SCHOENFLIES,
    "NoRotationJoint": JointKind.CARTESIAN,
}  # fmt: skip
"""Joints -> kind."""

COORDINATES = {
    JointKind.REVOLUTE: ("phi",),
    JointKind.PRISMATIC: ("z",),
    JointKind.SCREW: ("phi",),
    JointKind.CYLINDRICAL: ("z", "phi"),
    JointKind.PLANAR: ("x", "y", "phi"),
    JointKind.SCHOENFLIES: ("x", "y", "z", "phi"),
}
"""Kinds of joints whose coordinates motions and limits are of -> names of these."""

ANGLE, RIGHT_ANGLE = "AngleJoint", "PerpendicularJoint"
ANGLES = (ANGLE, RIGHT_ANGLE)
"""Joints that keep the angle between their two z axes."""

STRAIGHT = 1e-9
"""Radians from a multiple of half a turn up to which an angle keeps its axes parallel, FreeCAD's own."""

CHAINS = ("PointInLineJoint", "PointInPlaneJoint", "LineInPlaneJoint", "SphSphJoint", "CylSphJoint", "RevCylJoint",
          "RevRevJoint")  # fmt: skip
"""Joints that are several in turn, with parts without a solid between them."""

AT_ZERO = {
    "SphSphJoint": "SphericalJoint",
    "CylSphJoint": "PointInLineJoint",
    "RevCylJoint": "CylindricalJoint",
    "RevRevJoint": "RevoluteJoint",
}
"""Joints that keep a distance -> the joint that they are where the distance is zero."""

TURNABLE = ("SphericalJoint", "UniversalJoint", "PointInLineJoint", "PointInPlaneJoint", "LineInPlaneJoint",
            "SphSphJoint", "CylSphJoint", *ANGLES)  # fmt: skip
"""Joints whose axes are not parallel: an opposite axis is no case of its own."""

LOCKED = ("FixedJoint", "TranslationalJoint", "NoRotationJoint")
"""Joints that do not turn: each axis of the one marker may be opposite to that of the other."""

HALF_TURNS = tuple(np.diag([*signs, 1.0]) for signs in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)))
"""No turn, and half a turn about each axis: rotations whose axes are parallel or opposite."""


class Marker(NamedTuple):
    """A frame on a part, in world coordinates of the pose in the file."""

    link: str
    pose: Transform


class _Step(NamedTuple):
    """One joint of a chain, with its frames on the part before and on the part behind."""

    kind: JointKind
    before: Transform
    behind: Transform


@dataclass
class MarkerJoints:
    """The joints of one file."""

    file: str
    """Name of the file, for messages."""
    links: dict[str, RobotLink]
    """The parts of the file; those between the joints of a chain are added."""
    joints: dict[str, RobotJoint] = field(default_factory=dict)
    couplings: list[Coupling] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def add(self, kind: str, name: str, one: Marker, other: Marker, sizes: Mapping[str, float], text: str) -> None:
        """Add a joint of `KINDS`, `ANGLES` or `CHAINS`, with its distance, offset or angle in `sizes`.

        `text` is what the file calls the joint. Raises ValueError for the axes of a universal joint that are not
        perpendicular, and for a name that another joint has.
        """
        if name in self.joints:
            raise ValueError(f"{self.file}: {text}: another joint is called {name!r}; every joint needs its own name")
        if one.link == other.link:
            self.notes.append(f"{self.file}: {text} is between two markers of {one.link!r}; left out")
            return
        if kind in AT_ZERO and not sizes.get("distance", 0.0):
            kind = AT_ZERO[kind]
        first = one.pose @ placed(np.eye(3), (0.0, 0.0, sizes.get("offset", 0.0)))
        angle = sizes["angle"] if kind == ANGLE else np.pi / 2
        if kind == ANGLE and abs(np.sin(angle)) < STRAIGHT:  # parallel, or opposite: two equations, and not one
            kind, second = "ParallelAxesJoint", other.pose @ HALF_TURNS[int(np.cos(angle) < 0)]
        else:
            second = _nearest(kind, first, other.pose)
        if kind in ANGLES:
            self.joints[name] = _of_angle(name, (one.link, other.link), first, second, angle, text)
            return
        if kind in KINDS:
            steps: Sequence[_Step] = (_Step(KINDS[kind], first, second),)
        else:
            steps = _chain(kind, first, second, sizes.get("distance", 0.0))
        between = [f"{name}/{number}" for number in range(1, len(steps))]
        for link, step in zip(between, steps, strict=False):
            self.links[link] = RobotLink(link, step.behind, inertial=NONE)
        ends = (one.link, *between, other.link)
        for own, parts, step in zip((*between, name), pairwise(ends), steps, strict=True):
            try:
                frames = two_frames(step.kind, step.before, step.behind)
            except ValueError as error:
                raise ValueError(f"{self.file}: {text}: {error}") from None
            joint = RobotJoint(own, parts, step.kind, frames.frame_1, frames.frame_2, text, values=frames.values)
            self.joints[own] = joint

    def motor(self, name: str | None, coordinate: str | None, text: str) -> str | None:
        """Name the coordinate that a motion drives; None, and a note, where the joint has none such."""
        joint = self.joints.get(name or "")
        names = () if joint is None else COORDINATES.get(joint.kind, ())
        if joint is None or coordinate not in names:
            self.notes.append(f"{self.file}: {text} drives no coordinate of a joint that is read; left out")
            return None
        return joint.name if len(names) == 1 else f"{joint.name}.{coordinate}"

    def limit(self, name: str | None, coordinate: str | None, low: float, high: float, text: str) -> None:
        """Narrow the limits of a coordinate, as the file counts it; a limit of none is noted."""
        joint = self.joints.get(name or "")
        names = () if joint is None else COORDINATES.get(joint.kind, ())
        if joint is None or coordinate not in names:
            self.notes.append(f"{self.file}: {text} is of no coordinate of a joint that is read; left out")
            return
        limits = list(joint.limits or ((-np.inf, np.inf),) * len(names))
        number = names.index(coordinate)
        at = joint.values[number] if joint.values else 0.0
        limits[number] = (max(limits[number][0], low - at), min(limits[number][1], high - at))
        self.joints[joint.name] = replace(joint, limits=tuple(limits))


def _of_angle(
    name: str, parts: tuple[str, str], first: Transform, second: Transform, angle: float, text: str
) -> RobotJoint:
    """Make the joint that keeps the angle between the z axes of two frames: its slides and its turn about the axis of
    the first one are at the origin of the second one."""
    there = placed(first[:3, :3], second[:3, 3])
    turn = two_frames(JointKind.REVOLUTE, _tilted(there, second[:3, 2], angle), second)
    return RobotJoint(name, parts, JointKind.CONSTANT_ANGLE, there, there, text, turn=(turn.frame_1, turn.frame_2))


def _nearest(kind: str, first: Transform, second: Transform) -> Transform:
    """Turn the second marker by half a turn, where its axes are opposite to those of the first one."""
    if kind in TURNABLE:
        return second
    if kind in LOCKED:
        return second @ max(HALF_TURNS, key=lambda half: float(np.trace(first[:3, :3].T @ (second @ half)[:3, :3])))
    return second @ HALF_TURNS[1] if first[:3, 2] @ second[:3, 2] < 0 else second


def _chain(kind: str, first: Transform, second: Transform, distance: float) -> tuple[_Step, ...]:
    """List the joints that one joint is, from the first marker to the second."""
    point = second[:3, 3]
    there = placed(first[:3, :3], point)
    z = first[:3, 2]
    last = _Step(JointKind.SPHERICAL, second, second)
    match kind:
        case "PointInLineJoint":
            return _Step(JointKind.PRISMATIC, first, there), last
        case "PointInPlaneJoint":
            return _Step(JointKind.RECTANGULAR, first, there), last
        case "LineInPlaneJoint":
            flat = _tilted(second, z, np.pi / 2)
            return _Step(JointKind.PLANAR, first, flat), _Step(JointKind.REVOLUTE, second, second)
    away = point - first[:3, 3]
    if kind == "SphSphJoint":
        near = placed(np.eye(3), point - distance * _direction(away, z))
        return _Step(JointKind.SPHERICAL, first, near), last
    away = away - (away @ z) * z
    axis = placed(first[:3, :3], point - distance * _direction(away, first[:3, 0]))
    if kind == "CylSphJoint":
        return _Step(JointKind.CYLINDRICAL, first, axis), last
    if kind == "RevRevJoint":
        return _Step(JointKind.REVOLUTE, first, axis), _Step(JointKind.REVOLUTE, second, second)
    axis[:3, 3] += ((first[:3, 3] - point) @ z) * z
    beside = second.copy()
    beside[:3, 3] += ((first[:3, 3] - point) @ z) * z
    return _Step(JointKind.REVOLUTE, first, axis), _Step(JointKind.CYLINDRICAL, beside, second)


def _tilted(frame: Transform, z: np.ndarray, angle: float) -> Transform:
    """Make the frame at the same point whose z axis is at an angle to that of `frame`, as near to `z` as can be."""
    own = frame[:3, 2]
    across = _direction(z - (z @ own) * own, frame[:3, 0])
    return placed(along(np.cos(angle) * own + np.sin(angle) * across), frame[:3, 3])


def _direction(vector: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """Divide a vector by its length; `otherwise` for zero."""
    return unit(vector) if np.linalg.norm(vector) > 0.0 else otherwise
