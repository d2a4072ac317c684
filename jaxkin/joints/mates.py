"""Mates of CAD systems as displacement sets: two features of two parts keep their distance, or their angle.

A mate that keeps a distance, zero or not, is a contact state of the paper: a plane stands for a plane, a line for a
cylinder about it, a point for a ball, of radii that add up to the distance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from jaxkin.contacts.states import find_state
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import Transform, Vector, frame
from jaxkin.joints.combine import LOWER_PAIRS, Chain
from jaxkin.joints.kinds import JointKind

FeatureKind = Literal["point", "line", "plane"]

KEEP_DISTANCE = ("concentric", "coincident", "distance", "tangent")
"""Mates, in small letters, that keep the distance of their features, and with it that they are parallel."""
KEEP_ANGLE = ("parallel", "perpendicular", "angle")
"""Mates that keep the angle between their features only."""

_FEATURES: dict[str, FeatureKind] = {
    "point": "point", "sphere": "point", "vertex": "point",
    "line": "line", "axis": "line", "edge": "line", "cylinder": "line", "cone": "line", "circle": "line",
    "plane": "plane",
}  # fmt: skip
"""What a mate holds of the geometry that exporters name: of a cylinder or a circle its axis, of a sphere its centre."""


@dataclass(frozen=True, eq=False)
class MateFeature:
    """A point, a line or a plane of a part, in world coordinates of the assembled pose."""

    kind: FeatureKind
    point: Vector
    axis: Vector
    """Unit vector along a line, or normal to a plane; of a point any."""
    circle: bool = False
    """Whether it is the axis of a circle, which lies in a plane, too."""

    @staticmethod
    def of(geometry: str, point: Vector, axis: Vector | None) -> MateFeature | None:
        """Make the feature of some geometry as exporters name it; None for a kind that is not known."""
        kind = _FEATURES.get(geometry.strip().lower())
        if kind is None or (axis is None and kind != "point"):
            return None
        circle = geometry.strip().lower() == "circle"
        return MateFeature(kind, point, np.array([0.0, 0.0, 1.0]) if axis is None else axis, circle)


class MateSet(NamedTuple):
    """The displacements that one mate allows."""

    chain: Chain
    kind: JointKind | None
    """The kind of joint that the mate is by itself; None where it is none."""
    swapped: bool = False
    """Whether the chain begins at the second part."""


def mate(tag: str, one: MateFeature, other: MateFeature, angle: float, length: float) -> MateSet | None:
    """Find the displacements that a mate allows, by the name that exporters give to it; None if it is not understood.

    The features keep what they have at the assembled pose. Directions within `angle` (radians) are parallel, or
    perpendicular; features nearer to each other than `length` coincide. None, too, where the features are not as such a
    mate has them: a line that is not parallel to its plane, a perpendicular mate that is not.
    """
    tag = tag.lower()
    if tag == "coincident" and (found := _circle_in_plane(one, other, angle, length)):
        return found
    if tag in KEEP_DISTANCE:
        order: tuple[FeatureKind, ...] = ("plane", "line", "point")
        swapped = order.index(one.kind) > order.index(other.kind)
        first, second = (other, one) if swapped else (one, other)
        found = _DISTANCES[first.kind, second.kind](first, second, angle, length)
        return None if found is None else MateSet(found[0], found[1], swapped)
    if tag in KEEP_ANGLE and "point" not in (one.kind, other.kind):
        return MateSet(_angle_kept(one, other, angle), None)
    return None


def _circle_in_plane(one: MateFeature, other: MateFeature, angle: float, length: float) -> MateSet | None:
    """Find the displacements of a circle on a circle, or in a plane; None for other features."""
    flat = [feature.circle or feature.kind == "plane" for feature in (one, other)]
    if not all(flat) or not (one.circle or other.circle) or not _parallel(one, other, angle):
        return None
    if not (one.circle and other.circle):
        return MateSet(*_state("a", frame(one.point, one.axis)))
    if np.linalg.norm(other.point - one.point) > length:
        return None
    return MateSet(Chain([_ALONE[JointKind.REVOLUTE]], frame(one.point, one.axis)[None]), JointKind.REVOLUTE)


FoundJoint = tuple[Chain, JointKind] | None

_ALONE = {kind: movement for kind, movement in LOWER_PAIRS.values()}
"""Kinds of lower pairs -> their movements."""


def _plane_plane(one: MateFeature, other: MateFeature, angle: float, _: float) -> FoundJoint:
    if not _parallel(one, other, angle):
        return None
    return _state("a", frame(one.point, one.axis))


def _plane_line(plane: MateFeature, line: MateFeature, angle: float, _: float) -> FoundJoint:
    if abs(float(plane.axis @ line.axis)) > angle:
        return None
    frames = frame(_on_plane(plane, line.point), plane.axis), frame(line.point, line.axis)
    return _state("b", *frames)


def _plane_point(plane: MateFeature, point: MateFeature, _angle: float, _length: float) -> FoundJoint:
    frames = frame(_on_plane(plane, point.point), plane.axis), frame(point.point, plane.axis)
    return _state("d", *frames)


def _line_line(one: MateFeature, other: MateFeature, angle: float, length: float) -> FoundJoint:
    first, second = frame(one.point, one.axis), frame(other.point, other.axis)
    if _parallel(one, other, angle):
        if np.linalg.norm(_away(one, other.point)) <= length:
            return _state("e", first)
        return _state("f", first, second)
    across = np.cross(one.axis, other.axis)
    along = np.linalg.lstsq(np.stack([one.axis, -other.axis, across], axis=1), other.point - one.point, rcond=None)[0]
    between = frame(one.point + along[0] * one.axis, across / np.linalg.norm(across))
    return _state("g", first, between, second)


def _line_point(line: MateFeature, point: MateFeature, _: float, length: float) -> FoundJoint:
    on_line = np.linalg.norm(_away(line, point.point)) <= length
    frames = frame(line.point, line.axis), frame(point.point, line.axis)
    return _state("j", *frames, region="circle" if on_line else None)


def _point_point(one: MateFeature, other: MateFeature, _: float, length: float) -> FoundJoint:
    offset = other.point - one.point
    if (apart := float(np.linalg.norm(offset))) <= length:
        return _state("o", frame(one.point, one.axis))
    frames = frame(one.point, offset / apart), frame(other.point, offset / apart)
    return _state("p", *frames)


_DISTANCES = {
    ("plane", "plane"): _plane_plane,
    ("plane", "line"): _plane_line,
    ("plane", "point"): _plane_point,
    ("line", "line"): _line_line,
    ("line", "point"): _line_point,
    ("point", "point"): _point_point,
}
"""Kinds of the two features, in this order -> their displacements where their distance stays."""


def _angle_kept(one: MateFeature, other: MateFeature, angle: float) -> Chain:
    """Find the displacements that keep an angle: all translations, and the turns about both axes (one if parallel)."""
    first, second = frame(one.point, one.axis), frame(one.point, other.axis)
    kinds, frames = [JointKind.PLANAR, JointKind.PRISMATIC], [first, first]
    if not _parallel(one, other, angle):
        kinds, frames = [*kinds, JointKind.REVOLUTE], [*frames, second]
    return Chain([_ALONE[kind] for kind in kinds], np.stack(frames))


def _state(letter: str, *frames: Transform, region: str | None = None) -> tuple[Chain, JointKind]:
    """Find the displacements of a contact state, and the kind of joint: that of a lower pair where there is one."""
    movements = find_state(letter, region).movements
    pair = MOVEMENTS[movements[0]].pair if len(movements) == 1 else None
    return Chain(movements, np.stack(frames)), JointKind(pair) if pair else JointKind.of_state(letter)


def _parallel(one: MateFeature, other: MateFeature, angle: float) -> bool:
    return bool(np.linalg.norm(np.cross(one.axis, other.axis)) <= angle)


def _on_plane(plane: MateFeature, point: Vector) -> Vector:
    """Project a point onto a plane."""
    return point - float((point - plane.point) @ plane.axis) * plane.axis


def _away(line: MateFeature, point: Vector) -> Vector:
    """Compute the offset of a point from a line."""
    offset = point - line.point
    return offset - (offset @ line.axis) * line.axis
