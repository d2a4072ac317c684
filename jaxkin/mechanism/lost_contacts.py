"""Lost contacts: faces that a joint was read from, and that are no longer on each other at some poses of a motion.

A joint keeps infinite surfaces in contact, as the paper's contacts do (assumption 4: they last). Faces end. Where the
faces of a contact are apart along the freedoms of their joint, the contact is lost there, and the joint is what it was
only if the contacts that are left amount to the same lower pair. Losses are judged by the extents of the faces, which
are cheap and contain the faces: each loss that is told is certain, and some losses are missed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.contacts.contact import Contact
from jaxkin.contacts.separation import FaceDisplacements, Gaps
from jaxkin.contacts.tolerance import default_length
from jaxkin.geometry.part import Face
from jaxkin.joints.combine import combine
from jaxkin.joints.file_noise import noise_of
from jaxkin.joints.joint import Joint
from jaxkin.joints.regularise import Noise, regularise
from jaxkin.joints.screws import displacements, inverses
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion


@dataclass(frozen=True, eq=False)
class LostContact:
    """A contact whose faces are apart at some poses."""

    joint: str
    """The joint that was read from the contact."""
    contact: Contact
    gaps: Float[np.ndarray, " poses"]
    """How far the faces are apart at least, in the unit of the mechanism; zero where they may be on each other, and at
    poses that are not closed."""
    loose: Bool[np.ndarray, " poses"]
    """Poses at which this and other contacts of the joint are lost, and those that are left do not make the joint."""
    left: str
    """The kind of joint to which the remaining contacts amount where the faces are farthest apart; empty if that is no
    lower pair."""

    @property
    def lost(self) -> Bool[np.ndarray, " poses"]:
        """Poses at which the faces are apart."""
        return self.gaps > 0

    @property
    def gap(self) -> float:
        """The largest of the gaps."""
        return float(self.gaps.max())


def lost_contacts(motion: Motion) -> tuple[LostContact, ...]:
    """Find the contacts that are lost at closed poses of a motion, in the order of the joints.

    None for mechanisms without solids, for joints by hand, and for contacts in states (i), (k), (l), (m), (o), (p) and
    a ball seated in a cone, whose faces are not followed.
    """
    mechanism = motion.mechanism
    if not mechanism.solids or not mechanism.contacts:
        return ()
    (closed,) = np.nonzero(np.asarray(motion.on_branch))
    setting = FaceSetting(mechanism)
    found: list[LostContact] = []
    for joint, values in zip(mechanism.all_joints, motion.displacements, strict=True):
        contacts = mechanism.contacts.get(joint.name, ())
        if contacts and joint.freedoms and len(closed):
            found += _of_joint(joint, contacts, displacements(joint, np.asarray(values, float)[closed]), setting)
    return tuple(_over_all_poses(each, closed, len(motion)) for each in found)


class FaceSetting:
    """The faces of a mechanism, its rigid bodies, and the length below which faces count as touching."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.body = body_of_parts(mechanism.bodies)
        """For each part the first part of its rigid body."""
        self.solids = mechanism.solids
        self.faces: dict[tuple[str, str], Face] = {}
        """By part and name."""
        for part in mechanism.solids:
            self.faces |= {(part.name, face.name): face for face in part.faces}
        # smaller gaps count as zero: what counts as touching in the assembled pose, and rounding of the corners
        self.length = default_length(mechanism.solids) + 2 * max(part.vertex_resolution for part in mechanism.solids)
        self._flush: dict[tuple[str, str], list[Face]] = {}

    def flush(self, part: str, name: str) -> list[Face]:
        """Find the other faces of the body of a part that continue the surface of one of its faces."""
        if (part, name) not in self._flush:
            face = self.faces[part, name]
            self._flush[part, name] = [
                other
                for (owner, _), other in self.faces.items()
                if self.body[owner] == self.body[part] and other is not face and _on_one(face, other, self.length)
            ]
        return self._flush[part, name]

    def continued(self, contact: Contact) -> list[tuple[Face, Face]]:
        """Pair the faces of both sides of a contact: the two in contact, and all faces that continue them."""
        one, two = ([self.faces[key], *self.flush(*key)] for key in zip(contact.parts, contact.faces, strict=True))
        return list(product(one, two))


def _on_one(face: Face, other: Face, length: float) -> bool:
    """Tell whether another face lies on the surface of a face, facing the same way, within a length."""
    if other.surface.kind != face.surface.kind:
        return False
    corners, middles = other.triangles.reshape(-1, 3), other.triangles.mean(axis=1)
    facing = np.sum(face.surface.normals(middles) * other.surface.normals(middles), axis=-1)
    return bool(np.abs(face.surface.distance(corners)).max() <= length and facing.min() > 0)


def _of_joint(
    joint: Joint, contacts: Sequence[Contact], moved: FaceDisplacements, setting: FaceSetting
) -> list[LostContact]:
    """Find the contacts of a joint that are lost, over the displacements of part 2 of the joint."""
    gaps = [gaps_of(joint, contact, moved, setting) for contact in contacts]
    gaps = [np.where(each > setting.length, each, 0.0) for each in gaps]
    lost = [k for k, each in enumerate(gaps) if each.any()]
    if not lost:
        return []
    noise = noise_of(setting.solids, contacts)
    which = np.zeros(moved.shape[2], int)  # numbers of the sets of contacts that are lost together
    for k in lost:
        which = np.unique(2 * which + (gaps[k] > 0), return_inverse=True)[1]
    _, firsts, which = np.unique(which, return_index=True, return_inverse=True)
    left = [_left([c for c, each in zip(contacts, gaps, strict=True) if not each[pose]], noise) for pose in firsts]
    loose = np.array(
        [kind != joint.kind and any(gaps[k][pose] for k in lost) for kind, pose in zip(left, firsts, strict=True)]
    )
    result = []
    for k in lost:
        apart = gaps[k] > 0
        mine = apart & loose[which]
        result.append(LostContact(joint.name, contacts[k], gaps[k], mine, left[which[np.argmax(gaps[k])]]))
    return result


def _left(contacts: Sequence[Contact], noise: Noise) -> str:
    """Find the kind of the joint that the remaining contacts amount to; empty if there is none."""
    pair = combine(regularise(contacts, noise).contacts, noise) if contacts else None
    return pair.kind if pair else ""


def moved_second(
    joint: Joint, contact: Contact, moved: FaceDisplacements, setting: FaceSetting
) -> FaceDisplacements | None:
    """Compute the displacements of face 2 of a contact relative to face 1, from those of part 2 of the joint.

    None where the contact is not between the two bodies of the joint.
    """
    sides = [setting.body[part] for part in contact.parts]
    ends = [setting.body[part] for part in joint.parts]
    if sides not in (ends, ends[::-1]) or ends[0] == ends[1]:
        return None
    return moved if sides == ends else inverses(moved)


def gaps_of(joint: Joint, contact: Contact, moved: FaceDisplacements, setting: FaceSetting) -> Gaps:
    """Measure how far the faces of a contact, and all that continue them, are apart.

    -inf where the contact state has no measure of a gap, or where the joint moves other bodies than those in contact.
    """
    of_faces = contact.contact_state.gaps
    relative = moved_second(joint, contact, moved, setting)
    if of_faces is None or relative is None:
        return np.full(moved.shape[2], -np.inf)
    side1, side2 = zip(contact.parts, contact.faces, strict=True)
    gaps = of_faces(setting.faces[side1], setting.faces[side2], relative)
    if not np.any(gaps > setting.length):
        return gaps
    for one, other in setting.continued(contact):
        (poses,) = np.nonzero(gaps > setting.length)
        if not len(poses):
            break
        gaps[poses] = np.minimum(gaps[poses], of_faces(one, other, relative[:, :, poses]))
    return gaps


def _over_all_poses(found: LostContact, closed: np.ndarray, poses: int) -> LostContact:
    """Spread a lost contact from the closed poses over all poses; its gap is zero at the others."""
    gaps, loose = np.zeros(poses), np.zeros(poses, bool)
    gaps[closed], loose[closed] = found.gaps, found.loose
    return replace(found, gaps=gaps, loose=loose)


def joined(pieces: Sequence[tuple[Sequence[LostContact], int]]) -> tuple[LostContact, ...]:
    """Join the lost contacts of consecutive pieces of a motion, each piece with its number of poses."""
    found: dict[tuple[str, tuple[str, str], tuple[str, str]], list[tuple[int, LostContact]]] = {}
    poses = 0
    for lost, count in pieces:
        for each in lost:
            found.setdefault((each.joint, each.contact.parts, each.contact.faces), []).append((poses, each))
        poses += count
    return tuple(_joined(same, poses) for same in found.values())


def _joined(same: Sequence[tuple[int, LostContact]], poses: int) -> LostContact:
    """Join what one contact is in pieces of a motion, each with the number of its first pose."""
    gaps, loose = np.zeros(poses), np.zeros(poses, bool)
    for first, each in same:
        gaps[first : first + len(each.gaps)], loose[first : first + len(each.loose)] = each.gaps, each.loose
    worst = max((each for _, each in same), key=lambda each: each.gap)
    return replace(worst, gaps=gaps, loose=loose)
