"""The mechanism with what solids imply beside their exact contacts: conflicts are resolved by trying, and told."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from jaxkin.assembly.caps import told_caps
from jaxkin.assembly.ignored_contacts import check_ignored, without
from jaxkin.assembly.inference.infer import infer
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Pair
from jaxkin.assembly.inference.springs import DrawnSpring, springs
from jaxkin.assembly.lids import under_lids
from jaxkin.assembly.resting import leaves_all_moving, resting
from jaxkin.assembly.seats import seats_of, useful_freedoms
from jaxkin.assembly.to_mechanism import MechanismOptions, detection_of, make_mechanism
from jaxkin.contacts.contact import Contact, Contacts
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.bodies import bodies, body_of_parts
from jaxkin.topology.components import connected

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.mechanism.mechanism import Mechanism

_KEPT = (EvidenceKind.NEAREST, EvidenceKind.BOLT_PATTERN)
"""Inferences that are not dropped so that something moves: without the first their parts would be tied to nothing, and
plates that are bolted together do not move."""
TOLD = "inferred beside exact contacts"
"""How the note begins that counts inferences."""
_ROUNDS = 3
"""Times that seats are looked for: what is one body by some may be seated on others."""
_LYING = 6
"""Bodies that lie on others that are held there one by one, where not all can be held together."""
_TRIED = 12
"""Inferences that are left out in turn, the weakest first, where nothing can move with all of them."""


def with_inferences(assembly: Assembly, contacts: Sequence[Contact], options: MechanismOptions) -> Mechanism:
    """Make the mechanism with what solids imply beside their exact contacts.

    Tubes that may be springs are taken for such where the parts at their ends move on each other then; otherwise a
    screw clamps these, and the tube is a spacer.
    """
    words = [*options.rigid, *options.ignored, *(each.parts for each in options.joints)]
    by_hand = {*options.fixed, *(part for group in words for part in group)}
    tubes = springs(assembly._measured, contacts, options.fixed, by_hand)
    made = _with_springs(assembly, contacts, options, tubes)
    body = body_of_parts(made.bodies)
    pushing = [each for each in tubes if body.get(each.seat, each.seat) != body.get(each.pushed, each.pushed)]
    return made if pushing == tubes else _with_springs(assembly, contacts, options, pushing)


def _with_springs(
    assembly: Assembly, contacts: Sequence[Contact], options: MechanismOptions, tubes: Sequence[DrawnSpring]
) -> Mechanism:
    """Make the mechanism with what solids imply, and some tubes as springs.

    What would stop slides that exact contacts allow is taken only where these slides are of use otherwise, so that the
    mechanism has fewer freedoms but still some; where all of it leaves none, without the least sure of it. Bodies that
    seats of faces leave a slide of no use are one body, and so are those that only lie on each other, where all that
    moves still does then. Where the inferences lock it, the weakest one without which it moves is dropped, and that is
    said.
    """
    source = detection_of(assembly, contacts)
    used = Contacts(without(contacts, options.ignored), source.near_misses, source.notes)
    asked = {frozenset(pair) for pair in options.ignored if {*pair} <= {*assembly.names}}
    ignored = asked | {frozenset(contact.parts) for contact in contacts if contact not in used.contacts}
    check_ignored(contacts, options.ignore, asked)
    detected, heeded = contacts, set[Pair]()
    if tubes:
        ignored |= {frozenset((each.part, other)) for each in tubes for other in assembly.names if other != each.seat}
        names = {each.part for each in tubes}
        used, contacts = (
            Contacts(tuple(each for each in some if not names & {*each.parts}), source.near_misses, source.notes)
            for some in (used, contacts)
        )

    fasteners: set[str] = set()

    def made(seats: Sequence[Inference], apart: Sequence[Pair] = ()) -> tuple[Mechanism, list[Inference], int]:
        """Make the mechanism with its inferences, with the pairs of parts in `apart` never one body; and count what is
        of use before slides are stopped. Keeps what was taken for fasteners in `fasteners`."""
        rigid = [*options.rigid, *(each.parts for each in seats)]
        loose = {each.part for each in tubes}
        implied = infer(
            assembly._measured, used, options.fixed, rigid, options.joints, ignored, options.clearance, loose, apart
        )
        fasteners.update(implied.fasteners)
        heeded.update(implied.taken_back)
        found = [*seats, *implied.found]
        plain = make_mechanism(assembly, contacts, options, found)
        return *_stopped(assembly, contacts, options, plain, found, implied.stops), _not_idle(plain)

    seats = [each.inference for each in tubes]
    mechanism, found, plainly = made(seats)
    for held, rests in under_lids(mechanism) if useful_freedoms(mechanism) else ():
        other, more, count = made([*seats, *held])
        if useful_freedoms(other) and leaves_all_moving(mechanism, other, [*held, *rests]):
            if rests:  # else all that lie may be held, with other seats
                seats, mechanism, found, plainly = [*seats, *held], other, more, count
            break
    inexact = len(found) > len(seats)
    bearings = {each.part.name for each in assembly._measured.closed_bearings}
    for _ in range(_ROUNDS):
        seats += (new := seats_of(mechanism, inexact, bearings))
        if not new:
            break
        other, more, count = made(seats)
        # seats may take nothing of use; that slides can be stopped then which were not before is no objection; where
        # more is free with them, they changed which parts others hold, and stops would hide that
        same = _not_idle(other) == _not_idle(mechanism) and count <= plainly
        kept = same or count == plainly or leaves_all_moving(mechanism, other, new, but_slides=True)
        if not (same or (kept and useful_freedoms(other))):
            break
        mechanism, found, plainly = other, more, count
    for held in _choices(resting(mechanism)) if useful_freedoms(mechanism) else ():
        if held[0] in seats:
            break  # all are held together
        other, more, _ = made([*seats, *held])
        if useful_freedoms(other) and leaves_all_moving(mechanism, other, held):
            seats, mechanism, found = [*seats, *held], other, more
    moves = useful_freedoms(mechanism) or _has_free_slide(mechanism)
    check_ignored(detected, options.ignore, heeded)
    told = _counted(mechanism, found)
    if found and not moves:
        unlocked, dropped = _unlocked(assembly, contacts, options, found, mechanism, fasteners)
        told = unlocked or told
        if dropped is not None and dropped.joint is None:
            # what is a body no longer may be a joint: a lever on a pin with play
            kept = [each for each in seats if each is not dropped]
            other, more, _ = made(kept, [frozenset((dropped.parts[0], part)) for part in dropped.parts[1:]])
            if 0 < useful_freedoms(other) < useful_freedoms(told):
                told = _without(dropped, _counted(other, more))
    taken_back = [
        f"nothing is inferred between {one!r} and {other!r}, as was asked for"
        for one, other in options.ignored
        if frozenset((one, other)) in heeded
    ]
    return replace(told, history=(*told_caps(told), *taken_back, *told.history))


def _choices(lying: Sequence[Inference]) -> list[Sequence[Inference]]:
    """List what is tried of bodies that lie on others: all together, then one after another, of a few."""
    return [lying, *([each] for each in lying[:_LYING])] if len(lying) > 1 else [lying] if lying else []


def _not_idle(mechanism: Mechanism) -> int:
    """Count the freedoms that are not idle, those of parts that only spin included; 0 where none is of use."""
    return useful_freedoms(mechanism) and mechanism.mobility().useful + mechanism.mobility().spins


def _stopped(
    assembly: Assembly,
    contacts: Sequence[Contact],
    options: MechanismOptions,
    mechanism: Mechanism,
    found: list[Inference],
    levels: Sequence[Sequence[Inference]],
) -> tuple[Mechanism, list[Inference]]:
    """Find the mechanism that stops slides, and its inferences, from the `mechanism` without stops: with as many levels
    of what would stop them as leave it freedoms, if these are fewer then, or those of parts that only spin are."""
    useful, turning = (useful_freedoms(mechanism), mechanism.mobility().spins) if any(levels) else (0, 0)
    for count in range(len(levels), 0, -1) if useful + turning else ():
        if not levels[count - 1]:
            continue
        stops = [each for level in levels[:count] for each in level]
        names = {each.joint.name for each in stops if each.joint}  # they take the places of joints that slide
        rest = [each for each in found if not (each.joint and each.joint.name in names)]
        more = _without_inner(assembly, options, [*rest, *stops])
        other = make_mechanism(assembly, contacts, options, more)
        fewer, spins = useful_freedoms(other), other.mobility().spins
        if 0 < fewer < useful or (fewer == useful and fewer + spins > 0 and spins < turning):
            return other, more
    return mechanism, found


def _without_inner(assembly: Assembly, options: MechanismOptions, found: Sequence[Inference]) -> list[Inference]:
    """Leave out joints of parts that are one body by other inferences."""
    groups = [each.parts for each in found if each.joint is None]
    body = bodies(assembly.names, options.fixed, [*options.rigid, *groups])
    return [each for each in found if each.joint is None or len({body[part] for part in each.parts}) > 1]


def _has_free_slide(mechanism: Mechanism) -> bool:
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


def _without(dropped: Inference, mechanism: Mechanism) -> Mechanism:
    """Tell of a mechanism that an inference was dropped."""
    note = f"not inferred, since nothing could move with it: {dropped}"
    return replace(mechanism, history=(note, *mechanism.history))


def _unlocked(
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
    spins in the `locked` mechanism, which has all inferences, keeps them.
    """
    movable, without_it = None, None
    spinning = {each.name for each in locked.linkage.spinning}
    droppable = [each for each in reversed(found) if each.evidence.kind not in _KEPT]
    for dropping in droppable[:_TRIED]:
        fewer = [each for each in found if each is not dropping]
        if _loose(assembly, contacts, options, fewer):
            continue
        other = _counted(make_mechanism(assembly, contacts, options, fewer), fewer)
        if fewer and _frees_fasteners_only(other, dropping, fasteners):
            continue
        other = _without(dropping, other)
        if useful_freedoms(other) and _drives_another(other, spinning):
            return other, dropping
        if not spinning and movable is None and any(joint.freedoms for joint in other.all_joints):
            movable, without_it = other, dropping
    return movable, without_it


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


def _loose(
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


def _counted(mechanism: Mechanism, inferences: Sequence[Inference]) -> Mechanism:
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
