"""Mates of CAD systems as displacement sets: two features of two parts keep their distance, or their angle.

A mate that keeps a distance, zero or not, is a contact state of the paper: a plane stands for a plane, a line for a
cylinder about it, a point for a ball, of radii that add up to the distance. One that keeps an angle is a Schoenflies
joint where directions stay parallel, else a joint of constant angle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from jaxkin.contacts.states import find_state
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import Transform, Vector, frame
from jaxkin.joints.combine import SUBGROUP_JOINTS, Chain
from jaxkin.joints.kinds import JointKind

FeatureKind = Literal["point", "line", "plane"]

COINCIDE = ("concentric", "coincident")
"""Mates, in small letters, that lay one of their features on the other."""
KEEP_DISTANCE = ("distance", "tangent")
"""Mates that keep the distance of their features, and with it that they are parallel."""
KEEP_ANGLE = ("parallel", "perpendicular", "angle")
"""Mates that keep the angle between their features only."""

_FEATURES: dict[str, FeatureKind] = {
    "point": "point", "sphere": "point", "vertex": "point",
    "line": "line", "axis": "line", "edge": "line", "cylinder": "line", "cone": "line", "circle": "line",
    "plane": "plane",
}  # fmt: skip
"""What a mate holds of the geometry that exporters name: of a cylinder or a circle its axis, of a sphere its centre."""
_ROUND = ("cylinder", "cone", "sphere")

EXTREMUM = 1e-3
"""Radians from parallel within which an angle mate means 0 or 180 degrees: where mates are solved to a millionth, as in
published files, and for the cosine of the angle, as much is left of it there."""


@dataclass(frozen=True, eq=False)
class MateFeature:
    """A point, a line or a plane of a part, in world coordinates of the assembled pose."""

    kind: FeatureKind
    point: Vector
    axis: Vector
    """Unit vector along a line, or normal to a plane; of a point any."""
    circle: bool = False
    """Whether it is the axis of a circle, which lies in a plane, too."""
    surface: bool = False
    """Whether it is the axis of a round surface or its centre, on which what coincides with it need not lie."""
    cone: bool = False
    """Whether that surface is a cone, whose half-angle and apex exporters do not say."""

    @staticmethod
    def of(geometry: str, point: Vector, axis: Vector | None) -> MateFeature | None:
        """Make the feature of some geometry as exporters name it; None for a kind that is not known."""
        name = geometry.strip().lower()
        kind = _FEATURES.get(name)
        if kind is None or (axis is None and kind != "point"):
            return None
        along = np.array([0.0, 0.0, 1.0]) if axis is None else axis
        return MateFeature(kind, point, along, name == "circle", name in _ROUND, name == "cone")


class MateSet(NamedTuple):
    """The displacements that one mate allows."""

    chain: Chain
    kind: JointKind
    """The kind of joint that the mate is by itself."""
    swapped: bool = False
    """Whether the chain begins at the second part."""
    offset: float = 0.0
    """Distance by which features that are to coincide do not at the assembled pose."""
    tilt: float = 0.0
    """Angle by which features are not parallel, or not perpendicular, that are to be, radians."""


def mate(tag: str, one: MateFeature, other: MateFeature, angle: float, length: float) -> tuple[MateSet, ...]:
    """Find the displacements that a mate allows, by the name that exporters give to it; none if it is not understood.

    They are those that all sets of the result allow: one set, but for a point on a circle, which lies in a plane and on
    a cylinder.

    What is to coincide, to be parallel or perpendicular is taken to be, as it stands on the first of the two parts;
    distances and other angles are those of the assembled pose, but angles next to 0 and 180 degrees (`EXTREMUM`).
    Directions within `angle` (radians) are parallel; features nearer to each other than `length` coincide. None are
    found, too, for a distance between features that are not parallel, and for what touches a cone beside its axis.
    """
    tag = tag.lower()
    order: tuple[FeatureKind, ...] = ("plane", "line", "point")
    swapped = order.index(one.kind) > order.index(other.kind)
    first, second = (other, one) if swapped else (one, other)
    if tag in KEEP_ANGLE and "point" not in (one.kind, other.kind):
        return (_angle_kept(tag, first, second)._replace(swapped=swapped),)
    if tag not in COINCIDE + KEEP_DISTANCE:
        return ()
    if tag != "concentric" and (first.cone or second.cone):
        touching = _on_cone(tag, first, second, swapped, angle, length)
        return () if touching is None else (touching,)
    offset = tilt = 0.0
    if tag == "coincident" and first.circle and second.kind == "point" and _beside(first, second.point) > length:
        return _on_circle(first, second, swapped, angle, length)
    if tag in COINCIDE and not (tag == "coincident" and _on_round(first, second)):
        flat = tag == "coincident" and second.circle and (first.circle or first.kind == "plane")
        first = replace(first, kind="plane") if flat and first.circle else first
        laid, offset, tilt = _laid_on(first, replace(second, kind="plane") if flat else second)
        if flat and one.circle and other.circle:
            apart = float(np.linalg.norm(second.point - first.point))
            pin = Chain([_ALONE[JointKind.REVOLUTE]], frame(first.point, first.axis)[None])
            return (MateSet(pin, JointKind.REVOLUTE, swapped, apart, tilt),)
        second = laid
    found = _DISTANCES[first.kind, second.kind](first, second, angle, length)
    return () if found is None else (MateSet(found[0], found[1], swapped, offset, tilt),)


def _on_circle(
    circle: MateFeature, point: MateFeature, swapped: bool, angle: float, length: float
) -> tuple[MateSet, ...]:
    """Find the displacements of a point that stays on a circle: in its plane, and at a distance from its axis."""
    on = replace(point, point=_on_plane(circle, point.point))
    offset = float(np.linalg.norm(point.point - on.point))
    found = _plane_point(circle, on, angle, length), _line_point(circle, on, angle, length)
    return tuple(MateSet(chain, kind, swapped, offset) for chain, kind in filter(None, found))


def _on_cone(
    tag: str, first: MateFeature, second: MateFeature, swapped: bool, angle: float, length: float
) -> MateSet | None:
    """Find the displacements of what touches a cone all around: a cone, or a circle, turns about the axis, a ball or
    the apex about itself; a line on the axis slides there, too. None for what does not, as a point on the cone: it
    needs the half-angle."""
    laid, offset, tilt = _laid_on(first, second)
    meet, coincident = offset <= length and tilt <= angle, tag == "coincident"
    around = (first.cone or first.circle) and (second.cone or second.circle)
    kind = None
    if second.kind == "point":
        kind = JointKind.SPHERICAL if meet else None
    elif around:
        kind = JointKind.REVOLUTE if meet or coincident else None
    elif meet and coincident and first.kind == "line":
        kind = JointKind.CYLINDRICAL
    if kind is None:
        return None
    point = first.point if first.circle else laid.point
    return MateSet(Chain([_ALONE[kind]], frame(point, first.axis)[None]), kind, swapped, offset, tilt)


def _on_round(first: MateFeature, second: MateFeature) -> bool:
    """Check whether one of two features that coincide lies on a round surface, and so beside its axis."""
    round_one = first.surface != second.surface and not (first.circle or second.circle)
    return round_one and "plane" not in (first.kind, second.kind)


def _laid_on(first: MateFeature, second: MateFeature) -> tuple[MateFeature, float, float]:
    """Lay the second feature on the first one; with the distance and the angle (radians) by which it was not there.

    The first one is a plane, a line or a point, and has no fewer dimensions than the second one.
    """
    axis, sine = second.axis, 0.0
    if first.kind == second.kind != "point":
        sine = float(np.linalg.norm(np.cross(first.axis, axis)))
        axis = first.axis * (1.0 if first.axis @ axis >= 0.0 else -1.0)
    elif second.kind == "line":
        sine = abs(float(first.axis @ axis))
        axis = _across(first.axis, axis)
    point = {"plane": _on_plane(first, second.point), "line": second.point - _away(first, second.point)}.get(
        first.kind, first.point
    )
    offset = float(np.linalg.norm(second.point - point))
    return replace(second, point=point, axis=axis), offset, float(np.arcsin(min(1.0, sine)))


def _across(normal: Vector, axis: Vector) -> Vector:
    """Make a unit vector perpendicular to a normal, along an axis as far as that is possible."""
    along = axis - (axis @ normal) * normal
    length = float(np.linalg.norm(along))
    return along / length if length > 1e-6 else frame(np.zeros(3), normal)[:3, 0]


FoundJoint = tuple[Chain, JointKind] | None

_ALONE = {kind: movement for kind, movement in SUBGROUP_JOINTS.values()}
"""Kinds of subgroup joints -> their movements."""


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
        if _beside(one, other.point) <= length:
            return _state("e", first)
        return _state("f", first, second)
    across = np.cross(one.axis, other.axis)
    along = np.linalg.lstsq(np.stack([one.axis, -other.axis, across], axis=1), other.point - one.point, rcond=None)[0]
    between = frame(one.point + along[0] * one.axis, across / np.linalg.norm(across))
    return _state("g", first, between, second)


def _line_point(line: MateFeature, point: MateFeature, _: float, length: float) -> FoundJoint:
    on_line = _beside(line, point.point) <= length
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


def _angle_kept(tag: str, first: MateFeature, second: MateFeature) -> MateSet:
    """Find the displacements that keep an angle: all translations, and the turns about both axes (one if parallel).

    A line that is parallel to a plane is perpendicular to its normal. Of an angle that stands where its directions are
    parallel no other pose has the same cosine, so it keeps them parallel.
    """
    axis, tilt = second.axis, 0.0
    is_angle = tag == "angle"
    aligned = _parallel(first, second, EXTREMUM) if is_angle else (tag == "parallel") == (first.kind == second.kind)
    if aligned or not is_angle:
        sine = float(np.linalg.norm(np.cross(first.axis, axis)) if aligned else abs(first.axis @ axis))
        tilt = float(np.arcsin(min(1.0, sine)))
        axis = axis if aligned else _across(first.axis, axis)
    axis1, axis2 = frame(first.point, first.axis), frame(first.point, axis)
    if aligned:
        return MateSet(Chain([_ALONE[JointKind.SCHOENFLIES]], axis1[None]), JointKind.SCHOENFLIES, tilt=tilt)
    turns = [_ALONE[kind] for kind in (JointKind.SCHOENFLIES, JointKind.REVOLUTE)]
    return MateSet(Chain(turns, np.stack([axis1, axis2])), JointKind.CONSTANT_ANGLE, tilt=tilt)


def _state(letter: str, *frames: Transform, region: str | None = None) -> tuple[Chain, JointKind]:
    """Find the displacements of a contact state, and the kind of joint: that of a subgroup joint where there is one."""
    movements = find_state(letter, region).movements
    alone = MOVEMENTS[movements[0]].subgroup_joint if len(movements) == 1 else None
    return Chain(movements, np.stack(frames)), JointKind(alone) if alone else JointKind.of_state(letter)


def _parallel(one: MateFeature, other: MateFeature, angle: float) -> bool:
    return bool(np.linalg.norm(np.cross(one.axis, other.axis)) <= angle)


def _on_plane(plane: MateFeature, point: Vector) -> Vector:
    """Project a point onto a plane."""
    return point - float((point - plane.point) @ plane.axis) * plane.axis


def _beside(line: MateFeature, point: Vector) -> float:
    """Measure the distance of a point from a line."""
    return float(np.linalg.norm(_away(line, point)))


def _away(line: MateFeature, point: Vector) -> Vector:
    """Compute the offset of a point from a line."""
    offset = point - line.point
    return offset - (offset @ line.axis) * line.axis
