"""Pins in holes of one body alone that it does not hold: shafts, bars and plungers that slide, wheels with journals."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from jaxkin.assembly.inference.bores import merged
from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import MAX_LIFT, WIDER, nearest

STICKS_OUT = 2.0
"""Length of a loose pin beyond its hole, over its radius, on both sides from which on it is a bar that slides."""


def moves_in_holes(known: Known, stack: Stack, low: float, high: float, loose: bool) -> bool:
    """Tell whether pins move in the holes of the only body that they are in, which reach from `low` to `high` along
    their axis; `loose` ones have play there."""
    slides = loose and stack.guides and _sticks_out(known, stack, low, high)
    return slides or _goes_on(known, stack, low, high) or _is_captive(known, stack) or _is_plunger(known, stack, loose)


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
    """Tell whether a part with play is wider between two of its holes than these are, as a wheel with journals on both
    sides in a housing and its cover is: no fastener goes in there."""
    pairs = [pair for pair in known.axes if pair.one.part in stack.fasteners and pair.other.part in stack.held]
    if len(pairs) < 2 or not all(pair.clearance > 0 for pair in pairs):
        return False
    along = stack.axis.axis
    spans = merged(span for pair in pairs for span in pair.other.spans_along(along))
    widest = max((pair.other for pair in pairs), key=lambda hole: hole.radius)
    for part in {pair.one.part for pair in pairs}:
        way = 1.0 if widest.axis @ along > 0 else -1.0
        faces = [
            way * stop.height
            for stop in known.measured.stops(known.solids[part], widest)
            if stop.outer > WIDER * widest.radius
        ]
        if any(low <= face <= high for (_, low), (high, _) in pairwise(spans) for face in faces):
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
