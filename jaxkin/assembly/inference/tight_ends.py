"""Pins that are tight in one part and have play, or fit exactly, in another one, which turns on them or slides along
them: the tight end holds."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import away_from
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT, is_round_about
from jaxkin.assembly.inference.stop_faces import play

CLOSED = 0.02
"""Play of a part between a head and a collar of its stud, over the radius, that counts as none."""
MAX_RING_LENGTH = 0.4
"""Length of a hole over its diameter, at most, of a ring that is no nut and no end of a rod: nuts have 0.5 to 1."""
MIN_LOOSE = 0.045
"""Clearance of a screw in what it clamps on the end of a rod, over the radius of the hole, at least: M5 to M10 have
0.048 to 0.063 in the fine series of ISO 273."""
SLENDER = 4.0
"""Length of a bar along an axis over its width across, at least, that a screw in its end pulls against a part: links
and levers are wide across the axis that they turn about."""
MIN_PRESS = 2e-4
"""Interference of a press fit over the radius, at least: less is rounding, of the file or of inches."""
MAX_PRESS = 5e-3
"""The same at most: H7/p6 to H7/u6 of 10 to 80 mm have up to 0.0044 by ISO 286. What is thicker by more is a thread,
or a pin that was drawn without a look at its hole."""
MIN_PRESSED = 0.5
"""Length of a pin in a hole that it is pressed into, over its radius, at least: a thin sheet would widen. The crown of
a fork has 1.9."""


def pressed_pins(known: Known) -> list[Inference]:
    """Join pins with the part that they are pressed into, where that is the only one or they have no interference in
    others.

    An interference over a length is friction that nothing turns against; who draws one part tight and the other one
    not means the difference. Where pin and hole are unlike by a standard of inches or by a slip, all parts on the pin
    are tight, or none is.
    """
    result = []
    for pair in known.axes:
        pin, host = pair.parts
        if _is_pressed(known, pair) and _is_pressed_nowhere_else(known, pair):
            text = f"{pin!r} is pressed into {host!r} with an interference of {-pair.clearance:.2g}"
            result.append(_held(known, pair, text))
    return result


def _is_pressed(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a pin has the interference of a press fit in a hole, over a length, and no exact contact there."""
    radius = pair.other.radius
    fit = not pair.virtual and MIN_PRESS * radius <= -pair.clearance <= MAX_PRESS * radius
    return fit and engaged(pair) >= MIN_PRESSED * radius and frozenset(pair.parts) not in known.pinned


def _is_pressed_nowhere_else(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a pin has no interference in the holes of third bodies on the same axis."""
    return all(each.clearance > -MIN_PRESS * each.other.radius for each in _elsewhere(known, pair))


def _elsewhere(known: Known, pair: CommonAxis) -> list[CommonAxis]:
    """Find the holes of third bodies that a pin is in, on the same axis."""
    body = known.body
    return [
        each
        for each in known.axes
        if each.one.part == pair.one.part and not each.virtual and each.one.on_axis_of(pair.one)
        if body[each.other.part] not in {body[part] for part in pair.parts}
    ]


def riveted_studs(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Join studs with the part that they fit exactly, without play between a head and a collar of theirs.

    Heading the end of the stud fills the hole and clamps the part. What turns is the part with play, on another length
    of the same stud.
    """
    result = []
    for pair in known.axes:
        stud, host = pair.parts
        if stud not in fastening or not _is_tight_end(known, pair):
            continue
        one, other = (known.measured.stops(known.solids[part], pair.other) for part in (stud, host))
        room = play(one, other, pair.other.radius)
        if room is not None and room <= CLOSED * pair.other.radius:
            result.append(_held(known, pair, f"{stud!r} is riveted to {host!r}, between its head and its collar"))
    return result


def screwed_on_ends(known: Known) -> list[Inference]:
    """Join shafts with the hubs that fit them exactly, and on which a screw in the end of the shaft lies with its head,
    or with its washer.

    A wheel that turns on its axle, kept there by such a screw, has play, or the axle fits elsewhere as tightly.
    """
    result = []
    for pair in known.axes:
        shaft, hub = pair.parts
        if not _is_tight_end(known, pair):
            continue
        for end in known.axes:
            screw = end.one.part
            if end.virtual or end.other.part != shaft or screw == hub or not end.other.on_axis_of(pair.one):
                continue
            under = {screw, *(each.other.part for each in known.axes if each.one is end.one)} - {shaft, hub}
            washers = {part for part in under if known.touches_across(screw, pair.one.axis, part)}
            if known.touches_across(hub, pair.one.axis, screw, *washers):
                text = f"{screw!r} in the end of {shaft!r} holds {hub!r}, which fits the shaft exactly"
                result.append(_held(known, pair, text))
    return result


def bolted_ends(known: Known) -> list[Inference]:
    """Join rods with the part that they end on, where a screw through that part is tight in the end of the rod.

    Head and rod grip the part on both sides, however loose the screw is in it. What is round about the rod, as a roller
    between the end of its post and a washer, is left to turn, and so are what fits the screw more closely, and links:
    bars on the ends of several rods.
    """
    body, found = known.body, []
    for end in known.axes:
        rod = end.other.part
        if end.virtual or abs(end.clearance) > SAME_FIT * end.other.radius or not _is_rod(known, rod, end.other):
            continue
        if end.other.half < MAX_RING_LENGTH * end.other.radius:
            continue  # a retaining ring on the end of a pin
        found += [(rod, through) for through in known.axes if _grips(known, end, through)]
    ground, result = {body[part] for part in known.fixed}, []
    for rod, through in found:
        screw, part = through.parts
        alone = all(body[other] == body[rod] for other, each in found if each.other.part == part)
        if alone or body[part] in ground:
            text = f"{screw!r} in the end of {rod!r} pulls it against {part!r}"
            result.append(known.fastened(through, text, rod, part))
    return result


def _is_rod(known: Known, part: str, hole: Bore) -> bool:
    """Tell whether a part is round about an axis, or slender along it as a bar between two cheeks is."""
    if is_round_about(known, part, hole):
        return True
    solid = known.solids[part]
    return float(np.ptp(solid.outermost @ hole.axis)) >= SLENDER * 2 * away_from(solid, hole)


def _grips(known: Known, end: CommonAxis, through: CommonAxis) -> bool:
    """Tell whether a screw in the end of a rod goes through another part, which lies between its head and the rod."""
    (screw, rod), part, axis = end.parts, through.other.part, end.one.axis
    if through.one.part != screw or part == rod or not through.one.on_axis_of(end.one):
        return False
    loose = through.clearance >= MIN_LOOSE * through.other.radius
    gripped = all(known.touches_across(each, axis, part) for each in (screw, rod))
    return loose and gripped and not is_round_about(known, part, through.other)


def _is_tight_end(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a pin fits a hole exactly, and another part has play on the same axis of the pin."""
    fit, body = SAME_FIT * pair.other.radius, known.body
    if pair.virtual or abs(pair.clearance) > fit or body[pair.one.part] == body[pair.other.part]:
        return False
    return any(each.clearance > fit for each in _elsewhere(known, pair))


def _held(known: Known, pair: CommonAxis, text: str) -> Inference:
    if any(each.clearance > 0 for each in _elsewhere(known, pair)):
        text += ": what has play on that pin turns"
    return known.fastened(pair, text)
