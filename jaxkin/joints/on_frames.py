"""Joints written by a frame on each of their two parts, in the axes of those parts, as files of robots have them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from jaxkin._arguments import by_name, one_number
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import Transform, is_rigid
from jaxkin.joints.evidence import BY_HAND
from jaxkin.joints.joint import Joint, shifted
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.limits import GivenLimits, with_limits
from jaxkin.joints.pairs import universal
from jaxkin.joints.two_frames import two_frames

_OF_TWO_FRAMES = (
    JointKind.REVOLUTE,
    JointKind.PRISMATIC,
    JointKind.CYLINDRICAL,
    JointKind.PLANAR,
    JointKind.SPHERICAL,
    JointKind.SCREW,
    JointKind.RECTANGULAR,
    JointKind.CARTESIAN,
    JointKind.SCHOENFLIES,
    JointKind.FIXED,
)
MOVEMENT_OF = {
    kind: key for key, movement in MOVEMENTS.items() for kind in _OF_TWO_FRAMES if movement.subgroup_joint == kind
} | {JointKind.UNIVERSAL: universal("", "", "", point=(0, 0, 0), axis1=(0, 1, 0), axis2=(1, 0, 0)).movements[0]}
"""Kind of a joint that two frames define -> key of its movement."""


def joint_on_frames(
    name: str,
    part1: str,
    part2: str,
    *,
    kind: str,
    frame1: Any,
    frame2: Any,
    places: Mapping[str, Any] | None = None,
    pitch: float | int = 0.0,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a joint given by a frame on each of its parts, 4x4 poses in the axes of that part; z is its axis.

    `places` are the poses of the parts in the world; the origin of the world, where a part has none. Coordinates count
    from there: `limits`, which count from where the two frames agree, are moved. Frames may differ in what the joint
    forbids: then the mechanism is open in this pose, and `mechanism.close()` closes it. A universal joint has its axis
    on part 1 along z of `frame1`, and that on part 2 along z of `frame2`; these nowhere agree, so that its limits count
    from this pose.

    `kind` is "revolute", "prismatic", "cylindrical", "planar", "spherical", "universal", "screw", "rectangular",
    "cartesian", "schoenflies" or "fixed". `pitch` is the advance of a screw per turn, unit of the mechanism; its limits
    count whole turns, told by its advance. Raises ValueError for other kinds, for what is no rigid pose, for axes of a
    universal joint that are not perpendicular, for a screw without pitch, and for the pitch of what is no screw.
    """
    places = by_name(places or {}, f"joint {name!r}: places", "{'arm': np.eye(4)}")
    if not isinstance(kind, str) or kind not in MOVEMENT_OF:
        raise ValueError(f"joint {name!r}: there is no kind {kind!r} of two frames{nearest(str(kind), MOVEMENT_OF)}")
    world = [
        _rigid(name, f"the place of {part!r}", places.get(part, np.eye(4))) @ _rigid(name, label, given)
        for part, label, given in ((part1, "frame1", frame1), (part2, "frame2", frame2))
    ]
    turn = _pitch(name, kind, pitch)
    try:
        found = two_frames(JointKind(kind), *world, pitch=turn)
    except ValueError as error:
        raise ValueError(f"joint {name!r}: {error}") from None
    frames, movements = (found.frame_1[None], found.frame_2[None]), (MOVEMENT_OF[JointKind(kind)],)
    made = Joint(name, (part1, part2), JointKind(kind), movements, *frames, np.asarray(turn), BY_HAND)
    made = with_limits(made, limits)
    return shifted(made, np.array(found.values)) if made.limits and found.values else made


def _pitch(name: str, kind: str, given: Any) -> float:
    """Check the pitch of a joint: that of a screw is not zero, all others are; ValueError, also for traced ones."""
    if traced(given):
        raise ValueError(f"joint {name!r}: the pitch is traced; make the joint outside of jit, vmap and grad")
    found = float(one_number(given, f"joint {name!r}: pitch", "a finite number, the advance per turn"))
    if found and kind != JointKind.SCREW:
        raise ValueError(f"joint {name!r}: only a screw has a pitch, got pitch={given!r} of kind {kind!r}")
    if not found and kind == JointKind.SCREW:
        raise ValueError(f"joint {name!r}: a screw needs its advance per turn, as pitch=2.0; without, it is a revolute")
    return found


def _rigid(name: str, what: str, given: Any) -> Transform:
    """Check a rigid 4x4 pose, which `what` names; ValueError for what is none, and for a traced one."""
    if traced(given):
        raise ValueError(f"joint {name!r}: {what} is traced; make the joint outside of jit, vmap and grad")
    try:
        pose = np.asarray(given, float)
    except (TypeError, ValueError):
        pose = np.zeros(0)
    if pose.shape != (4, 4) or not is_rigid(pose):
        raise ValueError(
            f"joint {name!r}: {what} must be a rigid 4x4 pose, its first three columns perpendicular unit vectors, "
            f"right-handed, its last row 0, 0, 0, 1; got {given!r}"
        )
    return pose
