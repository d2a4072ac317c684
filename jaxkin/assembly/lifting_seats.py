"""Valves drawn on their seats: a cone in a conical seat, in line with a guide, is a stop on one side and no fit."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.surfaces import Cone
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def lifting_seats(mechanism: Mechanism, fasteners: Collection[str]) -> dict[Contact, str]:
    """Find the contacts of cones in conical seats that a body can leave along a guide, each with a note on it.

    All that its two bodies have in contact are such cones and pins in holes on one axis, and all cones open the same
    way: nothing but what is above holds it down. Each of the two has another joint that would lift it. A countersunk
    screw is no valve: none of `fasteners` is.
    """
    owner = body_of_parts(mechanism.bodies)
    result: dict[Contact, str] = {}
    for joint in mechanism.all_joints:
        bodies = {owner[part] for part in joint.parts}
        others = [each for each in mechanism.all_joints if each is not joint and each.freedoms]
        driven = all(any(body in {owner[part] for part in each.parts} for each in others) for body in bodies)
        if driven and not {*joint.parts} & {*fasteners}:
            result |= _seats(joint, mechanism.contacts.get(joint.name, ()), owner)
    return result


def _seats(joint: Joint, contacts: Collection[Contact], owner: Mapping[str, str]) -> dict[Contact, str]:
    """Find the conical seats of two bodies that guide each other along their axis otherwise; none where one of them
    cannot leave these."""
    seats = [each for each in contacts if each.contact_state.is_fit and isinstance(each.surfaces[0], Cone)]
    by_contact = joint.evidence is not None and joint.evidence.kind is EvidenceKind.CONTACT
    guided = any(each.contact_state.is_pin for each in contacts)
    guided &= all(each.contact_state.is_pin or each in seats for each in contacts)
    if joint.kind is not JointKind.REVOLUTE or not (seats and by_contact and guided):
        return {}
    pose = np.asarray(joint.frames_1, float)[0]
    ways = {bool(_opening(each, owner[joint.parts[0]], owner) @ pose[:3, 2] > 0) for each in seats}
    return {each: _note(joint, each) for each in seats} if len(ways) == 1 else {}


def _opening(seat: Contact, body: str, owner: Mapping[str, str]) -> np.ndarray:
    """Find the direction in which a body leaves a seat: a plug towards its wide end, what is round it the other way."""
    plug, cone = next(
        (part, each)
        for part, each in zip(seat.parts, seat.surfaces, strict=True)
        if isinstance(each, Cone) and each.side > 0
    )
    return cone.axis if owner[plug] == body else -cone.axis


def _note(joint: Joint, seat: Contact) -> str:
    """Tell that a seat is left out, and the words that make it a fit again."""
    one, other = (f"{part} {face}" for part, face in zip(seat.parts, seat.faces, strict=True))
    pose = np.asarray(joint.frames_1, float)[0]
    point, axis = (np.round(each, 6).tolist() for each in (pose[:3, 3], pose[:3, 2]))
    first, second = joint.parts
    text = f"the conical seat {one} - {other} is taken for a stop on one side, which {first!r} and {second!r} leave "
    text += f"along their guide, since nothing could move with it as a fit; as ignore=[[{one!r}, {other!r}]] says; if "
    text += "it holds them, say "
    return text + f"joints=[jk.revolute({joint.name!r}, {first!r}, {second!r}, point={point}, axis={axis})]"
