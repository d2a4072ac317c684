"""Joints of two bodies about the axis that they have in common."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.ball_studs import is_stud
from jaxkin.assembly.inference.bores import NEAR_LENGTH, merged
from jaxkin.assembly.inference.coaxial_features import CoaxialFeatures, coaxial_features
from jaxkin.assembly.inference.contact_faces import shared_span
from jaxkin.assembly.inference.fasteners import Stack, beside
from jaxkin.assembly.inference.heads import is_exposed
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.motors import are_flanged
from jaxkin.assembly.inference.slide_stops import Stop
from jaxkin.assembly.inference.stop_faces import MAX_AXIAL_PLAY, MAX_LIFT, between_bores, nearest, play, stands_across
from jaxkin.assembly.inference.stopped_joint import StoppedJoint, joint_about
from jaxkin.assembly.inference.walls import turns
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind

CENTRED = 0.02
"""Distance between the middles of a pin and of its holes, over the radius, that counts as none."""
FAR = 8.0
"""Play that faces leave along the axis, over the radius of the hole, from which on they are stops of a slide, also of a
rod that stands in the middle: axles with their wheels have up to 4, the rods of a football table 12 to 16."""
MIN_GUIDED = 2.0
"""Length of a hole that slides along a pin, over the radius, at least: one that is shorter than its diameter jams, as a
drawer does, so that a plate on a rod between two lugs turns on it."""
LONGEST_HUB = 5.0
"""Length of the hole of a hub without a stroke, over the radius, at most: what is longer guides, as telescopes do."""
MIN_TURN = 0.05
"""Radians by which a part turns on a hinge with play before faces beside its axis meet, at least."""


MAX_DISC = 0.1
"""Half the thickness of a disc, and its clearance, over the radius of its hole: washers are thinner, and looser."""


def hinges(
    known: Known, fastening: Collection[str] = (), axes: Sequence[CommonAxis] | None = None
) -> list[StoppedJoint]:
    """Infer joints of two bodies about common axes, by default all that are known; some are those of exact contacts but
    for the slide.

    What no face stops at first may be stopped by a third body that turns about the same axis and is kept there, as a
    sun between its bearing and the planet carrier; or bodies stop each other, as the leaves of a hinge do between the
    ends of its pin.
    """
    some = coaxial_features(known, axes)
    joined = {coaxial.owners: _joined(known, coaxial, fastening, ()) for coaxial in some}
    kept = [coaxial for coaxial in some if coaxial.is_kept or _is_kept(joined[coaxial.owners])]
    for coaxial in some:
        if kept and not _is_kept(joined[coaxial.owners]):
            joined[coaxial.owners] = _joined(known, coaxial, fastening, kept)
    sliding = [coaxial for coaxial in some if _slides(joined[coaxial.owners])]
    while len(sliding) > 1:  # the largest set of bodies that stop each other
        tried = {coaxial.owners: _joined(known, coaxial, fastening, [*kept, *sliding]) for coaxial in sliding}
        stopped = [coaxial for coaxial in sliding if _is_kept(tried[coaxial.owners])]
        if len(stopped) == len(sliding):
            joined |= tried
            break
        sliding = stopped
    return [each for some in joined.values() for each in some]


def _is_kept(joined: Sequence[StoppedJoint]) -> bool:
    """Tell whether two bodies turn on each other and surely do not slide."""
    return not _slides(joined) and any(_is(each, JointKind.REVOLUTE) for each in joined)


def _slides(joined: Sequence[StoppedJoint]) -> bool:
    return any(_is(each, JointKind.CYLINDRICAL) for each in joined)


def _is(each: StoppedJoint, kind: JointKind) -> bool:
    return each.inference.joint is not None and each.inference.joint.kind is kind


def _joined(
    known: Known, coaxial: CoaxialFeatures, fastening: Collection[str], kept: Sequence[CoaxialFeatures]
) -> list[StoppedJoint]:
    """Make the joint of two bodies about their axis; `kept` are pairs of bodies that do not slide on each other."""
    pair, pins = coaxial.first, coaxial.pins
    if not coaxial.is_alone:
        return []
    faces = [contact.surfaces[0] for contact in coaxial.touching if contact.contact_state.is_flat]
    planes = [face for face in faces if isinstance(face, Plane)]
    across = [stands_across(plane, pair.one.axis) for plane in planes]
    if not all(across) and (any(across) or any(pins) or not _opens(known, coaxial)):
        return []  # faces along the axis keep it from turning: exact contacts say what is left
    pinned = [each.one for each in coaxial.found if not each.virtual]
    if not any(pins) and any(beside(each, pinned[0]) for each in pinned[1:]):
        return [_guided(known, pair)]
    if not any(pins) and _is_disc(pair):
        return []
    if walled := _walled(known, coaxial, exact=any(pins)):
        return walled
    fastened = pair.one.part in fastening and not _is_rod(known, coaxial)
    return _hinge(known, coaxial, any(across), fastened, kept)


def _is_disc(pair: CommonAxis) -> bool:
    """Tell whether a pin with much play in its hole is a thin disc, such as a washer in a counterbore, which guides
    nothing."""
    return pair.clearance > MAX_DISC * pair.other.radius and pair.one.half < MAX_DISC * pair.one.radius


def _is_rod(known: Known, coaxial: CoaxialFeatures) -> bool:
    """Tell whether most of a pin is in no hole, as the stem of a roller is: no thread or ring stops its slide.

    A shaft in bushes is one to turn, however long it is.
    """
    pin, other = coaxial.first.parts
    return other not in known.sleeves and is_exposed(known, Stack((pin,), (other,), coaxial.first.one, guides=True))


def _opens(known: Known, coaxial: CoaxialFeatures) -> bool:
    """Tell whether two bodies can turn one way about their axis without cutting into each other: all plane faces that
    meet are on one side of it, as those of a lid that is drawn closed.

    A face with outward normal n meets the other one at distances s from the axis a along a x n; turning by a small
    angle d moves it by -s d along n.
    """
    axis, first, signs = coaxial.first.one, min(coaxial.owners), set[int]()
    for contact in coaxial.touching:
        if not isinstance(contact.surfaces[0], Plane):
            return False
        normal = contact.surfaces[0].normal * (1 if known.body[contact.parts[0]] == first else -1)
        along = np.cross(axis.axis, normal)
        low, high = (float(end - axis.point @ along) for end in shared_span(contact, known.solids, along))
        slack = NEAR_LENGTH * axis.radius
        signs.add(1 if low >= -slack else -1 if high <= slack else 0)
    return len(signs) == 1 and 0 not in signs


def _hinge(
    known: Known, coaxial: CoaxialFeatures, touching: bool, fastened: bool, kept: Sequence[CoaxialFeatures]
) -> list[StoppedJoint]:
    """Make a revolute joint where faces stop the slide, otherwise a cylindrical one unless contacts say that exactly.

    Faces across the axis that touch stop it, as they do beside a pin that fits exactly. A pin with play that is in the
    middle of its holes, about as long as they are, or in a short hole, may turn only: that is made, too, to be tried.
    """
    pair, found, exact, radius = coaxial.first, coaxial.found, any(coaxial.pins), coaxial.first.other.radius
    room, near = _room(known, coaxial, touching, kept)
    if touching or (room is not None and room <= MAX_AXIAL_PLAY * radius):
        return [joint_about(known, coaxial, Stop.FACES, 0.0 if touching else room, room, touching)]
    far = room is not None and room > FAR * radius
    reach = _reach(found, pair)
    middles = [float(pair.other.point @ pair.one.axis)]
    if _is_last(known, known.body[pair.one.part], coaxial.owners):
        middles.append(sum(reach) / 2)  # of two bushes, where an axle with its wheels moves nothing else
    short = not pair.virtual and reach[1] - reach[0] < MIN_GUIDED * radius
    jams = short and room is not None
    centred = not far and not _is_inside(pair, found) and _is_centred(pair, middles)
    flanged = near is not None and near <= MAX_AXIAL_PLAY * radius and are_flanged(known, pair)
    if exact:
        if fastened and near is not None and near <= MAX_LIFT * radius:
            return [joint_about(known, coaxial, Stop.ONE_FACE, near, room)]
        stop = Stop.CENTRED if centred else Stop.SHORT if jams else Stop.BALL_STUD if is_stud(known, pair) else None
        stop = Stop.FLANGES if stop is None and flanged else stop
        return [] if stop is None else [joint_about(known, coaxial, stop, 0.0, room)]
    if jams:
        return [joint_about(known, coaxial, Stop.SHORT, 0.0, room)]
    slides = joint_about(known, coaxial, Stop.NONE, None, room)
    stop = Stop.CENTRED if centred else Stop.NO_STROKE if _has_no_stroke(pair, reach) else None
    stop = Stop.SHORT if stop is None and short else Stop.FLANGES if stop is None and flanged else stop
    return [slides] if pair.virtual or far or stop is None else [slides, joint_about(known, coaxial, stop, 0.0, room)]


def _room(
    known: Known, coaxial: CoaxialFeatures, touching: bool, kept: Sequence[CoaxialFeatures]
) -> tuple[float | None, float | None]:
    """Measure how far faces let two bodies slide on each other in all, and how near they are to a face on either side;
    None without faces."""
    body, pair, hole = known.body, coaxial.first, coaxial.first.other
    rigid = [part for part in known.parts if part.name not in known.springs]
    groups = [_kept_with(owner, coaxial, kept) for owner in known.in_order(coaxial.owners)]
    one, other = (
        [stop for part in rigid if body[part.name] in group for stop in known.measured.stops(part, hole)]
        for group in groups
    )
    room, near = play(one, other, hole.radius), nearest(one, other, hole.radius)
    if not any(coaxial.pins) and not touching and (room is None or room > MAX_AXIAL_PLAY * hole.radius):
        slanted = [
            [stop for part in rigid if body[part.name] in group for stop in known.measured.slanted_stops(part, hole)]
            for group in groups
        ]
        rooms = (room, play([*one, *slanted[0]], [*other, *slanted[1]], hole.radius))
        room = min((each for each in rooms if each is not None), default=None)
    between = None if pair.virtual else _between(known, pair, coaxial.found)
    if between is not None and (between <= MAX_AXIAL_PLAY * hole.radius or not any(coaxial.pins)):
        room = between if room is None else min(room, between)
    grooved = [play for pair, play in known.in_ring_grooves.items() if {body[part] for part in pair} == coaxial.owners]
    return min(each for each in (room, *grooved) if each is not None) if grooved else room, near


def _reach(found: Sequence[CommonAxis], pair: CommonAxis) -> tuple[float, float]:
    """Find where the holes of two bodies begin and end along the axis of the first pin."""
    ends = [end for each in found for end in each.other.reach(pair.one.axis)]
    return min(ends), max(ends)


def _has_no_stroke(pair: CommonAxis, reach: tuple[float, float]) -> bool:
    """Tell whether a pin is about as long as what it is in, and that is short: a wheel on the end of its axle, an arm
    on a peg, and no tube in a tube."""
    if reach[1] - reach[0] > LONGEST_HUB * pair.other.radius:
        return False
    spans = pair.one.spans_along(pair.one.axis)
    ends = [end for span in spans if span[0] < reach[1] and reach[0] < span[1] for end in span]
    return bool(ends) and abs(max(ends) - min(ends) - (reach[1] - reach[0])) <= MAX_AXIAL_PLAY * pair.other.radius


def _is_centred(pair: CommonAxis, middles: Sequence[float]) -> bool:
    """Tell whether the middle of a pin is one of some places along its axis."""
    away = min(abs(float(pair.one.point @ pair.one.axis) - middle) for middle in middles)
    return away <= CENTRED * pair.other.radius


def _is_inside(pair: CommonAxis, found: Sequence[CommonAxis]) -> bool:
    """Tell whether a pin is in one hole only, and ends inside of it on both sides, as a piston does: a cylinder does
    not keep its middle."""
    (low, high), spans = pair.one.reach(pair.one.axis), pair.other.spans_along(pair.one.axis)
    room = min(low - spans[0][0], spans[0][1] - high)
    return len(found) == len(spans) == 1 and room > CENTRED * pair.one.radius


def _kept_with(owner: str, coaxial: CoaxialFeatures, kept: Sequence[CoaxialFeatures]) -> set[str]:
    """Find a body with all that turn on it about a common axis without a slide, but the other body of the two."""
    about = [each for each in kept if each.first.other.on_axis_of(coaxial.first.other) and owner in each.owners]
    return {owner, *(other for each in about for other in each.owners if other not in coaxial.owners)}


def _is_last(known: Known, owner: str, owners: BodyPair) -> bool:
    """Tell whether one of two bodies touches no third one, and has no axis in common with it."""
    body, related = known.body, [*known.touching, *(pair.parts for pair in known.axes)]
    return all(owner not in each or each <= owners for each in ({body[part] for part in pair} for pair in related))


def _between(known: Known, pair: CommonAxis, found: Sequence[CommonAxis]) -> float | None:
    """Find how far a body can slide whose pin is in bores on both sides of it, as a ring between its bearings is."""
    body, axis = known.body, pair.one.axis
    holes = [each.other for each in found if body[each.one.part] == body[pair.one.part]]
    spans = merged(span for hole in holes for span in hole.spans_along(axis))
    if len(spans) < 2:
        return None
    owned = [part for part in known.parts if body[part.name] == body[pair.one.part]]
    return between_bores(owned, pair.one, spans)


def _guided(known: Known, pair: CommonAxis) -> StoppedJoint:
    """Make a prismatic joint along two or more parallel pins with play, such as guide rods."""
    parts = known.in_order(pair.parts)
    joint = pairs.prismatic("-".join(parts), *parts, point=pair.other.point, axis=pair.one.axis)
    sizes = (("radius", pair.other.radius), ("clearance", pair.clearance))
    text = f"parallel pins, one of radius {pair.one.radius:.4g} with a clearance of {pair.clearance:.2g}, guide it"
    evidence = Evidence(EvidenceKind.CLEARANCE, sizes, text)
    return StoppedJoint(Inference.of(joint, evidence), Stop.NONE, replaces_slide=False)


def _walled(known: Known, coaxial: CoaxialFeatures, exact: bool) -> list[StoppedJoint]:
    """Make a prismatic joint along a pin where walls beside the axis keep a body from turning on it, such as a finger
    in a slot, or a jaw with its neck in one; beside a pin with play the walls of the same two parts."""
    pair, body = coaxial.first, known.body
    owners = [body[part] for part in pair.parts]
    one, other = (
        [part for part in known.parts if (body[part.name] == owner if exact else part.name == name)]
        for owner, name in zip(owners, pair.parts, strict=True)
    )
    angle = turns(one, other, pair.other.point, pair.one.axis)
    if angle > MIN_TURN:
        return []
    parts = known.in_order(pair.parts)
    joint = pairs.prismatic("-".join(parts), *parts, point=pair.other.point, axis=pair.one.axis)
    fit = "fits" if exact else f"has a clearance of {pair.clearance:.2g}"
    text = f"the pin of radius {pair.one.radius:.4g} {fit}; walls beside it leave a turn of {angle:.2g} rad"
    evidence = Evidence(EvidenceKind.CLEARANCE, (("radius", pair.other.radius), ("turn", angle)), text)
    return [StoppedJoint(Inference.of(joint, evidence), Stop.FACES, exact)]
