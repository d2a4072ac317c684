"""Sleeves: bushes, liners and nuts in a hole of one part, round a pin or a hole of another."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.axes import MIN_ENGAGED, CommonAxis, apart, engaged, shared_length
from jaxkin.assembly.inference.bearings import ROUND
from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore, merged
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS, play
from jaxkin.geometry.surfaces import Plane

MAX_LOOSE = 0.1
"""Clearance of a sleeve in its hole, over the radius of the hole, at most: what has more, as a horn or a hub in a wide
opening, is no bush of that hole."""
SAME_FIT = 0.002
"""Clearances that differ by less, over the radius, are one fit: the loosest press fit of a tolerance table."""
MIN_HOLLOW = 0.8
"""Share of the length of a sleeve that its holes have, at least: the rest is chamfers."""
GROOVE = 0.5
"""Play of a ring along the groove that it is in, over its width, at most."""
RIB = 1.2
"""Farthest a sleeve reaches from its axis, over its radius: with the rib of a nut that a slot keeps from turning. Keys
of DIN 6885 stand out of the shaft by up to a fifth of its radius."""
FLUSH = 0.1
"""A sleeve that ends where its hole does, within so much over its radius, is set into the hole from there."""


class Sleeve(NamedTuple):
    """A round part with a hole, in a hole of another part."""

    part: str
    housing: CommonAxis
    """The outside of the sleeve and the hole that it is in."""
    pin: CommonAxis | None
    """What goes through the sleeve, where something does."""


def sleeves(known: Known) -> list[Sleeve]:
    """Find the sleeves among the parts that are round: their outside in a hole, and a hole of their own on that
    axis."""
    pins = [pair for pair in known.axes if not pair.virtual and not pair.threaded]
    axles, result = hollow_axles(known), []
    for name in known.names:
        outside = [pair for pair in pins if pair.one.part == name and pair.clearance <= MAX_LOOSE * pair.other.radius]
        outside = [pair for pair in outside if pair.other.part not in known.closed]
        if not outside or name in axles or name in known.closed:
            continue
        housing = min(outside, key=lambda pair: (abs(pair.clearance), -engaged(pair)))
        own = known.bores_on(name, housing.one)
        if not any(bore.hole for bore in own) or _carries(known, name, housing):
            continue
        if is_round(known, name, own, RIB) and is_hollow(known, name, own):
            through = [pair for pair in pins if pair.other.part == name and pair.other in own]
            pin = min(through, key=lambda pair: (abs(pair.clearance), -engaged(pair)), default=None)
            result.append(Sleeve(name, housing, pin))
    return result


def driven_sleeves(known: Known, found: list[Sleeve]) -> set[str]:
    """Find the sleeves that something turns in their hole: with plane faces along their axis in contact with another
    part than their housing, such as the square of a hollow shaft in its wheel, or with pins in their slots, such as the
    ring of an iris."""
    flat = [each for each in known.contacts if each.contact_state.is_flat]
    result = set()
    for sleeve in found:
        housing, axis = sleeve.housing.other.part, sleeve.housing.one.axis
        beside = {housing, *(each.part for each in found)} - {sleeve.part}  # half-shells touch where they are split
        planes = [each.surfaces[0] for each in flat if sleeve.part in each.parts and not beside & {*each.parts}]
        if any(isinstance(each, Plane) and abs(float(each.normal @ axis)) < ACROSS for each in planes):
            result.add(sleeve.part)
    return result | {sleeve.part for sleeve in found if _is_unison_ring(known, sleeve)}


def _is_unison_ring(known: Known, sleeve: Sleeve) -> bool:
    """Tell whether two or more parts have pins in slots of a sleeve, as blades have in the ring that moves them all.

    Screws that hold a ring by its slots go on into holes of its housing.
    """
    slotted = [each for each in known.measured.slotted_pins(known.clearance) if each.part == sleeve.part]
    housing = sleeve.housing.other.part
    held = [pair.one for pair in known.axes if pair.other.part == housing and not pair.virtual]
    free = [each.pin for each in slotted if not any(each.pin.on_axis_of(pin) for pin in held)]
    return len({pin.part for pin in free} - {housing}) > 1


def seated_sleeves(known: Known, found: list[Sleeve]) -> list[Inference]:
    """Join each sleeve with the part that it is in, or with the pin that it is on.

    It sits where it fits more tightly. Where it fits both alike, it is set into its hole, but for a ring in a groove of
    the pin: that is held between faces of the pin, and not where its hole ends; a ring of a piston fits its groove less
    tightly than the cylinder. Where the pin fills the same hole, as a piston beside its gland, the hole is one to slide
    in, and nothing is set into it but where it ends; the same holds of a piston that is a ring on its rod. A flange
    that two or more parallel axes hold to another part is screwed on there. What is on the shaft of a motor that is one
    solid with it turns there, and so does a ring with play round a part and inside of the same one.
    """
    result = []
    for each in found:
        if _is_flange(known, each) or _turns_between(known, each):
            continue
        seat, why = each.housing, "set into the hole of"
        if each.pin is not None and frozenset(each.pin.parts) not in known.driven:
            looser = max(each.housing.clearance, 0.0) - max(each.pin.clearance, 0.0)
            if looser > SAME_FIT * each.housing.one.radius:
                seat, why = each.pin, "tighter on the pin of"
            elif _in_groove(known, each.housing, each.pin, abs(looser) <= SAME_FIT * each.housing.one.radius):
                seat, why = each.pin, "held in a groove of"
            elif _is_piston(known, each, found):
                seat, why = each.pin, "the piston on"
        if seat is each.housing and _is_shared(known, each) and not _is_flush(each.housing):
            continue
        host = seat.other.part if seat is each.housing else seat.one.part
        text = f"the sleeve {each.part!r} is {why} {host!r}, with a clearance of {seat.clearance:.2g}"
        result.append(known.fastened(seat, text))
    return result


def _turns_between(known: Known, sleeve: Sleeve) -> bool:
    """Tell whether one body is round a sleeve and inside of it, with play on both sides: the scroll of a chuck, a worm
    ring, a turntable. What is pressed in, or is screwed there, has a seat without play on one side at least."""
    if sleeve.pin is None or known.body[sleeve.pin.one.part] != known.body[sleeve.housing.other.part]:
        return False
    return min(sleeve.pin.clearance, sleeve.housing.clearance) > SAME_LENGTH * sleeve.pin.one.radius


def sliding_rods(known: Known, found: list[Sleeve]) -> set[str]:
    """Find the rods that slide in the hole that a sleeve on them is in, too: the hole does not hold them."""
    return {each.pin.one.part for each in found if each.pin and _is_shared(known, each)}


def barrels(found: list[Sleeve]) -> set[str]:
    """Find the tubes with a sleeve in the end of their hole and something through that: the gland of a cylinder or an
    actuator. A tube is no nut of what is in it."""
    return {each.housing.other.part for each in found if each.pin and _is_flush(each.housing)}


def _is_shared(known: Known, sleeve: Sleeve) -> bool:
    """Tell whether the part in a sleeve is also in the hole that the sleeve is in."""
    if sleeve.pin is None:
        return False
    hole, inner = sleeve.housing.other, sleeve.pin.one.part
    pairs = (pair for pair in known.axes if not pair.virtual and pair.one.part == inner)
    return any(pair.other.part == hole.part and pair.other.faces == hole.faces for pair in pairs)


def hollow_axles(known: Known) -> set[str]:
    """Find the parts with a hole that are held on both sides of a hole that they are in: what is there turns on them.
    A pin whose hole is plugged, as by a grease nipple, is none."""
    result = set()
    for pair in known.axes:
        name, along = pair.one.part, pair.one.axis
        if pair.virtual or not any(
            bore.hole and id(bore) not in known.plugged for bore in known.bores_on(name, pair.one)
        ):
            continue
        low, high = pair.other.reach(along)
        others = [each.other for each in known.axes if each.one.part == name and each.other.part != pair.other.part]
        ends = [span for hole in others if hole.on_axis_of(pair.one) for span in hole.spans_along(along)]
        if any(last <= low for _, last in ends) and any(first >= high for first, _ in ends):
            result.add(name)
    return result


def hollow_pins(known: Known, axles: Collection[str]) -> set[str]:
    """Find those of some hollow axles in whose bore nothing lies, and that no bore of another part is in line with, as
    that of a bolt which is not drawn: they are hollow to be light, as the gudgeon pins of pistons are, and pins as
    solid ones are."""
    lined = {id(bore) for pair in (*known.axes, *known.tapped) for bore in (pair.one, pair.other)}
    result = set()
    for name in axles:
        beside = [bore for part in known.measured.beside(known.solids[name]) for bore in known.bores[part.name]]
        pin = max((bore for bore in known.bores[name] if not bore.hole), key=lambda bore: bore.half)
        holes = [bore for bore in known.bores_on(name, pin) if bore.hole]
        if not any(id(hole) in lined or any(_lies_in(bore, hole) for bore in beside) for hole in holes):
            result.add(name)
    return result


def _lies_in(pin: Bore, hole: Bore) -> bool:
    """Tell whether a pin of another part is in a hole, along it, however loose it is there."""
    if pin.hole or pin.radius > hole.radius:
        return False
    offset, tilt = apart(pin, hole)
    within = tilt < ACROSS and offset + pin.radius <= hole.radius
    return within and shared_length(pin, hole) > MIN_ENGAGED * hole.radius


def is_round(known: Known, name: str, own: list[Bore], most: float = ROUND) -> bool:
    """Tell whether a part with these bores is round about the axis of its widest pin, from which it reaches no farther
    than `most` of the radius of that."""
    widest = max((bore for bore in own if not bore.hole), key=lambda bore: bore.radius)
    corners = known.solids[name].outermost - widest.point
    away = np.linalg.norm(corners - np.outer(corners @ widest.axis, widest.axis), axis=1)
    return bool(away.max() <= most * widest.radius)


def is_round_about(known: Known, part: str, axis: Bore) -> bool:
    """Tell whether a part is round about an axis, as a roller or a pulley is."""
    own = known.bores_on(part, axis)
    return any(not bore.hole for bore in own) and is_round(known, part, own)


def is_hollow(known: Known, name: str, own: list[Bore]) -> bool:
    """Tell whether holes go through a part along the axis that they have in common; a shaft with a hole for a screw in
    its end is no sleeve."""
    along = own[0].axis
    heights = known.solids[name].outermost @ along
    through = merged(span for bore in own if bore.hole for span in bore.spans_along(along))
    return sum(high - low for low, high in through) >= MIN_HOLLOW * float(np.ptp(heights))


def _carries(known: Known, name: str, housing: CommonAxis) -> bool:
    """Tell whether a pin across a round part is also in a hole of a third part, as that of a piston is in its rod, or
    its hole has the axis of one there: it slides with what it carries."""
    across = [bore for bore in known.bores[name] if bore.hole and abs(bore.axis @ housing.one.axis) < ACROSS]
    for pair in known.axes:
        if pair.one in across or pair.other in across:
            inside = {*pair.parts} - {name} if pair.virtual else _around(known, pair.one)
            if inside - {name, housing.other.part}:
                return True
    return False


def _is_flange(known: Known, sleeve: Sleeve) -> bool:
    """Tell whether two or more parallel axes beside that of a sleeve are those of one other part, too."""
    return max(flanged_to(known, sleeve.part, sleeve.housing.one).values(), default=0) > 1


def flanged_to(known: Known, part: str, axis: Bore) -> dict[str, int]:
    """Count the holes of a part beside an axis that are in line with holes of each other part, or with its pins."""
    beside: dict[str, int] = {}
    for pair in (*known.axes, *known.tapped):
        for own, other in ((pair.one, pair.other), (pair.other, pair.one)):
            if own.part == part and own.hole and not own.on_axis_of(axis):
                for host in {other.part} if other.hole else _around(known, other):
                    beside[host] = beside.get(host, 0) + 1
    return {host: count for host, count in beside.items() if host != part}


def _around(known: Known, pin: Bore) -> set[str]:
    """Find the parts in whose holes a pin is."""
    return {pair.other.part for pair in known.axes if pair.one.part == pin.part and pair.one.on_axis_of(pin)}


def _is_flush(housing: CommonAxis) -> bool:
    """Tell whether a sleeve ends where the hole does that it is in."""
    (low, high), (first, last) = (bore.reach(housing.one.axis) for bore in (housing.one, housing.other))
    return min(abs(low - first), abs(last - high)) <= FLUSH * housing.one.radius


def _is_piston(known: Known, sleeve: Sleeve, found: list[Sleeve]) -> bool:
    """Tell whether a sleeve is inside of a hole that ends with another one, round a thicker length of the same pin: the
    gland, through which the rod of a piston comes out."""
    hole, pin = sleeve.housing.other, sleeve.pin
    if pin is None or _is_flush(sleeve.housing):
        return False
    glands = {each.part for each in found if each.housing.other is hole and _is_flush(each.housing)} - {sleeve.part}
    return any(
        each.other.part in glands and each.one.part == pin.one.part and each.one.radius > pin.one.radius
        for each in known.axes
        if not each.virtual  # the gland's packing may fit it more tightly than the rod does
    )


def _in_groove(known: Known, housing: CommonAxis, pin: CommonAxis, alike: bool) -> bool:
    """Tell whether faces of the pin hold a sleeve on both sides, inside of a hole that goes on beyond it; closely where
    the fits on pin and hole are not `alike`."""
    (low, high), (first, last) = (bore.reach(housing.one.axis) for bore in (housing.one, housing.other))
    if min(low - first, last - high) <= FLUSH * housing.one.radius:
        return False
    one, other = (known.measured.stops(known.solids[part], housing.other) for part in (housing.one.part, pin.one.part))
    room = play(one, other, housing.one.radius)
    return room is not None and (alike or room <= GROOVE * 2 * housing.one.half)
