"""Round parts with one hinge that are drawn to turn: shafts, wheels with teeth, what is on a motor, flanges, and lone
wheels.

A part that is round about its only hinge moves nothing else (`spinning`): a washer, a screw, a roller, the grip of a
crank. That is no freedom of use. It is one where the solids say what it turns for.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.exact_fits import has_play
from jaxkin.assembly.hinge_bores import pins_of
from jaxkin.assembly.inference.bores import NEAR_LENGTH
from jaxkin.assembly.inference.measured import Measured
from jaxkin.assembly.inference.meshing_wheels import outer_teeth
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.seats import useful_freedoms
from jaxkin.geometry.outline import widest_gap
from jaxkin.geometry.pose import Vector
from jaxkin.joints.evidence import Certainty, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

FEWEST_HOLES, MOST_HOLES = 3, 12
"""Holes of a flange for screws: those of ISO 9409 have four to ten."""
MAX_SCREW = 0.2
"""Radius of such holes over that of their circle, at most: flanges of ISO 9409 have 0.12 to 0.2, holes that make a
wheel lighter more."""
EVEN = 1.1
"""Widest angle between such holes over the mean one, at most."""


def with_turning(mechanism: Mechanism, measured: Measured, bearings: Collection[str]) -> Mechanism:
    """Take those parts out of the ones that only spin which are drawn to turn.

    Shafts with play between faces carry motion in or out, wheels with teeth mesh, a motor drives what is on its shaft,
    and a flange with a circle of empty holes for screws carries what is screwed on it, as that of a robot. Where
    nothing else is of use, the machine is there for its wheels: what is on a pin with play between faces, and ball
    bearings.
    """
    hinges = {part.name: _hinge(mechanism, part.name) for part in mechanism.linkage.spinning}
    turning = {part: hinge for part, hinge in hinges.items() if hinge is not None}
    meant = {part for part, hinge in turning.items() if _has_work(part, hinge, measured)}
    if not meant and not useful_freedoms(mechanism):
        meant = {part for part, hinge in turning.items() if part in bearings or _is_kept_with_play(hinge)}
    spinning = tuple(part for part in mechanism.linkage.spinning if part.name not in meant)
    if len(spinning) == len(mechanism.linkage.spinning):
        return mechanism
    return replace(mechanism, linkage=replace(mechanism.linkage, spinning=spinning))


def _hinge(mechanism: Mechanism, part: str) -> Joint | None:
    """Find the only joint of a part, where it is a hinge."""
    joints = [joint for joint in mechanism.all_joints if part in joint.parts]
    return joints[0] if len(joints) == 1 and joints[0].kind is JointKind.REVOLUTE else None


def _has_work(part: str, hinge: Joint, measured: Measured) -> bool:
    """Tell whether a part is a flange for screws or on the shaft of a motor, or with play a shaft or a wheel with
    teeth."""
    pose = np.asarray(hinge.frames_1, float)[0]
    if _is_flange(part, pose[:3, 3], pose[:3, 2], measured):
        return True
    if hinge.evidence is None:
        return False
    if hinge.evidence.kind is EvidenceKind.ENCLOSED:
        return any(each.part in hinge.parts for each in measured.motors)
    if not has_play(hinge.evidence):
        return False
    solid = next(each for each in measured.parts if each.name == part)
    is_shaft = _is_kept_with_play(hinge) and any(pin.part == part for pin in pins_of(hinge, measured.bores))
    return is_shaft or outer_teeth(solid, pose[:3, 3], pose[:3, 2]) is not None


def _is_kept_with_play(hinge: Joint) -> bool:
    """Tell whether a hinge with play has faces on both sides that keep it."""
    doubt = hinge.evidence.doubt if hinge.evidence else None
    return has_play(hinge.evidence) and (doubt is None or doubt.seen is Certainty.NEAR_LIMIT)


def _is_flange(part: str, point: Vector, axis: Vector, measured: Measured) -> bool:
    """Tell whether the holes of a part beside an axis are one circle of equal ones, as for screws, around a journal of
    its own, on which it turns in another part.

    Discs of brakes have more holes, wheels wider ones, and sieves no journal. Screws that are drawn make it one body
    with others.
    """
    inner = [pair.one for pair in measured.axes(None) if pair.one.part == part and not pair.virtual]
    holes = [each for each in measured.bores[part] if each.hole and np.linalg.norm(np.cross(each.axis, axis)) < ACROSS]
    offsets = np.array([each.point - point for each in holes]).reshape(-1, 3)
    offsets -= np.outer(offsets @ axis, axis)
    away, radii = np.linalg.norm(offsets, axis=1), np.array([each.radius for each in holes])
    beside = away > radii
    away, radii, offsets = away[beside], radii[beside], offsets[beside]
    journals = [
        each for each in inner if np.linalg.norm(np.cross(each.point - point, axis)) <= NEAR_LENGTH * each.radius
    ]
    if not FEWEST_HOLES <= len(away) <= MOST_HOLES or not any(each.radius < away.min() for each in journals):
        return False
    side = offsets[0] / away[0]
    gap = widest_gap(np.arctan2(offsets @ np.cross(axis, side), offsets @ side))
    alike = np.ptp(away) <= NEAR_LENGTH * away.max() and np.ptp(radii) <= NEAR_LENGTH * radii.max()
    return bool(alike and radii.max() <= MAX_SCREW * away.min() and gap <= EVEN * 2 * np.pi / len(away))
