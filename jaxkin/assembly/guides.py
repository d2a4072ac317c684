"""Guides: slides whose faces hold two bodies to each other from all sides, with room to travel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.contact_faces import faces_of
from jaxkin.geometry.outline import widest_gap
from jaxkin.geometry.part import Face
from jaxkin.geometry.triangles import double_areas
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

TILT = 1e-3
"""Radians by which normals may be off opposite directions: two cheeks leave a slide along them, and are no guide."""
ROOM = 2.0
"""Length of the longer faces over that of the shorter ones, along the slide, from which on a carriage travels on a
rail: those of catalogues have five and more, what is put over a lip and welded there one."""


def is_guide(mechanism: Mechanism, joint: Joint) -> bool:
    """Tell whether a slide between solids is that of a carriage on its rail.

    Its faces hold both bodies together whichever way one is pulled across the slide, and those of one body are longer
    than those of the other.
    """
    contacts = mechanism.contacts.get(joint.name, ())
    if joint.kind is not JointKind.PRISMATIC or not contacts:
        return False
    solids = {part.name: part for part in mechanism.solids}
    first = next(parts for parts in mechanism.bodies.values() if joint.parts[0] in parts)
    sides: tuple[list[Face], list[Face]] = ([], [])
    for contact in contacts:
        for part, face in zip(contact.parts, faces_of(contact, solids), strict=True):
            sides[part not in first].append(face)
    pose = np.asarray(joint.frames_1, float)[0]
    return _hold(sides[0], pose[:3, :2]) and _have_room(sides, pose[:3, 2])


def _hold(faces: list[Face], across: Float[np.ndarray, "3 2"]) -> bool:
    """Tell whether the normals of faces, seen along a slide, leave no half of all directions free."""
    corners = np.concatenate([face.triangles for face in faces])
    normals = double_areas(corners) @ across
    return widest_gap(np.arctan2(normals[:, 1], normals[:, 0])) < np.pi - TILT


def _have_room(sides: tuple[list[Face], list[Face]], along: Float[np.ndarray, " 3"]) -> bool:
    """Tell whether the faces of one side are longer along a slide than those of the other."""
    lengths = [np.ptp(np.concatenate([face.triangles.reshape(-1, 3) for face in faces]) @ along) for faces in sides]
    return bool(max(lengths) >= ROOM * min(lengths))


def has_free_slide(mechanism: Mechanism) -> bool:
    """Tell whether a slide that walls with play imply is an idle motion: a carriage whose screw is not coupled yet
    moves nothing else, but is not locked."""
    idle = {*mechanism.mobility().idle}
    return any(
        joint.kind is JointKind.PRISMATIC
        and joint.evidence is not None
        and joint.evidence.kind is EvidenceKind.CLEARANCE
        and {f"{joint.name}.{name}" for name in joint.coordinates} <= idle
        for joint in mechanism.all_joints
    )
