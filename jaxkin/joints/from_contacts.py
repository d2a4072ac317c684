"""Joints from the contacts of solids: one a contact as in the paper, or one a pair of parts where that is exact."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.pose import Pose, Vector
from jaxkin.joints.combine import combine as combine_contacts
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.regularise import Noise, align, movements, regularise

NEARLY = 3e-4
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
    contacts: Sequence[Contact], parts: Sequence[str], combine: bool = True, noise: Noise | None = None
) -> FoundJoints:
    """The joints between parts that touch, free of the noise of the file (`regularise`).

    With `combine`, all contacts of two parts become the one lower pair that they amount to, if there is one; otherwise
    each becomes a joint, and several of one pair of parts close loops (Eq. 1). `parts` are the names of all parts in
    the order of the assembly. It orders the joints, their names, "ground-crank", and the parts of a joint; but part 1
    of a contact joint of several frames is always the one with surface 1 of Table 1. Several joints of two parts carry
    the letter of their state: "ground-crank:a", "ground-crank:e", "ground-crank:a2".

    The z axis of a joint points so that the last of its z, y, x components in the world that is not zero (beyond 1e-6)
    is positive: parallel axes have one sign. Origins lie at the centre of the contact: coordinates read as
    displacements from the modelled pose. Raises ValueError where a contact names a part that is not in `parts`.
    """
    order = {name: k for k, name in enumerate(parts)}
    pairs: dict[tuple[str, str], list[int]] = defaultdict(list)
    for k, contact in enumerate(contacts):
        for part in contact.parts:
            if part not in order:
                raise ValueError(f"a contact names the part {part!r}, but the parts are {', '.join(map(repr, parts))}")
        first, second = sorted(contact.parts, key=order.__getitem__)
        pairs[first, second].append(k)
    noise = noise or Noise.of(contacts)
    regular = regularise(contacts, noise)
    found: list[tuple[Joint, list[int]]] = []
    notes = []
    for pair in sorted(pairs, key=lambda pair: (order[pair[0]], order[pair[1]])):
        name, members = "-".join(pair), pairs[pair]
        lower = combine_contacts([regular.contacts[k] for k in members], noise) if combine else None
        if lower is not None:
            found.append((joint(name, pair, lower.kind, (lower.movement,), [lower.frame]), members))
            if lower.margin < NEARLY:
                states = ", ".join(f"({contacts[k].state})" for k in members)
                notes.append(
                    f"joint {name!r} is {lower.kind}, but its contacts {states} forbid more by only {lower.margin:.1g} "
                    "(radians, or lengths per size of the assembly): if they should agree, correct the model"
                )
            continue
        if combine and len(members) > 1:
            notes.append(
                f"the {len(members)} contacts of {name!r} are no single lower pair: each is a joint of its own"
            )
        found.extend(
            (_contact_joint(regular.contacts[k], label, pair), [k]) for k, label in _labels(name, members, contacts)
        )
    joints, angle, length = _aligned([joint for joint, _ in found], noise)
    sources = {joint.name: tuple(contacts[k] for k in members) for joint, members in found}
    return FoundJoints(joints, sources, max(angle, regular.angle), max(length, regular.length), tuple(notes))


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
    return joint(name, parts, f"contact {contact.state}", movements(contact), contact.frames)


def _aligned(joints: Sequence[Joint], noise: Noise) -> tuple[tuple[Joint, ...], float, float]:
    """The joints aligned with each other: combining finds axes that belong to no single contact."""
    names = [movement for joint in joints for movement in joint.movements]
    frames, angle, length = align(
        names, np.concatenate([joint.before for joint in joints] or [np.empty((0, 4, 4))]), noise
    )
    rest = iter(frames)
    return (
        tuple(
            joint(given.name, given.parts, given.kind, given.movements, [_signed(next(rest)) for _ in given.movements])
            for given in joints
        ),
        angle,
        length,
    )


def _signed(pose: Pose) -> Pose:
    """The frame, turned by half a turn about x where its z axis points backwards."""
    return pose if _forward(pose[:3, 2]) else pose @ np.diag([1.0, -1.0, -1.0, 1.0])


def _forward(axis: Vector) -> bool:
    last = next(component for component in axis[::-1] if abs(component) > 1e-6)
    return bool(last > 0)
