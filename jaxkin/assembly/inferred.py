"""The mechanism with what solids imply beside their exact contacts: conflicts are resolved by trying, and told."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.caps import told_caps
from jaxkin.assembly.guides import is_guide
from jaxkin.assembly.ignored_contacts import without
from jaxkin.assembly.inference.bores import NEAR_ANGLE
from jaxkin.assembly.inference.infer import infer
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.springs import Spring, springs
from jaxkin.assembly.resting import leaves_all_moving, resting
from jaxkin.assembly.to_mechanism import Said, from_words, told_by
from jaxkin.contacts.contact import Contact, Contacts
from jaxkin.geometry.part import size
from jaxkin.geometry.pose import Vector
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.open_loops import opening
from jaxkin.topology.bodies import bodies
from jaxkin.topology.components import connected

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.mechanism.mechanism import Mechanism

_KEPT = (EvidenceKind.NEAREST, EvidenceKind.BOLT_PATTERN)
"""Inferences that are not dropped so that something moves: without the first their parts would be tied to nothing, and
plates that are bolted together do not move."""
TOLD = "inferred beside exact contacts"
"""How the note begins that counts inferences."""
_NEAR = 1e-4
"""Distance of two axes that are one, over the size of the assembly."""
_ROUNDS = 3
"""Times that seats are looked for: what is one body by some may be seated on others."""
_LYING = 6
"""Bodies that lie on others that are held there one by one, where not all can be held together."""
_TRIED = 12
"""Inferences that are left out in turn, the weakest first, where nothing can move with all of them."""


def inferred(assembly: Assembly, contacts: Sequence[Contact], said: Said) -> Mechanism:
    """Make the mechanism with what solids imply beside their exact contacts.

    Tubes that may be springs are taken for such where the parts at their ends move on each other then; otherwise a
    screw clamps these, and the tube is a spacer.
    """
    words = [*said.rigid, *said.ignore, *(each.parts for each in said.joints)]
    by_hand = {*said.fixed, *(part for group in words for part in group)}
    tubes = springs(assembly._measured, contacts, said.fixed, by_hand)
    made = _inferred(assembly, contacts, said, tubes)
    body = {part: owner for owner, parts in made.bodies.items() for part in parts}
    pushing = [each for each in tubes if body.get(each.seat, each.seat) != body.get(each.pushed, each.pushed)]
    return made if pushing == tubes else _inferred(assembly, contacts, said, pushing)


def _inferred(assembly: Assembly, contacts: Sequence[Contact], said: Said, tubes: Sequence[Spring]) -> Mechanism:
    """Make the mechanism with what solids imply, and some tubes as springs.

    What would stop slides that exact contacts allow is taken only where these slides are of use otherwise, so that the
    mechanism has fewer freedoms but still some; where all of it leaves none, without the least sure of it. Bodies that
    seats of faces leave a slide of no use are one body, and so are those that only lie on each other, where all that
    moves still does then. Where the inferences lock it, the weakest one without which it moves is dropped, and that is
    said.
    """
    source = told_by(assembly, contacts)
    used = Contacts(without(contacts, said.ignore), source.near_misses, source.notes)
    ignored = {frozenset(contact.parts) for contact in contacts if contact not in used.contacts}
    if tubes:
        ignored |= {frozenset((each.part, other)) for each in tubes for other in assembly.names if other != each.seat}
        names = {each.part for each in tubes}
        used, contacts = (
            Contacts(tuple(each for each in some if not names & {*each.parts}), source.near_misses, source.notes)
            for some in (used, contacts)
        )

    def made(seats: Sequence[Inference]) -> tuple[Mechanism, list[Inference], int]:
        """Make the mechanism with its inferences; and count what is of use before slides are stopped."""
        rigid = [*said.rigid, *(each.parts for each in seats)]
        loose = {each.part for each in tubes}
        found, levels = infer(assembly._measured, used, said.fixed, rigid, said.joints, ignored, said.clearance, loose)
        found = [*seats, *found]
        plain = from_words(assembly, contacts, said, found)
        return *_stopped(assembly, contacts, said, plain, found, levels), _not_idle(plain)

    seats = [each.inference for each in tubes]
    mechanism, found, plainly = made(seats)
    inexact = len(found) > len(seats)
    for _ in range(_ROUNDS):
        seats += (new := _seats(mechanism, inexact, {each.part.name for each in assembly._measured.closed_bearings}))
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
    unlocked = None if not found or moves else _unlocked(assembly, contacts, said, found)
    told = unlocked or _counted(mechanism, found)
    return replace(told, history=(*told_caps(told), *told.history))


def _choices(lying: Sequence[Inference]) -> list[Sequence[Inference]]:
    """List what is tried of bodies that lie on others: all together, then one after another, of a few."""
    return [lying, *([each] for each in lying[:_LYING])] if len(lying) > 1 else [lying] if lying else []


def _not_idle(mechanism: Mechanism) -> int:
    """Count the freedoms that are not idle, those of parts that only spin included; 0 where none is of use."""
    return useful_freedoms(mechanism) and mechanism.mobility().useful + mechanism.mobility().spins


def _stopped(
    assembly: Assembly,
    contacts: Sequence[Contact],
    said: Said,
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
        slides = [each for each in found if each.joint and each.joint.name in names]
        more = _without_inner(assembly, said, [*(each for each in found if each not in slides), *stops])
        other = from_words(assembly, contacts, said, more)
        fewer, spins = useful_freedoms(other), other.mobility().spins
        if 0 < fewer < useful or (fewer == useful and fewer + spins > 0 and spins < turning):
            return other, more
    return mechanism, found


def _without_inner(assembly: Assembly, said: Said, found: Sequence[Inference]) -> list[Inference]:
    """Leave out joints of parts that are one body by other inferences."""
    groups = [each.parts for each in found if each.joint is None]
    body = bodies(assembly.names, said.fixed, [*said.rigid, *groups])
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


def _unlocked(
    assembly: Assembly, contacts: Sequence[Contact], said: Said, found: Sequence[Inference]
) -> Mechanism | None:
    """Find the mechanism without the weakest inference that locks it: one with useful freedoms, or with any; None
    otherwise.

    Inferences that hold parts which nothing else does are weaker than those of bolts and pins: these come first. Those
    without which a part would hang on nothing stay, and so do those without which screws and nuts alone would turn: a
    structure of bolted plates is no mechanism. A pin in a bush, of which nothing else is inferred, is one.
    """
    movable = None
    droppable = [each for each in reversed(found) if each.evidence.kind not in _KEPT]
    for dropping in droppable[:_TRIED]:
        fewer = [each for each in found if each is not dropping]
        if _loose(assembly, contacts, said, fewer):
            continue
        other = _counted(from_words(assembly, contacts, said, fewer), fewer)
        if fewer and _frees_fasteners_only(other, dropping):
            continue
        dropped = f"not inferred, since nothing could move with it: {dropping}"
        other = replace(other, history=(dropped, *other.history))
        if useful_freedoms(other):
            return other
        if movable is None and any(joint.freedoms for joint in other.all_joints):
            movable = other
    return movable


def _frees_fasteners_only(mechanism: Mechanism, dropped: Inference) -> bool:
    """Tell whether all else is one body without an inference, but for the fasteners that it holds: those named after
    their host."""
    fasteners = {*dropped.parts[1:]}
    others = [parts for parts in mechanism.bodies.values() if not fasteners.issuperset(parts)]
    return dropped.evidence.kind is EvidenceKind.FASTENER and len(others) < 2


def _loose(assembly: Assembly, contacts: Sequence[Contact], said: Said, found: Sequence[Inference]) -> bool:
    """Tell whether some part would hang on nothing."""
    touching = [contact.parts for contact in without(contacts, said.ignore)]
    ties = [
        *touching,
        *said.rigid,
        *(joint.parts for joint in said.joints),
        *(each.parts for each in found),
        said.fixed,
    ]
    return len(connected(assembly.names, [(tie[0], part) for tie in ties for part in tie[1:]])) > 1


def useful_freedoms(mechanism: Mechanism) -> int:
    """Count the freedoms that are of use; 0 where the loops are open in the given pose, so that none can be counted."""
    return 0 if opening(mechanism.linkage, mechanism.unit) is not None else mechanism.mobility().useful


def _seats(mechanism: Mechanism, inexact: bool, bearings: Collection[str]) -> list[Inference]:
    """Find bodies between which faces leave slides that move nothing else: a bracket on a step, a plate between two
    cheeks; and rods that are set into each other as a rod end into its rod, which leave a turn, where the assembly is
    `inexact`: where exact contacts do not determine all of it. What is in one of the `bearings` turns there.

    Only where something moves: of a mechanism that is locked nothing is known to be of no use. Seats on both sides of a
    body that would hold two others to each other which move by a joint are not both taken. A carriage on a rail is a
    guide, though nothing that is drawn moves with it.
    """
    if not useful_freedoms(mechanism):
        return []
    idle = {*mechanism.mobility().idle}
    owner = {part: body for body, parts in mechanism.bodies.items() for part in parts}
    useful = [joint.parts for joint in mechanism.all_joints if {f"{joint.name}.{c}" for c in joint.coordinates} - idle]
    result = []
    for joint in mechanism.all_joints:
        flat = joint.kind in (JointKind.PRISMATIC, JointKind.PLANAR)
        held = {owner[part] for part in joint.parts} & {owner.get(part, part) for part in mechanism.fixed}
        turning = inexact and joint.kind is JointKind.REVOLUTE and not held  # a nut that drives turns in what is fixed
        screwed = turning and not {*joint.parts} & {*bearings} and _is_in_line(mechanism, joint, owner)
        if joint.kind is JointKind.FIXED and joint.name in mechanism.contacts and joint.evidence:
            result.append(Inference(joint.parts, joint.evidence))
            continue
        moved = {f"{joint.name}.{name}" for name in joint.coordinates} - idle
        if joint.name not in mechanism.contacts or not (flat or screwed) or moved or is_guide(mechanism, joint):
            continue
        one, other = (owner[part] for part in joint.parts)
        joined = {part: one if body == other else body for part, body in owner.items()}
        if all(joined[first] != joined[second] or owner[first] == owner[second] for first, second in useful):
            rest = "turn, as of a thread," if screwed else "slide"
            text = f"faces hold {joint.parts[0]!r} to {joint.parts[1]!r} but for a {rest} that moves nothing else"
            result.append(Inference(joint.parts, Evidence(EvidenceKind.ENCLOSED, (), text)))
            owner = joined
    return result


def _is_in_line(mechanism: Mechanism, joint: Joint, owner: Mapping[str, str]) -> bool:
    """Tell whether all other joints of one of two bodies are about the axis of a joint, as those of the rod of a
    cylinder with an eye on its end are; a roller also touches its rail."""
    pose = np.asarray(joint.frames_1, float)[0]
    point, axis = pose[:3, 3], pose[:3, 2]
    near = _NEAR * size(mechanism.solids)
    for body in {owner[part] for part in joint.parts}:
        others = [
            each
            for each in mechanism.all_joints
            if each is not joint and each.freedoms and body in {owner[part] for part in each.parts}
        ]
        if others and all(_is_about(each, point, axis, near) for each in others):
            return True
    return False


def _is_about(joint: Joint, point: Vector, axis: Vector, near: float) -> bool:
    """Tell whether a joint is a turn about an axis, or along and about it, or about a point on it, but for the distance
    `near`."""
    frame = np.asarray(joint.frames_1, float)[0]
    offset = frame[:3, 3] - point
    apart = float(np.linalg.norm(np.cross(offset, axis)))
    along = bool(np.linalg.norm(np.cross(frame[:3, 2], axis)) < NEAR_ANGLE)
    turns = joint.kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL) and along
    return (turns or joint.kind is JointKind.SPHERICAL) and apart <= near


def _counted(mechanism: Mechanism, inferences: Sequence[Inference]) -> Mechanism:
    """Make the mechanism with a note that counts its inferences by their evidence."""
    kinds = Counter(str(each.evidence.kind) for each in inferences)
    if not kinds:
        return mechanism
    told = ", ".join(f"{count} by {kind}" for kind, count in kinds.most_common())
    return replace(mechanism, history=(f"{TOLD}: {told}", *mechanism.history))
