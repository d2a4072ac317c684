"""Joints of two bodies about the axis that they have in common."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.axes import MAX_TILT, CommonAxis, shared_length
from jaxkin.assembly.inference.bores import NEAR_LENGTH, SAME_ANGLE, SAME_LENGTH, Bore, merged
from jaxkin.assembly.inference.fasteners import Stack, beside
from jaxkin.assembly.inference.heads import is_exposed
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known, Pair
from jaxkin.assembly.inference.lines import Line, lines
from jaxkin.assembly.inference.slide_stops import Stop, slide_doubt
from jaxkin.assembly.inference.stop_faces import MAX_LIFT, MAX_PLAY, between_bores, nearest, play, stands_across
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

MIN_TURN = 0.05
"""Radians by which a part turns on a hinge with play before faces beside its axis meet, at least."""


MAX_DISC = 0.1
"""Half the thickness of a disc, and its clearance, over the radius of its hole: washers are thinner, and looser."""


class Hinge(NamedTuple):
    """An inferred joint of two bodies about a common axis."""

    inference: Inference
    stop: Stop
    """What is in doubt: see `Stop`."""


def hinges(known: Known, fastening: Collection[str] = (), axes: Sequence[CommonAxis] | None = None) -> list[Hinge]:
    """Infer joints of two bodies about common axes, by default all that are known; some are those of exact contacts but
    for the slide.

    What no face stops at first may be stopped by a third body that turns about the same axis and is kept there, as a
    sun between its bearing and the planet carrier; or bodies stop each other, as the leaves of a hinge do between the
    ends of its pin.
    """
    some = lines(known, axes)
    joined = {line.owners: _joined(known, line, fastening, ()) for line in some}
    kept = [line for line in some if line.is_kept or any(_is_kept(each) for each in joined[line.owners])]
    for line in some:
        if kept and not any(_is_kept(each) for each in joined[line.owners]):
            joined[line.owners] = _joined(known, line, fastening, kept)
    sliding = [line for line in some if any(_slides(each) for each in joined[line.owners])]
    while len(sliding) > 1:  # the largest set of bodies that stop each other
        tried = {line.owners: _joined(known, line, fastening, [*kept, *sliding]) for line in sliding}
        stopped = [line for line in sliding if any(_is_kept(each) for each in tried[line.owners])]
        if len(stopped) == len(sliding):
            joined |= tried
            break
        sliding = stopped
    return [each for some in joined.values() for each in some]


def _is_kept(hinge: Hinge) -> bool:
    return hinge.inference.joint is not None and hinge.inference.joint.kind is JointKind.REVOLUTE


def _slides(hinge: Hinge) -> bool:
    return hinge.inference.joint is not None and hinge.inference.joint.kind is JointKind.CYLINDRICAL


def _joined(known: Known, line: Line, fastening: Collection[str], kept: Sequence[Line]) -> list[Hinge]:
    """Make the joint of two bodies about their axis; `kept` are pairs of bodies that do not slide on each other."""
    pair, pins = line.first, line.pins
    if not line.is_alone:
        return []
    faces = [contact.surfaces[0] for contact in line.touching if contact.contact_state.is_flat]
    planes = [face for face in faces if isinstance(face, Plane)]
    across = [stands_across(plane, pair.one.axis) for plane in planes]
    if not all(across) and (any(across) or any(pins) or not _opens(known, line)):
        return []  # faces along the axis keep it from turning: exact contacts say what is left
    pinned = [each.one for each in line.found if not each.virtual]
    if not any(pins) and any(beside(each, pinned[0]) for each in pinned[1:]):
        return [_guided(known, pair)]
    if not any(pins) and _is_disc(pair):
        return []
    if walled := _walled(known, line, exact=any(pins)):
        return walled
    fastened = pair.one.part in fastening and not _is_rod(known, line)
    return _hinge(known, line, any(across), fastened, kept)


def _is_disc(pair: CommonAxis) -> bool:
    """Tell whether a pin with much play in its hole is a thin disc, such as a washer in a counterbore, which guides
    nothing."""
    return pair.clearance > MAX_DISC * pair.other.radius and pair.one.half < MAX_DISC * pair.one.radius


def _is_rod(known: Known, line: Line) -> bool:
    """Tell whether most of a pin is in no hole, as the stem of a roller is: no thread or ring stops its slide.

    A shaft in bushes is one to turn, however long it is.
    """
    pin, other = line.first.parts
    return other not in known.sleeves and is_exposed(known, Stack((pin,), (other,), line.first.one, guides=True))


def _opens(known: Known, line: Line) -> bool:
    """Tell whether two bodies can turn one way about their axis without cutting into each other: all plane faces that
    meet are on one side of it, as those of a lid that is drawn closed.

    A face with outward normal n meets the other one at distances s from the axis a along a x n; turning by a small
    angle d moves it by -s d along n.
    """
    axis, first, signs = line.first.one, min(line.owners), set[int]()
    for contact in line.touching:
        if not isinstance(contact.surfaces[0], Plane):
            return False
        normal = contact.surfaces[0].normal * (1 if known.body[contact.parts[0]] == first else -1)
        along = np.cross(axis.axis, normal)
        low, high = (float(end - axis.point @ along) for end in known.shared_span(contact, along))
        slack = NEAR_LENGTH * axis.radius
        signs.add(1 if low >= -slack else -1 if high <= slack else 0)
    return len(signs) == 1 and 0 not in signs


def _hinge(known: Known, line: Line, touching: bool, fastened: bool, kept: Sequence[Line]) -> list[Hinge]:
    """Make a revolute joint where faces stop the slide, otherwise a cylindrical one unless contacts say that exactly.

    Faces across the axis that touch stop it, as they do beside a pin that fits exactly.
    """
    body, owners, found, pair, exact = known.body, line.owners, line.found, line.first, any(line.pins)
    hole, rigid = pair.other, [part for part in known.parts if part.name not in known.springs]
    one, other = (
        [stop for part in rigid if body[part.name] in group for stop in known.measured.stops(part, hole)]
        for group in (_kept_with(owner, line, kept) for owner in owners)
    )
    room, stop = play(one, other, hole.radius), Stop.FACES
    ends = [end for each in found for end in each.other.reach(pair.one.axis)]
    middles = [float(hole.point @ pair.one.axis)]
    if _is_last(known, body[pair.one.part], owners):
        middles.append((min(ends) + max(ends)) / 2)  # of two bushes, where an axle with its wheels moves nothing else
    short = not pair.virtual and max(ends) - min(ends) < MIN_GUIDED * hole.radius
    between = None if pair.virtual else _between(known, pair, found)
    if between is not None and between <= MAX_PLAY * hole.radius:
        room = between if room is None else min(room, between)
    free = None if room is None or room > MAX_PLAY * hole.radius else room
    free = 0.0 if touching else free
    far = room is not None and room > FAR * hole.radius
    jams = short and room is not None
    if not exact and free is None and jams:
        free, stop = 0.0, Stop.SHORT
    if exact and free is None:
        if fastened and (gap := nearest(one, other, hole.radius)) is not None and gap <= MAX_LIFT * hole.radius:
            free, stop = gap, Stop.ONE_FACE
        elif not far and not _is_inside(pair, found) and _is_centred(pair, middles):
            free, stop = 0.0, Stop.CENTRED
        elif jams:
            free, stop = 0.0, Stop.SHORT
        else:
            return []
    parts = known.in_order(pair.parts)
    make = pairs.cylindrical if free is None else pairs.revolute
    axis = _line(known, pair, owners)
    middle = axis.point + ((hole.point - axis.point) @ axis.axis) * axis.axis
    joint = make("-".join(parts), *parts, point=middle, axis=axis.axis)
    sizes = [("radius", hole.radius), ("clearance", pair.clearance), ("offset", pair.offset), ("tilt", pair.tilt)]
    ends = "no face stops its slide" if free is None else f"faces stop its slide, with a play of {free:.2g}"
    if exact and stop is Stop.ONE_FACE:
        ends = f"a face {free:.2g} away and the fastener stop its slide"
    elif exact and stop is Stop.CENTRED:
        ends = "the pin and its holes have one middle, where it is taken to stay"
    elif stop is Stop.SHORT:
        ends = f"its hole is shorter than wide and would jam on a slide of {room:.2g} between faces: taken to turn"
    sizes += [] if free is None else [("play", free)]
    if pair.virtual:
        kind, text = EvidenceKind.VIRTUAL_PIN, f"equal bores of radius {hole.radius:.4g} without a pin"
    else:
        how = "a clearance" if pair.clearance >= 0 else "an interference"
        fit = "fits" if exact else f"has {how} of {abs(pair.clearance):.2g} and is {pair.offset:.1g} off"
        kind, text = EvidenceKind.CLEARANCE, f"the pin of radius {pair.one.radius:.4g} {fit}"
    doubt = None if touching else slide_doubt(stop, room, hole.radius)
    evidence = Evidence(kind, tuple(sizes), f"{text}; {ends}", doubt)
    return [Hinge(Inference.of(joint, evidence), stop if exact else Stop.NONE)]


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


def _kept_with(owner: str, line: Line, kept: Sequence[Line]) -> set[str]:
    """Find a body with all that turn on it about the axis of a line without a slide, but the other body of the line."""
    about = [each for each in kept if each.first.other.on_axis_of(line.first.other) and owner in each.owners]
    return {owner, *(other for each in about for other in each.owners if other not in line.owners)}


def _is_last(known: Known, owner: str, owners: Pair) -> bool:
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


def _guided(known: Known, pair: CommonAxis) -> Hinge:
    """Make a prismatic joint along two or more parallel pins with play, such as guide rods."""
    parts = known.in_order(pair.parts)
    joint = pairs.prismatic("-".join(parts), *parts, point=pair.other.point, axis=pair.one.axis)
    sizes = (("radius", pair.other.radius), ("clearance", pair.clearance))
    text = f"parallel pins, one of radius {pair.one.radius:.4g} with a clearance of {pair.clearance:.2g}, guide it"
    evidence = Evidence(EvidenceKind.CLEARANCE, sizes, text)
    return Hinge(Inference.of(joint, evidence), Stop.NONE)


def _walled(known: Known, line: Line, exact: bool) -> list[Hinge]:
    """Make a prismatic joint along a pin where walls beside the axis keep a body from turning on it, such as a finger
    in a slot, or a jaw with its neck in one; beside a pin with play the walls of the same two parts."""
    pair, body = line.first, known.body
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
    return [Hinge(Inference.of(joint, evidence), Stop.FACES if exact else Stop.NONE)]


def _line(known: Known, pair: CommonAxis, owners: Pair) -> Bore:
    """Find the bore whose axis the joint turns about, where those of the two bodies are not quite one.

    It is an axis that parts of both bodies have alike, whatever is off it, such as a bolt. Else it is that of the pin:
    several links on one pin then turn about one axis, by however much their holes are off. Else it is that of the bore
    that is inside of the other one, as the eye is in a fork.
    """
    if pair.offset <= SAME_LENGTH * pair.other.radius:
        return pair.one
    body, near = known.body, (pair.offset + NEAR_LENGTH * pair.other.radius) / pair.one.radius
    around = [bore for part in known.names if body[part] in owners for bore in known.bores[part]]
    around = [bore for bore in around if bore.on_axis_of(pair.one, MAX_TILT, near)]
    around = [bore for bore in around if shared_length(bore, pair.other) > -pair.other.radius]
    for bore in around:
        alike = [each for each in around if each.on_axis_of(bore, SAME_ANGLE, SAME_LENGTH)]
        if {body[each.part] for each in alike} == owners:
            return bore
    if not pair.virtual:
        return pair.one
    reach = {
        owner: [end for bore in around if body[bore.part] == owner for end in bore.reach(pair.one.axis)]
        for owner in owners
    }
    return min((pair.one, pair.other), key=lambda bore: np.ptp(reach[body[bore.part]] or [0.0]))
