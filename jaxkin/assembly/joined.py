"""Join parts by contacts, and finish the mechanism that they make; make one anew without some of its contacts."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from jaxkin.assembly.at_rest import left_at_rest
from jaxkin.assembly.needless import with_spinning
from jaxkin.contacts.contact import Contact
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.file_noise import noise_of
from jaxkin.joints.from_contacts import FoundJoints, joints_from_contacts
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.regularise import Noise
from jaxkin.linkage.coupled import coupled
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.alignment import SIX_DIGITS, aligned, asked_noise
from jaxkin.topology.bodies import bodies
from jaxkin.topology.structure import structure

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

ROUNDED = 1e-12
"""Radians, and lengths over the size of the assembly: what is aligned by less is rounding, and is not told."""


class WithoutContacts(NamedTuple):
    """What a mechanism is made of beside its contacts."""

    joints: tuple[Joint, ...]
    """Those by hand, and the ties of rigid groups."""
    parts: tuple[str, ...]
    fixed: tuple[str, ...]
    unit: str


class Joined(NamedTuple):
    """Parts joined by contacts: fields of `Mechanism`."""

    linkage: Linkage
    history: tuple[str, ...]
    contacts: Mapping[str, tuple[Contact, ...]]


def joined(
    base: WithoutContacts, contacts: Sequence[Contact], body: Mapping[str, str], noise: Noise, combine: bool
) -> Joined:
    """Join parts by some joints and by contacts, all free of noise."""
    found = joints_from_contacts(contacts, base.parts, combine, noise, body, base.joints)
    structured = structure(base.parts, [(each.name, *each.parts) for each in found.joints], base.fixed)
    notes = (*found.notes, *_alignment_notes(found, base.unit, noise.size))
    return Joined(Linkage.of(found.joints, structured), notes, found.contacts)


def finished(mechanism: Mechanism, noise: Noise, combine: bool = True, align: float | int | None = None) -> Mechanism:
    """Leave at rest what only spins, unless contacts are not to `combine`, and take out what rounding is left."""
    if combine:
        mechanism = left_at_rest(mechanism)
    most = max(SIX_DIGITS, noise.angle) if align is None else asked_noise(align)
    linkage, alignment = aligned(mechanism.linkage, most, mechanism.unit)
    return with_spinning(replace(mechanism, linkage=linkage, alignment=alignment))


def all_contacts(mechanism: Mechanism) -> tuple[Contact, ...]:
    """List the contacts that a mechanism was found from, those of parts at rest too."""
    return (*(each for some in mechanism.contacts.values() for each in some), *mechanism.contacts_at_rest)


def without_contacts(mechanism: Mechanism, left_out: Collection[Contact | str]) -> Mechanism:
    """Make the mechanism from the same solids without some contacts, or joints by hand by their names.

    Its couplings stay, but for those of coordinates that no joint has then. Raises ValueError where that leaves a part
    that hangs on nothing.
    """
    every = all_contacts(mechanism)
    by_hand = [each for each in mechanism.all_joints if each.name not in mechanism.contacts]
    body = bodies(mechanism.parts, mechanism.fixed, [each.parts for each in by_hand if each.kind == JointKind.FIXED])
    given = tuple(each for each in by_hand if each.name not in left_out)
    base = WithoutContacts(given, mechanism.parts, mechanism.fixed, mechanism.unit)
    noise = noise_of(mechanism.solids, every)
    made = joined(base, [each for each in every if each not in left_out], body, noise, combine=True)
    anew = replace(mechanism, **made._asdict(), alignment=(), contacts_at_rest=(), bonds=(), motors=())
    anew = finished(anew, noise)
    return replace(anew, linkage=coupled(anew.linkage, _couplings_left(mechanism.linkage, anew.linkage.joints)))


def _couplings_left(linkage: Linkage, joints: Sequence[Joint]) -> list[Coupling]:
    """Find the couplings of a linkage that other joints can have: those of coordinates that can be driven alone."""
    alone = {each.full_names[first] for each in joints for first, *others in each.driven_together if not others}
    return [each for each in linkage.couplings if alone.issuperset(each.coordinates)]


def _alignment_notes(found: FoundJoints, unit: str, size: float) -> list[str]:
    """Tell by how much joints were aligned, if that is more than rounding in an assembly of some size; without
    contacts, where the size is 0, than rounding of one unit of length."""
    if found.angle < ROUNDED and found.length < ROUNDED * (size or 1.0):
        return []
    return [
        f"for the noise of the file, directions were aligned by at most {found.angle:.1g} rad "
        f"and axes by {found.length:.1g} {unit}"
    ]
