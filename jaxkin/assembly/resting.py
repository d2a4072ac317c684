"""Bodies that only lie on another one, as a bearing block does on its base, and need not move there."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.guides import TILT
from jaxkin.assembly.inference.contact_faces import faces_of
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.walls import slot_normals
from jaxkin.assembly.seats import NEAR, locks_slide
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.outline import widest_gap
from jaxkin.geometry.part import Face, size
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Cylinder, Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import free
from jaxkin.mobility.mobility import moving_coordinates
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


OPEN = 1.0
"""Radians, at least, that the dwell of a cam leaves to what is not round of it: faces of discs go all round."""


def resting(mechanism: Mechanism) -> list[Inference]:
    """Find the bodies that faces hold to another one across one direction: they lie there, and nothing that is drawn
    keeps them in their place; but for those in a slot, and those that slide in a third one on which the other turns.

    So do bodies of several parts that are butted: each two of these meet on one plane, and together the faces leave a
    slide, and let the bodies be pulled apart. Nothing guides a slide that nothing opposite holds to it.
    """
    found = []
    owner = body_of_parts(mechanism.bodies)
    for joint in mechanism.all_joints:
        contacts = mechanism.contacts.get(joint.name, ())
        flat = joint.kind is JointKind.PLANAR or (joint.kind is JointKind.PRISMATIC and _is_butted(mechanism, joint))
        lies = flat and contacts and not _slides_in_a_slot(contacts)
        if lies and not locks_slide(mechanism, joint, owner):
            one, other = map(repr, joint.parts)
            text = f"{one} lies on {other}, with no screw drawn, and nothing else needs it to move there"
            found.append(Inference(joint.parts, Evidence(EvidenceKind.ENCLOSED, (), text)))
    return found


def _is_butted(mechanism: Mechanism, joint: Joint) -> bool:
    """Tell whether plane faces leave two bodies a slide, and let them be pulled apart across it, as those of bars on
    end and plates under them do.

    Each two parts meet on one plane: two planes of one part may be a guide that weight closes, as a vee is. Where two
    faces are flush with each other at both ends of the slide, an angle on the end of a bar, they are none.
    """
    contacts = mechanism.contacts.get(joint.name, ())
    pose, slack = np.asarray(joint.frames_1, float)[0], NEAR * size(mechanism.solids)
    first = next((parts for parts in mechanism.bodies.values() if joint.parts[0] in parts), ())
    planes = [each.surfaces[each.parts[0] not in first] for each in contacts]
    flat = [plane for plane in planes if isinstance(plane, Plane)]
    if not contacts or len(flat) < len(planes):
        return False
    normals = np.array([plane.normal for plane in flat])
    places = normals @ np.array([plane.point for plane in flat]).T
    across = normals @ pose[:3, :2]
    opposite = normals @ normals.T < -np.cos(ACROSS)
    between = bool((opposite & (abs(np.diagonal(places)[:, None] - places) > slack)).any())  # walls
    if between or widest_gap(np.arctan2(across[:, 1], across[:, 0])) < np.pi - TILT:
        return False
    solids = {part.name: part for part in mechanism.solids}
    return len({frozenset(each.parts) for each in contacts}) == len(contacts) or any(
        _is_flush(faces_of(each, solids), pose[:3, 2], slack) for each in contacts
    )


def _is_flush(faces: Sequence[Face], along: Vector, slack: float) -> bool:
    """Tell whether two faces begin and end in the same places along a direction."""
    ends = np.array([[some.min(), some.max()] for some in (face.triangles.reshape(-1, 3) @ along for face in faces)])
    return bool((np.ptp(ends, axis=0) <= slack).all())


def _slides_in_a_slot(contacts: Sequence[Contact]) -> bool:
    """Tell whether some part is between the walls of another one: where walls of two parts clamp it, as a bolt and what
    it is in do, it stays all the same."""
    pairs: dict[frozenset[str], list[Contact]] = {}
    for each in contacts:
        pairs.setdefault(frozenset(each.parts), []).append(each)
    return any(len(slot_normals(some, part)) for pair, some in pairs.items() for part in pair)


def lifted_off(mechanism: Mechanism) -> list[Joint]:
    """Make joints that leave bodies free of each other in place of contacts of followers on the dwells of their cams.

    Such a contact moves nothing where it is drawn, and nothing but weight or a spring keeps it closed: what seems to be
    locked by it is not what rests lock.
    """
    found = mechanism.contacts
    higher = [each for each in mechanism.all_joints if each.kind.startswith("contact ") and each.name in found]
    dwell = [each for each in higher if any(_is_dwell(mechanism, contact) for contact in found[each.name])]
    return [free(each.name, *each.parts, point=found[each.name][0].centre) for each in dwell]


def _is_dwell(mechanism: Mechanism, contact: Contact) -> bool:
    """Tell whether a contact is on a cylinder about an axis that its part turns on, which does not go all round."""
    owner, slack = body_of_parts(mechanism.bodies), NEAR * size(mechanism.solids)
    solids = {part.name: part for part in mechanism.solids}
    turning = [each for each in mechanism.all_joints if each.kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL)]
    for part, surface in zip(contact.parts, contact.surfaces, strict=True):
        if not isinstance(surface, Cylinder):
            continue
        own = [each for each in turning if owner[part] in {owner[name] for name in each.parts}]
        for pose in (np.asarray(each.frames_1, float)[0] for each in own):
            away = solids[part].triangles.reshape(-1, 3) - pose[:3, 3]
            x, y = (away @ pose[:3, :2]).T
            round_it = abs(np.hypot(x, y) - surface.radius) <= slack
            coaxial = np.linalg.norm(np.cross(surface.point - pose[:3, 3], pose[:3, 2])) <= slack
            parallel = np.linalg.norm(np.cross(surface.axis, pose[:3, 2])) < ACROSS
            if coaxial and parallel and widest_gap(np.arctan2(y[round_it], x[round_it])) > OPEN:
                return True
    return False


def leaves_all_moving(
    mechanism: Mechanism, other: Mechanism, held: Collection[Inference], *, but_slides: bool = False
) -> bool:
    """Tell whether all bodies that move on each other by a joint still do so in another mechanism, in the same
    coordinates, but for those that are held to each other there; with `but_slides` also but for slides of bodies that
    still turn on each other. Those that are one body then had nothing but empty bores in common."""
    owner = body_of_parts(other.bodies)
    gone = {frozenset(each.parts) for each in held}

    def seen(found: Mechanism, wanted: Callable[[Joint], bool]) -> set[tuple[frozenset[str], str]]:
        """Find which bodies of the other mechanism move on each other, by which coordinates; the three angles of a ball
        count as one, since how a motion shows in them depends on where they begin, and the spin of a rod in all."""
        moving, joints = moving_coordinates(found.linkage), filter(wanted, found.all_joints)
        balls = [joint for joint in found.all_joints if joint.kind is JointKind.SPHERICAL]
        moving |= {name for joint in balls for name in joint.full_names} & {*found.mobility().idle}
        return {
            (frozenset(owner[part] for part in joint.parts), "ball" if joint.kind is JointKind.SPHERICAL else name)
            for joint in joints
            for name in joint.coordinates
            if f"{joint.name}.{name}" in moving
        }

    def stays(joint: Joint) -> bool:
        empty = joint.evidence is not None and joint.evidence.kind is EvidenceKind.VIRTUAL_PIN
        return not empty and frozenset(joint.parts) not in gone

    left = seen(other, lambda _: True)
    gone_by = seen(mechanism, stays) - left
    return not gone_by or (but_slides and all(name == "z" and (pair, "phi") in left for pair, name in gone_by))


def leaves_bodies_moving(mechanism: Mechanism, other: Mechanism, held: Collection[Inference]) -> bool:
    """Tell whether all bodies that move on what is fixed still do so in another mechanism, by whichever coordinates,
    and those that move on each other by a joint still have its coordinates there, but for those that are held to each
    other.

    A body that lies on another one lets joints of third ones move that move by nothing else: the webs of a crank turn
    on each other where one of their bearings may be pushed about.
    """
    owner, gone = body_of_parts(other.bodies), {frozenset(each.parts) for each in held}
    moving = moving_coordinates(mechanism.linkage)
    left: dict[frozenset[str], set[str]] = {}
    for each in other.all_joints:
        left.setdefault(frozenset(owner[part] for part in each.parts), set()).update(each.coordinates)
    kept = (
        name in left.get(frozenset(owner[part] for part in each.parts), ())
        for each in mechanism.all_joints
        for name, full_name in zip(each.coordinates, each.full_names, strict=True)
        if full_name in moving and frozenset(each.parts) not in gone
    )
    return all(kept) and _still(other, owner) <= _still(mechanism, owner)


def _still(mechanism: Mechanism, owner: Mapping[str, str]) -> set[str]:
    """Find the bodies that nothing but idle motions moves on what is fixed, through joints that stay as they are."""
    moving = moving_coordinates(mechanism.linkage)
    locked = [each for each in mechanism.all_joints if not {*each.full_names} & moving]
    pairs = [{owner[part] for part in each.parts} for each in locked]
    still = {owner[part] for part in mechanism.fixed}
    while more := {body for pair in pairs if pair & still for body in pair - still}:
        still |= more
    return still
