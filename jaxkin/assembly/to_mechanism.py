"""From the contacts of solids to a mechanism: bodies, what the user adds or leaves out, joints, notes."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin._names import counted, free_name
from jaxkin.assembly.ignored_contacts import Entry, without
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.joined import WithoutContacts, finished, joined
from jaxkin.assembly.near_misses import not_accounted_for
from jaxkin.contacts.contact import Contact, Contacts
from jaxkin.contacts.detect import is_about
from jaxkin.geometry.pose import frame
from jaxkin.joints.combine import SUBGROUP_JOINTS
from jaxkin.joints.evidence import BY_HAND, Bond, EvidenceKind
from jaxkin.joints.file_noise import noise_of
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.topology.bodies import bodies
from jaxkin.topology.checks import check_names
from jaxkin.topology.components import connected

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly

_LISTED = 8
"""Names, or near misses, that a message lists at most."""


class MechanismOptions(NamedTuple):
    """What a user asks of the mechanism of an assembly, with all names in full: arguments of `Assembly.mechanism`."""

    fixed: Sequence[str]
    rigid: Sequence[Sequence[str]] = ()
    ignore: Sequence[Entry] = ()
    joints: Sequence[Joint] = ()
    combine: bool = True
    align: float | int | None = None
    clearance: float | int | None = None

    @property
    def ignored(self) -> list[tuple[str, str]]:
        """All pairs of parts, or of their faces, between which contacts are left out."""
        return [pair for entry in self.ignore for pair in entry]


def check_options(names: Sequence[str], options: MechanismOptions) -> None:
    """Refuse options that name no parts, or groups that are none: ValueError."""
    check_names(names, [(given.name, *given.parts) for given in options.joints], options.fixed)
    bodies(names, options.fixed, options.rigid)
    clearance = options.clearance
    if clearance is not None and (isinstance(clearance, bool | str) or not 0 <= clearance < np.inf):
        raise ValueError(f"clearance must be a radial length in the unit of the file, such as 0.2, got {clearance!r}")


def without_rigid_joints(names: Sequence[str], options: MechanismOptions) -> tuple[MechanismOptions, list[str]]:
    """Leave out the joints by hand whose two parts are one body by `rigid` or `fixed`, and tell each in a line.

    For joints that were written down as they were found: a body that somebody adds to these is what is meant.
    """
    body = bodies(names, options.fixed, options.rigid)
    inside = [each for each in options.joints if body[each.parts[0]] == body[each.parts[1]]]
    held, notes = {body[part] for part in options.fixed}, []
    for each in inside:
        one, other = each.parts
        why = "fixed and rigid say" if body[one] in held else "rigid says"
        notes.append(f"joint {each.name!r} is left out, since {why} that {one!r} and {other!r} are one body")
    return options._replace(joints=[each for each in options.joints if each not in inside]), notes


def make_mechanism(
    assembly: Assembly,
    contacts: Sequence[Contact],
    options: MechanismOptions,
    inferences: Sequence[Inference] = (),
    system: str = "CAD system",
) -> Mechanism:
    """Make the mechanism of contacts, inferences and what the user asks for; `system` has exported some inferences."""
    groups = [each.parts for each in inferences if each.joint is None]
    joints = (*options.joints, *(each.joint for each in inferences if each.joint is not None))
    names, combine, align = assembly.names, options.combine, options.align
    body = bodies(names, options.fixed, [*options.rigid, *groups])
    owners = {body[part] for part in options.fixed}
    fixed = (*options.fixed, *(part for part in names if body[part] in owners and part not in options.fixed))
    for given in joints:
        if body[given.parts[0]] == body[given.parts[1]]:
            raise ValueError(
                f"joint {given.name!r} joins parts that are rigidly connected: {', '.join(given.parts)}; leave the "
                f"joint out (in a study, off = true in [joints.{json.dumps(given.name, ensure_ascii=False)}]), or one "
                "of its parts out of rigid or fixed"
            )

    used = without(contacts, options.ignored)
    ties = _ties(assembly, body, fixed, inferences, {given.name for given in joints})
    _refuse_loose(assembly, contacts, fixed, [*(c.parts for c in used), *(given.parts for given in (*joints, *ties))])
    moving = [contact for contact in used if body[contact.parts[0]] != body[contact.parts[1]]]
    by_hand = {_pair(given.parts, body): given.name for given in joints}
    own = {_pair(given.parts, body): given.name for given in options.joints}
    replaced = [contact for contact in moving if _pair(contact.parts, body) in by_hand]
    kept = [contact for contact in moving if _pair(contact.parts, body) not in by_hand]
    noise = noise_of(assembly.parts, moving)
    linkage, notes, found = joined(
        WithoutContacts((*joints, *ties), names, tuple(fixed), assembly.unit), kept, body, noise, combine
    )
    mechanism = finished(
        Mechanism(linkage, assembly.unit, assembly.parts, notes, contacts=found), noise, combine, align
    )
    told = (*_left_out_notes(len(contacts) - len(used), replaced, own, body), *inference_notes(inferences, system))
    told = (*told, *_detection_notes(contacts, mechanism))
    bonds = (
        *(Bond(tuple(group)) for group in options.rigid),
        *(Bond(each.parts, each.evidence) for each in inferences if each.joint is None),
    )
    return replace(mechanism, history=(*told, *mechanism.history), bonds=bonds)


def inference_notes(inferences: Sequence[Inference], system: str = "CAD system") -> list[str]:
    """Tell inferences one by one, but what the exporting system said itself as counts: nothing in it is in doubt."""
    said = Counter(
        str(each.joint.kind) if each.joint else "weld or rigid group"
        for each in inferences
        if each.evidence.kind is EvidenceKind.EXPORT
    )
    counts = ", ".join(f"{count} {kind}" for kind, count in said.most_common())
    others = [str(each) for each in inferences if each.evidence.kind is not EvidenceKind.EXPORT]
    return [f"joints and bodies as the {system} has them: {counts}", *others] if said else others


def _pair(parts: tuple[str, str], body: Mapping[str, str]) -> frozenset[str]:
    return frozenset(body[part] for part in parts)


def _ties(
    assembly: Assembly,
    body: Mapping[str, str],
    fixed: Sequence[str],
    inferences: Sequence[Inference],
    taken: Collection[str],
) -> list[Joint]:
    """Make a joint without freedoms from the first part of each rigid group to each of the others, with a name that is
    not taken."""
    centres = {part.name: part.box.mean(axis=0) for part in assembly.parts}
    known = {part: each.evidence for each in reversed(inferences) if each.joint is None for part in each.parts}
    return [
        joint(
            free_name(f"{first}-{part}", taken),
            (first, part),
            JointKind.FIXED,
            (SUBGROUP_JOINTS[0, 0][1],),
            [frame(centres[part], np.array([0.0, 0.0, 1.0]))],
            evidence=known.get(part, BY_HAND),
        )
        for part, first in body.items()
        if part != first and part not in fixed
    ]


def _left_out_notes(ignored: int, replaced: Sequence[Contact], by_hand: Mapping, body: Mapping[str, str]) -> list[str]:
    """Tell which contacts were left out for what the user asks for."""
    notes = [f"{counted(ignored, 'contact')} ignored, as was asked for"] if ignored else []
    for pair, name in by_hand.items():
        states = [f"({contact.state})" for contact in replaced if _pair(contact.parts, body) == pair]
        if states:
            what = "contact" if len(states) == 1 else f"{len(states)} contacts"
            notes.append(f"joint {name!r}, given by hand, replaces the {what} {', '.join(states)} between its parts")
    return notes


def _detection_notes(contacts: Sequence[Contact], mechanism: Mechanism) -> tuple[str, ...]:
    """Tell near misses that a mechanism does not account for, and refusals of the detection, where the contacts are a
    whole result of it."""
    if not isinstance(contacts, Contacts):
        return ()
    return (*map(str, not_accounted_for(contacts.near_misses, mechanism)), *contacts.notes)


def _refuse_loose(
    assembly: Assembly, contacts: Sequence[Contact], fixed: Sequence[str], ties: Sequence[tuple[str, str]]
) -> None:
    """Refuse parts that no chain of contacts and joints ties to the fixed ones, with what is nearly a contact there."""
    groups = connected(assembly.names, [*ties, *((fixed[0], part) for part in fixed[1:])])
    held = next(group for group in groups if fixed[0] in group)
    islands = [sorted(group, key=assembly.names.index) for group in groups if group is not held]
    if not islands:
        return
    loose = [name for name in assembly.names if name not in held]
    alone = [island[0] for island in islands if len(island) == 1]
    if alone:
        problem = f"{_listed(alone)} touch{'es' if len(alone) == 1 else ''} no other part"
    else:
        problem = f"no chain of contacts ties {_listed(loose)} to the fixed {_listed(fixed)}"
    found = detection_of(assembly, contacts)
    misses = [miss for miss in found.near_misses if set(miss.parts) & set(alone or loose)]
    about = [part for part in assembly.parts if part.name in (alone or loose)]
    said = [note for note in found.notes if any(is_about(note, part) for part in about)]
    nearly = [f"  {miss}" for miss in [*misses, *said][:_LISTED]] or ["  and nothing there is nearly in contact"]
    groups = [[_nearest(assembly, island, held), island[0]] for island in islands[:_LISTED]]
    advice = f"correct the model, fix the part, connect it, as with rigid={groups}, or leave it out of the file:"
    raise ValueError("\n".join([f"{assembly.source}: {problem}; {advice}", *nearly]))


def detection_of(assembly: Assembly, contacts: Sequence[Contact]) -> Contacts:
    """Find the detection that some contacts are from: what it nearly found depends on the tolerances that it was
    given."""
    if isinstance(contacts, Contacts):
        return contacts
    sources = [found for found in assembly.found if contacts and any(each is contacts[0] for each in found)]
    return sources[0] if sources else assembly.contacts()


def _nearest(assembly: Assembly, island: Sequence[str], held: Collection[str]) -> str:
    """Find the held part whose box is nearest to the first part of an island."""
    boxes = {part.name: part.box for part in assembly.parts}
    low, high = boxes[island[0]]

    def distance(name: str) -> float:
        return float(np.linalg.norm(np.maximum(np.maximum(boxes[name][0] - high, low - boxes[name][1]), 0.0)))

    return min((name for name in assembly.names if name in held), key=distance)


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return ", ".join(map(repr, names[:_LISTED])) + more
