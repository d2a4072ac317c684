"""Pins in holes of one body alone that it does not hold, and rings on its pins: shafts, bars and plungers that slide,
wheels with journals, hubs that a washer keeps on their pin."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import NEAR_LENGTH, Bore, merged
from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.stop_faces import MAX_AXIAL_PLAY, MAX_LIFT, WIDER, nearest, play

STICKS_OUT = 2.0
"""Length of a loose pin beyond its hole, over its radius, on both sides from which on it is a bar that slides."""


def moves_in_holes(known: Known, stack: Stack, low: float, high: float, loose: bool) -> bool:
    """Tell whether pins move in the holes of the only body that they are in, which reach from `low` to `high` along
    their axis; `loose` ones have play there."""
    slides = loose and stack.guides and _sticks_out(known, stack, low, high)
    turns = _is_captive(known, stack) or _is_retained(known, stack)
    return slides or turns or _goes_on(known, stack, low, high) or _is_plunger(known, stack, loose)


def _goes_on(known: Known, stack: Stack, low: float, high: float) -> bool:
    """Tell whether a pin goes on beyond a collar of its own, as a shaft does; a rivet ends with its heads."""
    for pair in known.axes:
        if pair.virtual or pair.one.part not in stack.fasteners or pair.other.part not in stack.held:
            continue
        pin, along = pair.one, stack.axis.axis
        collars = [bore for bore in known.bores_on(pin.part, pin) if not bore.hole and bore.radius > WIDER * pin.radius]
        spans = [span for bore in collars for span in bore.spans_along(along)]
        first, last = pin.reach(along)
        beyond = [start - first for start, end in spans if start + end < 2 * low]
        beyond += [last - end for start, end in spans if start + end > 2 * high]
        if beyond and max(beyond) > STICKS_OUT * pin.radius:
            return True
    return False


def _sticks_out(known: Known, stack: Stack, low: float, high: float) -> bool:
    """Tell whether a pin is out of its holes on both sides, as the bar of a vise is, which slides to and fro."""
    pins = [pair.one for pair in known.axes if pair.one.part in stack.fasteners and not pair.virtual]
    ends = [end for pin in pins for end in pin.reach(stack.axis.axis)]
    return bool(ends) and min(low - min(ends), max(ends) - high) > STICKS_OUT * stack.axis.radius


def _is_captive(known: Known, stack: Stack) -> bool:
    """Tell whether a part is wider between two of its holes than these are, as a wheel with journals on both sides in a
    housing and its cover is, and has play there: no fastener goes in there. What fits them exactly, as a pillar does
    between plates, is such a wheel where a round chamber of the housing is about all that is wider, with a gap."""
    along = stack.axis.axis
    pairs = [pair for pair in known.axes if pair.one.part in stack.fasteners and pair.other.part in stack.held]
    pairs = [pair for pair in pairs if not _is_chamber(pair, pairs)]
    if len(pairs) < 2 or any(pair.clearance < -SAME_FIT * pair.other.radius for pair in pairs):
        return False
    spans = merged(span for pair in pairs for span in pair.other.spans_along(along))
    widest = max((pair.other for pair in pairs), key=lambda hole: hole.radius)
    loose = all(pair.clearance > 0 for pair in pairs)
    way = 1.0 if widest.axis @ along > 0 else -1.0
    for part in {pair.one.part for pair in pairs}:
        stops = [
            stop for stop in known.measured.stops(known.solids[part], widest) if stop.outer > WIDER * widest.radius
        ]
        for (_, low), (high, _) in pairwise(spans):
            if any(low <= way * stop.height <= high for stop in stops) and (
                loose or _is_in_chamber(known, stack, part, widest, sorted((way * low, way * high)))
            ):
                return True
    return False


def _is_chamber(pair: CommonAxis, pairs: Sequence[CommonAxis]) -> bool:
    """Tell whether a pin with play is between narrower holes of others on both sides, as the rim of a wheel is."""
    (low, high), slack = pair.other.reach(pair.one.axis), NEAR_LENGTH * pair.other.radius
    narrower = [each.other for each in pairs if WIDER * each.other.radius < pair.other.radius]
    spans = [span for hole in narrower for span in hole.spans_along(pair.one.axis)]
    between = any(last <= low + slack for _, last in spans) and any(first >= high - slack for first, _ in spans)
    return between and pair.clearance > SAME_FIT * pair.other.radius


def _is_in_chamber(known: Known, stack: Stack, part: str, journal: Bore, heights: Sequence[float]) -> bool:
    """Tell whether a bore of the body that holds a stack goes with a gap round all that a part has between two heights
    on the axis of its journals, beside these."""
    slack, corners = NEAR_LENGTH * journal.radius, known.solids[part].triangles.reshape(-1, 3)
    places = corners @ journal.axis
    away = np.linalg.norm(np.cross(corners - journal.point, journal.axis), axis=1)
    rim = (places >= heights[0] - slack) & (places <= heights[1] + slack) & (away > WIDER * journal.radius)
    first, last, widest = places[rim].min() + slack, places[rim].max() - slack, away[rim].max()
    owners = {known.body[each] for each in stack.held}
    holes = (bore for each in known.names if known.body[each] in owners for bore in known.bores_on(each, journal))
    return any(
        bore.hole
        and not bore.is_half_open
        and bore.radius > widest + SAME_FIT * widest
        and any(start <= first and end >= last for start, end in bore.spans_along(journal.axis))
        for bore in holes
    )


def _is_retained(known: Known, stack: Stack) -> bool:
    """Tell whether a ring has play between a shoulder of the pin that it is on and what lies on the end of that pin, as
    a washer under a screw: the screw clamps the washer, and the pin is longer than the ring so that this turns."""
    for pair in known.axes:
        if pair.virtual or pair.other.part not in stack.fasteners or pair.one.part not in stack.held:
            continue
        hole, host = pair.other, pair.one.part
        flat = (part for part in known.parts_flat_on(host, hole.axis) if part not in stack.fasteners)
        ends = [part for part in flat if known.bores_on(part, hole)]
        own, shoulder, end = (
            [stop for part in parts for stop in known.measured.stops(known.solids[part], hole)]
            for parts in ([hole.part], [host], ends)
        )
        room = play(own, [*shoulder, *end], hole.radius)
        captive = room is not None and NEAR_LENGTH * hole.radius < room <= MAX_AXIAL_PLAY * hole.radius
        # by both together: a nut in a window of what lies there is none
        if captive and all(play(own, alone, hole.radius) is None for alone in (shoulder, end)):
            return True
    return False


def _is_plunger(known: Known, stack: Stack, loose: bool) -> bool:
    """Tell whether pins are in the midst of their holes, with room on both sides: a piston, or the rod of a button. A
    screw ends with its hole on one side, or its head lies on a face; a pin that comes out on both sides is held there.
    One that is not `loose` is deep inside of its hole on both sides."""
    pairs = [pair for pair in known.axes if pair.one.part in stack.fasteners and pair.other.part in stack.held]
    holders = {pair.other.part for pair in pairs}
    flat = (each.parts for each in known.contacts if each.contact_state.is_flat)
    if any({*parts} & {*stack.fasteners} and {*parts} & holders for parts in flat):
        return False
    for pair in pairs:
        (low, high), (first, last) = (bore.reach(pair.one.axis) for bore in (pair.one, pair.other))
        own, other = (known.measured.stops(known.solids[part], pair.other) for part in pair.parts)
        near = nearest(own, other, pair.other.radius)
        inside = np.array([low - first, last - high])
        room = min(*(np.abs(inside) if loose else inside), np.inf if near is None else near)
        if inside.max() < 0 or room <= (MAX_LIFT if loose else STICKS_OUT) * pair.other.radius:
            return False
    return bool(pairs)
