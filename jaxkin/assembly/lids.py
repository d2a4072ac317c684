"""Lids that rest on their boxes, where a hinge lifts them off, and the panels of these, which are one body all the
same."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.inference.contact_faces import shared_span
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.resting import resting
from jaxkin.assembly.seats import NEAR
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import size
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def under_lids(mechanism: Mechanism) -> list[tuple[list[Inference], list[Inference]]]:
    """List what may be held of bodies that lie on others, with the rests that are not held then: all of them, all but
    the rests of lids, and all but those of one lid; nothing where there is no lid.

    A lid rests on its box, and is not glued to it, while its panels are glued to each other.
    """
    lying = resting(mechanism)
    found = _lids(mechanism, lying)
    if not found:
        return []
    every = [each for rests in found for each in rests]
    choices = [[], every, *(found if len(found) > 1 else [])]
    held = [[each for each in lying if each not in rests] for rests in choices]
    return [(some, rests) for some, rests in zip(held, choices, strict=True) if some]


def _lids(mechanism: Mechanism, lying: Sequence[Inference]) -> list[list[Inference]]:
    """Group those of the inferences of `resting` that are about lids: bodies that lie on others with faces that look
    one way and are all on one side of a hinge that they have with another body; those on no fixed part come first."""
    owner = body_of_parts(mechanism.bodies)
    on = {frozenset(owner[part] for part in each.parts): each for each in lying}
    hinges: dict[str, list[Joint]] = {}
    faces: dict[str, list[tuple[Vector, Contact]]] = {}
    for joint in mechanism.all_joints:
        pair = frozenset(owner[part] for part in joint.parts)
        if joint.kind is JointKind.REVOLUTE and pair not in on:
            for body in pair:
                hinges.setdefault(body, []).append(joint)
        for contact in mechanism.contacts.get(joint.name, ()) if pair in on else ():
            for part, surface in zip(contact.parts, contact.surfaces, strict=True):
                normal = surface.normal if isinstance(surface, Plane) else np.zeros(3)
                faces.setdefault(owner[part], []).append((normal, contact))
    fixed = {owner.get(part, part) for part in mechanism.fixed}
    found: list[tuple[bool, list[Inference]]] = []
    for body, some in faces.items():
        one_way = all(float(normal @ some[0][0]) > np.cos(ACROSS) for normal, _ in some)
        if body not in fixed and one_way and any(_opens(mechanism, each, some) for each in hinges.get(body, ())):
            rests = [each for pair, each in on.items() if body in pair]
            found.append((any(fixed & {owner[part] for part in each.parts} for each in rests), rests))
    return [rests for _, rests in sorted(found, key=lambda each: each[0])]


def _opens(mechanism: Mechanism, hinge: Joint, faces: Sequence[tuple[Vector, Contact]]) -> bool:
    """Tell whether faces that look one way, with their normals, are all on one side of the axis of a hinge, so that a
    turn lifts them off what they lie on."""
    pose = np.asarray(hinge.frames_1, float)[0]
    along = np.cross(pose[:3, 2], faces[0][0])
    slack = NEAR * size(mechanism.solids)
    solids = {part.name: part for part in mechanism.solids}
    ends = np.array([shared_span(contact, solids, along) for _, contact in faces]) - pose[:3, 3] @ along
    return bool(np.linalg.norm(along) > np.cos(ACROSS)) and bool(ends.min() >= -slack or ends.max() <= slack)
