"""Joints from the contacts of solids: one a contact as in the paper, or one for two bodies where that is exact."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from jaxkin._traced import traced
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.pose import Transform, Vector
from jaxkin.joints.combine import combine as combine_contacts
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.regularise import Noise, align, movements, regularise

UNCLEAR_MARGIN = 3e-4
"""Margin of a lower pair (`SubgroupJoint.margin`: radians, or lengths per size of the assembly) below which its
contacts were perhaps meant to allow more: some hundred times the noise of single precision (`Noise.of`)."""


@dataclass(frozen=True, eq=False)
class FoundJoints:
    """The joints of an assembly, and the contacts that each stands for."""

    joints: tuple[Joint, ...]
    contacts: Mapping[str, tuple[Contact, ...]]
    """Joint name -> the contacts that it stands for, as they were given."""
    angle: float
    """Largest correction of a direction for the noise of the file, radians."""
    length: float
    """Largest correction of the place of an axis or a centre for the noise of the file, in its unit."""
    notes: tuple[str, ...]
    """What a user should look at, in words."""


PartPair = tuple[str, str]
"""Two parts by their names, in a definite order."""

ContactsOfPairs = dict[PartPair, list[int]]
"""For each two parts that touch, in the order of the assembly, the indices of their contacts."""


class _Contacts(NamedTuple):
    """All contacts of an assembly, as they were given and without the noise of the file."""

    given: Sequence[Contact]
    regular: Sequence[Contact]
    noise: Noise


class _FoundJoint(NamedTuple):
    """A joint, the indices of the contacts that it stands for, and notes about it."""

    joint: Joint
    members: Sequence[int]
    notes: tuple[str, ...] = ()


def joints_from_contacts(
    contacts: Sequence[Contact],
    parts: Sequence[str],
    combine: bool = True,
    noise: Noise | None = None,
    bodies: Mapping[str, str] | None = None,
    given: Sequence[Joint] = (),
) -> FoundJoints:
    """Make the joints between parts that touch, free of the noise of the file (`regularise`).

    With `combine`, all contacts of two bodies become the one lower pair that they are equivalent to. Where there is
    none, the contacts of each two parts become theirs; what is left becomes one joint a contact, and several joints of
    one pair of parts close loops (Eq. 1). Without `combine`, every contact becomes a joint.

    `parts` are the names of all parts in the order of the assembly; `bodies` maps each part to the first part of its
    body, by default every part to itself; `given` are joints by hand, with which the axes found are aligned.

    The order of `parts` determines the order of the joints, their names ("ground-crank") and which of the two parts is
    part 1; but part 1 of a contact joint with several frames is always the one with surface 1 of Table 1. Several
    joints of two parts carry the letter of their state: "ground-crank:a", "ground-crank:e", "ground-crank:a2". A joint
    of two bodies is named after the first of their parts that touch.

    The z axis of a joint points so that the last of its z, y, x components in the world that is not zero (beyond 1e-6)
    is positive: parallel axes have one sign. Origins lie at the centre of the contact: coordinates read as
    displacements from the modelled pose. Raises ValueError where a contact names a part that is not in `parts`.
    """
    order = {name: k for k, name in enumerate(parts)}
    noise = noise or Noise.of(contacts)
    regular = regularise(contacts, noise)
    known = _Contacts(contacts, regular.contacts, noise)
    pairs = _contacts_of_pairs(contacts, order)
    groups = _pairs_of_bodies(pairs, bodies if combine and bodies else {}, order)
    found = [each for group in groups for each in _joints_of_bodies(known, group, combine)]
    joints, angle, length = _align_joints([*(each.joint for each in found), *given], noise)
    joints = (*map(joint_forwards, joints[: len(found)]), *joints[len(found) :])
    return FoundJoints(
        joints,
        {each.joint.name: tuple(contacts[k] for k in each.members) for each in found},
        max(angle, regular.angle),
        max(length, regular.length),
        tuple(note for each in found for note in each.notes),
    )


def _contacts_of_pairs(contacts: Sequence[Contact], order: Mapping[str, int]) -> ContactsOfPairs:
    """Group the contacts by the two parts that touch; ValueError where a part is not in `order`."""
    pairs: ContactsOfPairs = defaultdict(list)
    for k, contact in enumerate(contacts):
        for part in contact.parts:
            if part not in order:
                raise ValueError(f"a contact names the part {part!r}, but the parts are {', '.join(map(repr, order))}")
        first, second = sorted(contact.parts, key=order.__getitem__)
        pairs[first, second].append(k)
    return dict(sorted(pairs.items(), key=lambda item: (order[item[0][0]], order[item[0][1]])))


def _pairs_of_bodies(
    pairs: ContactsOfPairs, bodies: Mapping[str, str], order: Mapping[str, int]
) -> list[ContactsOfPairs]:
    """Group the pairs of parts by the two bodies that the parts belong to, in the order of their first pairs."""
    groups: dict[tuple[str, ...], ContactsOfPairs] = defaultdict(dict)
    for pair, members in pairs.items():
        owners = sorted((bodies.get(part, part) for part in pair), key=order.__getitem__)
        groups[tuple(owners)][pair] = members
    return list(groups.values())


def _joints_of_bodies(contacts: _Contacts, pairs: ContactsOfPairs, combine: bool) -> list[_FoundJoint]:
    """Make the joints of two bodies: one lower pair for all their pairs of parts, else the joints of each pair."""
    if len(pairs) > 1:
        members = [k for each in pairs.values() for k in each]
        if (found := _combined(contacts, next(iter(pairs)), members)) is not None:
            name, *others = ("-".join(pair) for pair in pairs)
            note = f"joint {name!r} holds the contacts of {', '.join(map(repr, others))} too: the same two bodies"
            return [found._replace(notes=(*found.notes, note))]
    return [each for pair, members in pairs.items() for each in _joints_of_parts(contacts, pair, members, combine)]


def _joints_of_parts(contacts: _Contacts, pair: PartPair, members: Sequence[int], combine: bool) -> list[_FoundJoint]:
    """Make the joints of two parts: with `combine` their one lower pair if there is one, else one joint a contact."""
    if combine and (found := _combined(contacts, pair, members)) is not None:
        return [found]
    name = "-".join(pair)
    joints = [
        _FoundJoint(_contact_joint(contacts.regular[k], label, pair), [k])
        for k, label in _labels(name, members, contacts.given)
    ]
    if combine and len(members) > 1:
        note = f"the {len(members)} contacts of {name!r} are no single lower pair: each is a joint of its own"
        joints[0] = joints[0]._replace(notes=(note,))
    return joints


def _combined(contacts: _Contacts, pair: PartPair, members: Sequence[int]) -> _FoundJoint | None:
    """Combine contacts into the lower pair that they are equivalent to; None if there is none."""
    lower = combine_contacts([contacts.regular[k] for k in members], contacts.noise)
    if lower is None:
        return None
    name, evidence = "-".join(pair), _touching(contacts.given, members)
    found = joint(name, pair, lower.kind, (lower.movement,), [lower.frame], evidence=evidence)
    if lower.margin >= UNCLEAR_MARGIN:
        return _FoundJoint(found, members)
    states = ", ".join(f"({contacts.given[k].state})" for k in members)
    note = (
        f"joint {name!r} is {lower.kind}, but its contacts {states} forbid more by only {lower.margin:.1g} "
        "(radians, or lengths per size of the assembly): if they should agree, correct the model"
    )
    return _FoundJoint(found, members, (note,))


def _labels(name: str, members: Sequence[int], contacts: Sequence[Contact]) -> list[tuple[int, str]]:
    """Name the joints of single contacts of two parts: (index of the contact, name of the joint)."""
    if len(members) == 1:
        return [(members[0], name)]
    seen: dict[str, int] = defaultdict(int)
    labels = []
    for k in members:
        state = contacts[k].state
        seen[state] += 1
        labels.append((k, f"{name}:{state}{seen[state] if seen[state] > 1 else ''}"))
    return labels


def _contact_joint(contact: Contact, name: str, pair: tuple[str, str]) -> Joint:
    """Make the joint of one contact; with one frame its parts come in the order of the assembly."""
    # the displacements of a joint with one frame form a group, so that either part may come first
    parts = pair if len(contact.frames) == 1 else contact.parts
    return joint(
        name,
        parts,
        JointKind.of_state(contact.state),
        movements(contact),
        contact.frames,
        evidence=_touching([contact], [0]),
    )


def _touching(contacts: Sequence[Contact], members: Sequence[int]) -> Evidence:
    """Say what a joint is known from that stands for some of the contacts."""
    states = ", ".join(f"({contacts[k].state})" for k in members)
    return Evidence(EvidenceKind.CONTACT, text=states)


def _align_joints(joints: Sequence[Joint], noise: Noise) -> tuple[tuple[Joint, ...], float, float]:
    """Align the joints with each other; return them with the largest corrections of an angle and of a length.

    The contacts are aligned already, but a combined pair may have an axis that belongs to no single contact. Joints
    with traced frames, and with frames that differ on the two parts, stay as they are.
    """
    known = [joint for joint in joints if not traced(joint) and np.array_equal(joint.frames_1, joint.frames_2)]
    names = [movement for joint in known for movement in joint.movements]
    frames, angle, length = align(
        names, np.concatenate([joint.frames_1 for joint in known] or [np.empty((0, 4, 4))]), noise
    )
    rest = iter(frames)
    aligned = {}
    for each in known:
        poses = np.array([next(rest) for _ in each.movements])
        aligned[each.name] = replace(each, frames_1=poses, frames_2=poses)
    return tuple(aligned.get(each.name, each) for each in joints), angle, length


def joint_forwards(joint: Joint) -> Joint:
    """Turn the frames of a joint so that their z axes point forwards (`forwards`)."""
    poses = np.array([forwards(pose) for pose in joint.frames_1])
    return replace(joint, frames_1=poses, frames_2=poses)


def forwards(pose: Transform) -> Transform:
    """Turn a frame by half a turn about its x axis where its z axis points backwards.

    It points backwards where the last of its components x, y, z in the world that exceeds 1e-6 is negative.
    """
    return pose if _forward(pose[:3, 2]) else pose @ np.diag([1.0, -1.0, -1.0, 1.0])


def _forward(axis: Vector) -> bool:
    last = next(component for component in axis[::-1] if abs(component) > 1e-6)
    return bool(last > 0)
