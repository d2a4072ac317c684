"""Drop the weakest inference where nothing can move with all of them, and count those that are kept."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from jaxkin.assembly.ignored_contacts import without
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.seats import useful_freedoms
from jaxkin.assembly.to_mechanism import MechanismOptions, make_mechanism
from jaxkin.contacts.contact import Contact
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.topology.bodies import body_of_parts
from jaxkin.topology.components import connected

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.mechanism.mechanism import Mechanism

KEPT = (EvidenceKind.NEAREST, EvidenceKind.BOLT_PATTERN)
"""Inferences that are not dropped so that something moves: without the first their parts would be tied to nothing, and
plates that are bolted together do not move."""
DROPPED = "left out, since nothing could move with it"
"""How the note begins that tells an inference which was dropped."""
TOLD = "inferred beside exact contacts"
"""How the note begins that counts inferences."""
_TRIED = 12
"""Inferences that are left out in turn, the weakest first, where nothing can move with all of them."""


def without_weakest(
    assembly: Assembly,
    contacts: Sequence[Contact],
    options: MechanismOptions,
    found: Sequence[Inference],
    locked: Mechanism,
    fasteners: Collection[str],
) -> tuple[Mechanism | None, Inference | None]:
    """Find the mechanism without the weakest inference that locks it, and that inference: one with useful freedoms, or
    with any where no part spins; None otherwise.

    Inferences that hold parts which nothing else does are weaker than those of bolts and pins: these come first. Those
    without which a part would hang on nothing stay, and so do those without which screws and nuts alone would turn: a
    structure of bolted plates is no mechanism. A pin in a bush, of which nothing else is inferred, is one. What only
    spins in the `locked` mechanism, which has all inferences, keeps them; where that has joints, a fastener that turns
    about itself without an inference has no part in what locks them.
    """
    movable, without_it = None, None
    spinning = {each.name for each in locked.linkage.spinning}
    jointed = any(joint.freedoms for joint in locked.all_joints)
    droppable = [each for each in reversed(found) if each.evidence.kind not in KEPT]
    for dropping in droppable[:_TRIED]:
        fewer = [each for each in found if each is not dropping]
        if _leaves_loose(assembly, contacts, options, fewer):
            continue
        other = with_count(make_mechanism(assembly, contacts, options, fewer), fewer)
        if fewer and _frees_fasteners_only(other, dropping, fasteners):
            continue
        other = with_note_of_dropped(dropping, other)
        if useful_freedoms(other) and _drives_another(other, spinning):
            return other, dropping
        freed = {each.name for each in other.linkage.spinning}.difference(fasteners) if jointed else other.all_joints
        if not spinning and movable is None and freed and any(joint.freedoms for joint in other.all_joints):
            movable, without_it = other, dropping
    return movable, without_it


def with_note_of_dropped(dropped: Inference, mechanism: Mechanism) -> Mechanism:
    """Tell of a mechanism that an inference was dropped."""
    note = f"{DROPPED}: {dropped}"
    return replace(mechanism, history=(note, *mechanism.history))


def _drives_another(mechanism: Mechanism, spinning: Collection[str]) -> bool:
    """Tell whether a joint can be driven between bodies none of which only spun before, as a disc on its screw did:
    what such a body gains without its hinge is no motion of the machine."""
    owner = body_of_parts(mechanism.bodies)
    spun = {owner[part] for part in spinning}
    driven = {name.rpartition(".")[0] for name in mechanism.mobility().drivable}
    return any(each.name in driven and not spun & {owner[part] for part in each.parts} for each in mechanism.all_joints)


def _frees_fasteners_only(mechanism: Mechanism, dropped: Inference, fasteners: Collection[str]) -> bool:
    """Tell whether all else is one body without an inference, but for the fasteners among its parts."""
    freed = {*dropped.parts} & {*fasteners}
    others = [parts for parts in mechanism.bodies.values() if not freed.issuperset(parts)]
    return dropped.evidence.kind is EvidenceKind.FASTENER and len(others) < 2


def _leaves_loose(
    assembly: Assembly, contacts: Sequence[Contact], options: MechanismOptions, found: Sequence[Inference]
) -> bool:
    """Tell whether some part would hang on nothing."""
    touching = [contact.parts for contact in without(contacts, options.ignored)]
    ties = [
        *touching,
        *options.rigid,
        *(joint.parts for joint in options.joints),
        *(each.parts for each in found),
        options.fixed,
    ]
    return len(connected(assembly.names, [(tie[0], part) for tie in ties for part in tie[1:]])) > 1


def with_count(mechanism: Mechanism, inferences: Sequence[Inference]) -> Mechanism:
    """Make the mechanism with a note that counts its inferences by their evidence."""
    kinds = Counter(str(each.evidence.kind) for each in inferences)
    if not kinds:
        return mechanism
    told = ", ".join(f"{count} by {kind}" for kind, count in kinds.most_common())
    tied = [each for each in inferences if each.evidence.kind is not EvidenceKind.NEAREST]
    if tied:
        example = min(tied, key=lambda each: each.joint is not None).parts[:2]
        told += f"; what is inferred of two parts is taken back by their names, as in ignore={[list(example)]}"
    return replace(mechanism, history=(f"{TOLD}: {told}", *mechanism.history))
