"""The features by which the lengths of parts are measured: points, axes and planes, one for each joint of a part.

The feature of a joint on a part is what the movement there leaves in place: the centre of a ball, the axis of a hinge
or a pin, the plane of a plane on a plane. Between two successive frames of a contact joint lies a body without a name:
the round surface that rolls and slides. Its length is a radius.
"""

from __future__ import annotations

from itertools import combinations
from typing import Literal, NamedTuple

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage

JointSide = Literal["frames_1", "frames_2"]
DatumKind = Literal["point", "axis", "plane"]
Quantity = Literal["distance", "radius", "angle", "offset", "pitch"]
LengthName = tuple[str, ...]


class Feature(NamedTuple):
    """The point, axis or plane of a joint on one of its parts."""

    joint: int
    """Column of the joint in the mechanism."""
    side: JointSide
    frame: int
    """Index of the frame in the chain of the joint."""
    kind: DatumKind
    axis: int
    """Which axis of the frame is the axis, or the normal of the plane."""
    marked: bool
    """Whether the origin on the axis has a meaning: it does for a hinge, not for a pin that slides."""


class Length(NamedTuple):
    """A named quantity between two features of one body."""

    body: tuple[Feature, ...]
    """All features of the body that the two features belong to; none for the pitch of a screw."""
    first: int
    second: int
    """Indices of the two features in `body`; for a pitch both are the column of the joint."""
    quantity: Quantity


def part_features(linkage: Linkage) -> dict[str, tuple[Feature, ...]]:
    """Find the features of each row of the incidence matrix (all fixed parts are one), in the order of the joints."""
    row_of = linkage.structure.row_of
    found: dict[str, list[Feature]] = {row: [] for row in linkage.structure.parts}
    for column, joint in enumerate(linkage.joints):
        rows = [row_of[part] for part in joint.parts]
        if rows[0] == rows[1] or not joint.freedoms:
            continue
        found[rows[0]].append(_feature(column, joint, "frames_1", 0))
        found[rows[1]].append(_feature(column, joint, "frames_2", len(joint.movements) - 1))
    return {row: tuple(features) for row, features in found.items()}


def length_table(linkage: Linkage) -> dict[LengthName, Length]:
    """List all lengths of a mechanism by name, see `Mechanism.lengths`; only structure and movements are used."""
    table: dict[LengthName, Length] = {}
    names = [joint.name for joint in linkage.joints]
    for row, features in part_features(linkage).items():
        for i, j in combinations(range(len(features)), 2):
            one, two = features[i], features[j]
            table[row, names[one.joint], names[two.joint]] = Length(features, i, j, "distance")
            if "point" not in (one.kind, two.kind):
                table[row, names[one.joint], names[two.joint], "angle"] = Length(features, i, j, "angle")
            for a, b in ((i, j), (j, i)):
                if _has_offset(features[a], features[b]):
                    key = (row, names[features[a].joint], names[features[b].joint], "offset")
                    table[key] = Length(features, a, b, "offset")
    for column, joint in enumerate(linkage.joints):
        state = joint.contact_state
        for i, name in enumerate(state.lengths if state else ()):
            if name is None:
                continue
            body = (_feature(column, joint, "frames_2", i), _feature(column, joint, "frames_1", i + 1))
            quantity: Quantity = "distance" if name == "distance" else "radius"
            table[joint.name, name] = Length(body, 0, 1, quantity)
        if any(MOVEMENTS[name].has_pitch for name in joint.movements):
            table[joint.name, "pitch"] = Length((), column, column, "pitch")
    return table


def _feature(column: int, joint: Joint, side: JointSide, frame: int) -> Feature:
    """Find the feature of one frame of a joint; ValueError for a movement without one."""
    movement = MOVEMENTS[joint.movements[frame]]
    left = movement.feature
    if len(joint.movements) == 1 and movement.features_alone:
        left = movement.features_alone[0 if side == "frames_1" else 1]
    if left is None:
        raise ValueError(f"joint {joint.name!r} has the movement {joint.movements[frame]}, which leaves no feature")
    return Feature(column, side, frame, left.kind, left.axis, left.marked)


def _has_offset(along: Feature, of: Feature) -> bool:
    """Tell whether the place of a feature along an axis is a length: both have a meaningful origin."""
    return along.kind == "axis" and along.marked and (of.kind == "point" or (of.kind == "axis" and of.marked))
