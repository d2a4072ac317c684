"""Joints from the contacts of solids: one a contact as in the paper, or one a pair of parts where that is exact."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from jaxkin._traced import traced
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.pose import Pose, Vector
from jaxkin.joints.combine import combine as combine_contacts
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.regularise import Noise, align, movements, regularise

UNCLEAR_MARGIN = 3e-4
"""Radians, or lengths per size of the assembly: what contacts forbid by less, they were perhaps meant to allow."""


@dataclass(frozen=True, eq=False)
class FoundJoints:
    """Joints, and how they came about."""

    joints: tuple[Joint, ...]
    contacts: Mapping[str, tuple[Contact, ...]]
    """Joint name -> the contacts that it stands for, as they were given."""
    angle: float
    """Largest correction of a direction for the noise of the file, radians."""
    length: float
    """Largest correction of the place of an axis or a centre for the noise of the file, in its unit."""
    notes: tuple[str, ...]
    """What a user should look at, in words."""


def joints_from_contacts(
    contacts: Sequence[Contact],
    parts: Sequence[str],
    combine: bool = True,
    noise: Noise | None = None,
    bodies: Mapping[str, str] | None = None,
    given: Sequence[Joint] = (),
) -> FoundJoints:
    """The joints between parts that touch, free of the noise of the file (`regularise`).

    With `combine`, all contacts of two bodies become the one lower pair that they amount to, if there is one, else
    those of two parts do; otherwise each becomes a joint, and several of one pair of parts close loops (Eq. 1).
    `bodies` gives for each part the first part of its body; by default every part is one.

    `parts` are the names of all parts in the order of the assembly. It orders the joints, their names, "ground-crank",
    and the parts of a joint; but part 1 of a contact joint of several frames is always the one with surface 1 of
    Table 1. Several joints of two parts carry the letter of their state: "ground-crank:a", "ground-crank:e",
    "ground-crank:a2". A joint of two bodies is named after the first of their parts that touch.

    The z axis of a joint points so that the last of its z, y, x components in the world that is not zero (beyond 1e-6)
    is positive: parallel axes have one sign. Origins lie at the centre of the contact: coordinates read as
    displacements from the modelled pose. Raises ValueError where a contact names a part that is not in `parts`.
    """
    order = {name: k for k, name in enumerate(parts)}
    noise = noise or Noise.of(contacts)
    regular = regularise(contacts, noise)
    found: list[tuple[Joint, list[int]]] = []
    notes: list[str] = []

    def lower_pair(pair: tuple[str, str], members: list[int]) -> bool:
        lower = combine_contacts([regular.contacts[k] for k in members], noise)
        if lower is None:
            return False
        name = "-".join(pair)
        found.append(
            (
                joint(name, pair, lower.kind, (lower.movement,), [lower.frame], evidence=_touching(contacts, members)),
                members,
            )
        )
        if lower.margin < UNCLEAR_MARGIN:
            states = ", ".join(f"({contacts[k].state})" for k in members)
            notes.append(
                f"joint {name!r} is {lower.kind}, but its contacts {states} forbid more by only {lower.margin:.1g} "
                "(radians, or lengths per size of the assembly): if they should agree, correct the model"
            )
        return True

    for pairs in _by_bodies(_by_parts(contacts, order), bodies if combine and bodies else {}, order):
        if len(pairs) > 1 and lower_pair(next(iter(pairs)), [k for members in pairs.values() for k in members]):
            name, *others = ("-".join(pair) for pair in pairs)
            notes.append(
                f"joint {name!r} holds the contacts of {', '.join(map(repr, others))} too: the same two bodies"
            )
            continue
        for pair, members in pairs.items():
            if combine and lower_pair(pair, members):
                continue
            name = "-".join(pair)
            if combine and len(members) > 1:
                notes.append(
                    f"the {len(members)} contacts of {name!r} are no single lower pair: each is a joint of its own"
                )
            found.extend(
                (_contact_joint(regular.contacts[k], label, pair), [k]) for k, label in _labels(name, members, contacts)
            )
    joints, angle, length = _aligned([*(joint for joint, _ in found), *given], noise)
    joints = (*map(_joint_forwards, joints[: len(found)]), *joints[len(found) :])
    sources = {joint.name: tuple(contacts[k] for k in members) for joint, members in found}
    return FoundJoints(joints, sources, max(angle, regular.angle), max(length, regular.length), tuple(notes))


Pairs = dict[tuple[str, str], list[int]]
"""Two parts in the order of the assembly -> the indices of their contacts."""


def _by_parts(contacts: Sequence[Contact], order: Mapping[str, int]) -> Pairs:
    pairs: Pairs = defaultdict(list)
    for k, contact in enumerate(contacts):
        for part in contact.parts:
            if part not in order:
                raise ValueError(f"a contact names the part {part!r}, but the parts are {', '.join(map(repr, order))}")
        first, second = sorted(contact.parts, key=order.__getitem__)
        pairs[first, second].append(k)
    return dict(sorted(pairs.items(), key=lambda item: (order[item[0][0]], order[item[0][1]])))


def _by_bodies(pairs: Pairs, bodies: Mapping[str, str], order: Mapping[str, int]) -> list[Pairs]:
    """The pairs of parts that are pairs of the same two bodies together, in the order of their first ones."""
    groups: dict[tuple[str, ...], Pairs] = defaultdict(dict)
    for pair, members in pairs.items():
        owners = sorted((bodies.get(part, part) for part in pair), key=order.__getitem__)
        groups[tuple(owners)][pair] = members
    return list(groups.values())


def _labels(name: str, members: Sequence[int], contacts: Sequence[Contact]) -> list[tuple[int, str]]:
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
    # one frame means a group of displacements: its inverse is the same joint, and either part may come first
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
    """The evidence of a joint that stands for some of the contacts."""
    states = ", ".join(f"({contacts[k].state})" for k in members)
    return Evidence(EvidenceKind.CONTACT, text=f"contact{'s' if len(members) > 1 else ''} {states}")


def _aligned(joints: Sequence[Joint], noise: Noise) -> tuple[tuple[Joint, ...], float, float]:
    """The joints aligned with each other: combining finds axes that belong to no single contact."""
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


def _joint_forwards(joint: Joint) -> Joint:
    """The joint with the z axes of its frames pointing forwards."""
    poses = np.array([forwards(pose) for pose in joint.frames_1])
    return replace(joint, frames_1=poses, frames_2=poses)


def forwards(pose: Pose) -> Pose:
    """The frame, turned by half a turn about x where its z axis points backwards."""
    return pose if _forward(pose[:3, 2]) else pose @ np.diag([1.0, -1.0, -1.0, 1.0])


def _forward(axis: Vector) -> bool:
    last = next(component for component in axis[::-1] if abs(component) > 1e-6)
    return bool(last > 0)
