"""The body that holds a pin, a screw or a rod, of those that it is in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore
from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.moving_pins import moves_in_holes
from jaxkin.assembly.inference.sleeves import SAME_FIT, is_round_about
from jaxkin.assembly.inference.stop_faces import MAX_AXIAL_PLAY, play
from jaxkin.assembly.inference.ties import first_largest

PRESSED = 0.02
"""Clearance of a ring that is pressed on a pin, over the radius, at most: a spacer has more."""
MIN_PRESSED = 0.55
"""Length of such a ring on the pin, over the radius, at least: a large washer of ISO 7093 has 0.5, and holds no pin."""
BESIDE = 2.0
"""Gap between two arms on one shaft, over its radius, at most: carriages on a rod start farther from its ends."""


def holder_of(known: Known, stack: Stack, body: Mapping[str, str], slides: bool) -> tuple[str | None, str]:
    """Find the part that holds a stack, and how: of the body whose bores reach farthest along the axis.

    A body that is round about the axis, as a roller or a planet is, turns on the stack, and so does one that is on it
    with sleeves only, where there is another one. Of a body that a pin fits exactly, and others with play, it is the
    former: those turn on it; where something may slide on the pin only if the body has a hole shorter than wide. Of
    bodies that fit alike it is a fixed one. Where others slide on the stack, that body reaches farther on both sides,
    or fits more tightly; None if none does.
    """
    along = stack.axis.axis
    reach: dict[str, list[tuple[float, float, str]]] = {}
    fits: dict[str, float] = {}
    bushed: set[str] = set()
    traps: set[str] = set()
    for pair in known.axes:
        for pin, hole in ((pair.one, pair.other), (pair.other, pair.one)):
            if pin.part in stack.fasteners and hole.part in stack.held and hole.part not in known.closed:
                owner = body[hole.part]
                reach.setdefault(owner, []).append((*hole.reach(along), hole.part))
                if (fit := max(pair.clearance, 0.0)) < fits.get(owner, np.inf):
                    fits[owner] = fit
                    (bushed.add if hole.part in known.sleeves else bushed.discard)(owner)
                if slides and is_trapped(known, pin.part, hole):
                    traps.add(owner)
    if not reach:
        others = [part for part in stack.held if part not in known.closed] or stack.held  # either ring may hold it
        return (others[0] if others else None), "only"
    ends = {
        owner: (min(end[0] for end in some), max(end[1] for end in some), some[0][2]) for owner, some in reach.items()
    }
    keepers = _keepers(known, stack, reach, fits)
    rounding = SAME_LENGTH * stack.axis.radius
    widest = first_largest(keepers, lambda owner: ends[owner][1] - ends[owner][0], rounding)
    low, high, part = ends[widest]
    if len(reach) == 1:
        # as a shaft in bushes, also where its collars touch what these are in; a nut is on a sleeve, and not in it
        in_sleeves = all(end[2] in known.sleeves for some in reach.values() for end in some)
        turns = in_sleeves and any(not bore.hole for part in stack.fasteners for bore in known.bores[part])
        moves = turns or moves_in_holes(known, stack, low, high, fits[widest] > SAME_FIT * stack.axis.radius)
        return (None, "") if moves else (part, "only")
    turns = all(end[2] in known.sleeves for end in reach[widest])  # as a shaft in bearings, not as a rod in holes
    others = [ends[owner] for owner in ends if owner != widest]
    grounded = {body[name] for name in known.fixed} & reach.keys()
    # of bodies that fit alike a fixed one, whatever the order of the parts
    tightest = first_largest(
        sorted(fits, key=lambda owner: owner not in grounded), lambda owner: -fits[owner], rounding
    )
    same = SAME_FIT * stack.axis.radius
    jams = ends[tightest][1] - ends[tightest][0] < 2 * stack.axis.radius  # nothing slides on a hole shorter than wide
    exact = [owner for owner, fit in fits.items() if fit <= same]
    if (jams or not slides) and tightest in keepers and exact == [tightest]:
        return ends[tightest][2], "which it fits exactly, and has play in others"
    inside = all(low + rounding < one and other < high - rounding for one, other, _ in others)
    if not slides or (not turns and inside):
        if len(reach) == 2 and grounded and not inside and max(fits.values()) - min(fits.values()) <= same:
            return ends[min(grounded)][2], "as it is fixed, and fits it as the other one does"
        return part, "farthest out"
    looser = [fit for fit in fits.values() if fit > fits[tightest] + same]  # two cranks fit their shaft alike
    if traps - {tightest} or tightest in bushed:
        return None, ""  # as a screw that turns in a slide goes with the slide, and not with its nut
    if looser and not (_slides_between(ends, tightest) and _has_room(ends, fits, same, stack.axis.radius)):
        return ends[tightest][2], "more tightly than by others"
    return (part, "on one end") if looser else (None, "")


def _slides_between(ends: Mapping[str, tuple[float, float, str]], owner: str) -> bool:
    """Tell whether a body is on a rod between others that are on both ends of it, as a linear bearing is."""
    low, high, _ = ends[owner]
    others = [end for other, end in ends.items() if other != owner]
    return any(end[1] <= low for end in others) and any(end[0] >= high for end in others)


def _has_room(
    ends: Mapping[str, tuple[float, float, str]], fits: Mapping[str, float], same: float, radius: float
) -> bool:
    """Tell whether what fits a rod exactly can slide there: not where several bodies do, and each one with play is
    between them or beside one of them, as the arms of a scissor lift are that turn on a shaft across."""
    exact = [ends[owner] for owner, fit in fits.items() if fit <= same]
    if len(exact) < 2:
        return True
    for owner, fit in fits.items():
        low, high, _ = ends[owner]
        gaps = [max(first - high, low - last) for first, last, _ in exact]
        between = min(last for _, last, _ in exact) <= low and high <= max(first for first, *_ in exact)
        if fit > same and not between and min(gaps) > BESIDE * radius:
            return True
    return False


def _keepers(
    known: Known, stack: Stack, reach: Mapping[str, Sequence[tuple[float, float, str]]], fits: Mapping[str, float]
) -> list[str]:
    """Find the bodies that may hold a stack: not those that are round about it, but for one that fits more tightly than
    all others, nor those that are on it with sleeves only, if there are others."""

    def turns(parts: Sequence[str]) -> bool:
        round_ones = all(is_round_about(known, part, stack.axis) for part in parts)
        return round_ones or all(part in known.sleeves for part in parts)

    keeping = [owner for owner, some in reach.items() if not turns([part for *_, part in some])] or list(reach)
    tightest = first_largest(fits, lambda owner: -fits[owner], SAME_LENGTH * stack.axis.radius)
    looser = min((fits[owner] for owner in keeping if owner != tightest), default=0.0) - fits[tightest]
    pressed = tightest not in keeping and looser > SAME_FIT * stack.axis.radius
    pressed = pressed and fits[tightest] <= PRESSED * stack.axis.radius
    length = sum(high - low for low, high, _ in reach[tightest])
    pressed = pressed and length >= MIN_PRESSED * stack.axis.radius
    return [tightest] if pressed and not all(part in known.sleeves for *_, part in reach[tightest]) else keeping


def is_trapped(known: Known, pin: str, hole: Bore) -> bool:
    """Tell whether faces on both sides keep a pin from sliding in the hole of a part, such as those beside a collar."""
    one, other = (known.measured.stops(known.solids[part], hole) for part in (pin, hole.part))
    room = play(one, other, hole.radius)
    return room is not None and room <= MAX_AXIAL_PLAY * hole.radius
