"""The way from the contacts of solids to a mechanism: bodies, what the user adds or leaves out, joints, notes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.contacts.contact import Contact, Contacts
from jaxkin.geometry.doubt import doubt
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import frame
from jaxkin.joints.from_contacts import FoundJoints, joints_from_contacts
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.regularise import Noise
from jaxkin.motion.alignment import SIX_DIGITS, aligned, asked_noise
from jaxkin.motion.ignore import without
from jaxkin.motion.mechanism import Mechanism
from jaxkin.motion.at_rest import left_at_rest
from jaxkin.topology.bodies import bodies
from jaxkin.topology.checks import check_names
from jaxkin.topology.structure import structure

if TYPE_CHECKING:
    from jaxkin.motion.assembly import Assembly

_LISTED = 8
"""Names, or near misses, that a message lists at most."""


def mechanism_from_solids(
    assembly: Assembly,
    contacts: Sequence[Contact],
    *,
    fixed: Sequence[str],
    rigid: Sequence[Sequence[str]],
    ignore: Sequence[Sequence[str]],
    joints: Sequence[Joint],
    combine: bool,
    align: float | int | None,
) -> Mechanism:
    """The mechanism of an assembly: see `Assembly.mechanism`. `contacts` are those found, before any is left out."""
    names = assembly.names
    check_names(names, [(given.name, *given.parts) for given in joints], fixed)
    body = bodies(names, fixed, rigid)
    owners = {body[part] for part in fixed}
    fixed = (*fixed, *(part for part in names if body[part] in owners and part not in fixed))
    for given in joints:
        if body[given.parts[0]] == body[given.parts[1]]:
            raise ValueError(f"joint {given.name!r} joins parts that are rigidly connected: {', '.join(given.parts)}")

    used = without(contacts, ignore)
    ties = _ties(assembly, body, fixed)
    _refuse_loose(assembly, fixed, [*(c.parts for c in used), *(given.parts for given in (*joints, *ties))])
    moving = [contact for contact in used if body[contact.parts[0]] != body[contact.parts[1]]]
    by_hand = {_pair(given.parts, body): given.name for given in joints}
    replaced = [contact for contact in moving if _pair(contact.parts, body) in by_hand]
    kept = [contact for contact in moving if _pair(contact.parts, body) not in by_hand]
    noise = noise_of(assembly.parts, moving)
    most = max(SIX_DIGITS, noise.angle) if align is None else asked_noise(align)
    found = joints_from_contacts(kept, names, combine, noise, body, joints)
    every = (*found.joints, *ties)
    described = [(each.name, *each.parts) for each in every]
    notes = (
        *found.notes,
        *_left_out(len(contacts) - len(used), replaced, by_hand, body),
        *_told(contacts),
        *_aligned(found, assembly.unit),
    )
    structured = structure(names, described, fixed)
    mechanism = Mechanism(every, structured, assembly.unit, assembly.parts, notes, found.contacts)
    return aligned(left_at_rest(mechanism) if combine else mechanism, most)


def noise_of(parts: Sequence[Part], contacts: Sequence[Contact]) -> Noise:
    """The noise of single precision; more where surfaces were fitted to few corners that are near to each other."""
    faces = {(part.name, face.name): (face, part.grain) for part in parts if part.grain for face in part.faces}
    touching = dict.fromkeys(key for contact in contacts for key in zip(contact.parts, contact.faces, strict=True))
    doubts = [doubt(*faces[key]) for key in touching if key in faces]
    return Noise.of(contacts).with_doubt(*np.max(doubts, axis=0, initial=0.0)) if doubts else Noise.of(contacts)


def _pair(parts: tuple[str, str], body: Mapping[str, str]) -> frozenset[str]:
    return frozenset(body[part] for part in parts)


def _ties(assembly: Assembly, body: Mapping[str, str], fixed: Sequence[str]) -> list[Joint]:
    """A joint without freedoms from the first part of each rigid group to each of the others."""
    centres = {part.name: part.box.mean(axis=0) for part in assembly.parts}
    return [
        joint(f"{first}-{part}", (first, part), "fixed", ("I",), [frame(centres[part], np.array([0.0, 0.0, 1.0]))])
        for part, first in body.items()
        if part != first and part not in fixed
    ]


def _left_out(ignored: int, replaced: Sequence[Contact], by_hand: Mapping, body: Mapping[str, str]) -> list[str]:
    """What the user's words did to the contacts."""
    notes = [f"{ignored} contact{'' if ignored == 1 else 's'} ignored, as was asked for"] if ignored else []
    for pair, name in by_hand.items():
        states = [f"({contact.state})" for contact in replaced if _pair(contact.parts, body) == pair]
        if states:
            what = "contact" if len(states) == 1 else f"{len(states)} contacts"
            notes.append(f"joint {name!r}, given by hand, replaces the {what} {', '.join(states)} between its parts")
    return notes


def _aligned(found: FoundJoints, unit: str) -> list[str]:
    if not found.angle and not found.length:
        return []
    return [
        f"for the noise of the file, directions were aligned by at most {found.angle:.1g} rad "
        f"and axes by {found.length:.1g} {unit}"
    ]


def _told(contacts: Sequence[Contact]) -> tuple[str, ...]:
    """Near misses and refusals of the detection, where the contacts are a whole result of it."""
    return (*map(str, contacts.near_misses), *contacts.notes) if isinstance(contacts, Contacts) else ()


def _refuse_loose(assembly: Assembly, fixed: Sequence[str], ties: Sequence[tuple[str, str]]) -> None:
    """Refuse parts that no chain of contacts and joints ties to the fixed ones, with what is nearly a contact there."""
    neighbours: dict[str, set[str]] = {name: set() for name in assembly.names}
    for one, other in ties:
        neighbours[one].add(other)
        neighbours[other].add(one)
    held, todo = set(fixed), list(fixed)
    while todo:
        new = neighbours[todo.pop()] - held
        held |= new
        todo += new
    loose = [name for name in assembly.names if name not in held]
    if not loose:
        return
    alone = [name for name in loose if not neighbours[name]]
    if alone:
        problem = f"{_listed(alone)} touch{'es' if len(alone) == 1 else ''} no other part"
    else:
        problem = f"no chain of contacts ties {_listed(loose)} to the fixed {_listed(fixed)}"
    found = assembly.contacts()
    misses = [miss for miss in found.near_misses if set(miss.parts) & set(alone or loose)]
    said = [note for note in found.notes if any(name in note for name in alone or loose)]
    nearly = [f"  {miss}" for miss in [*misses, *said][:_LISTED]] or ["  and nothing there is nearly in contact"]
    advice = "correct the model, fix the part, connect it with rigid=, or leave it out:"
    raise ValueError("\n".join([f"{assembly.source}: {problem}; {advice}", *nearly]))


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return ", ".join(map(repr, names[:_LISTED])) + more
