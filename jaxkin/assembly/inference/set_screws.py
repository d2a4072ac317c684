"""Screws across a shaft, which hold a hub on it: set screws, pins, and those that draw a slit together."""

from __future__ import annotations

from collections.abc import Collection
from itertools import pairwise

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, shared_length
from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore, merged
from jaxkin.assembly.inference.fasteners import beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.motors import screw_holes
from jaxkin.assembly.inference.screwed import MAX_SHORTFALL
from jaxkin.assembly.inference.sleeves import SAME_FIT, is_hollow, is_round, is_round_about
from jaxkin.assembly.inference.slots import walls_beside
from jaxkin.assembly.inference.standing import on_floors
from jaxkin.assembly.inference.stop_faces import ACROSS

FITTED = 0.02
"""Clearance of a shaft or tube in what is clamped on it, or of a thread drawn as a plain cylinder, over the radius: a
bearing in halves that is drawn with a gap has more."""
DRAWN_TOGETHER = 0.05
"""The same of a shaft in a hub with a slit, which a screw draws together."""
MAX_ACROSS = 0.6
"""Radius of the hole of a screw across a shaft, over that of the shaft: those of catalogues have up to a half."""
MAX_TIP = 1.5
"""The same of a screw that is drawn and ends at the shaft: M2 to M3 on motor shafts, needles and wires of 1 to 2 mm."""
MAX_WALL = 0.25
"""Wall between the hole of a screw and that of the shaft, over the radius of the latter, at most: holes of thin shafts
are drawn a tenth of a millimetre short."""
MAX_BESIDE = 3.0
"""Distance of the screw of a slit from the axis of the shaft, over the radius of the shaft, at most."""
MAX_SLIT = 0.5
"""Width of a slit over the radius of the shaft, at most: a fork is wider."""
TIP_SLOT = (0.98, 1.5)
"""Distance of the walls of a slot from the axis of a screw that it guides, over the radius of the tip."""
MIN_STROKE = 2.0
"""Length of such a slot over the width of the tip, at least."""
FILLED = 0.5
"""Share of a hub's hole that its shaft fills, at least: a piston fills less of its cylinder, which has holes across
it, too."""


def clamped_hubs(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Join hubs with the shafts that screws across them hold: set screws and pins that are drawn, and those of slits,
    in any hub; those of round hubs also where only their holes are drawn, radial ones and those of clamps beside the
    shaft. A pin of a slit that is in a lever, too, is that of a quick release, which clamps nothing for good.

    Only with shafts that are round, and with posts: where shaft and motor are one solid, it is the hub that turns on
    it. A post has no screw holes round about it as a motor has, and stands on the floor of its hole under a set screw,
    or in a slit whose screw is drawn, as the steerer of a fork does.
    """
    result, on = [], on_floors(known)
    pins = [
        pair for pair in known.axes if not pair.virtual and abs(pair.clearance) <= DRAWN_TOGETHER * pair.other.radius
    ]
    housed = {pair.one.part for pair in known.axes if not pair.virtual}
    inside: dict[int, set[str]] = {}
    for pair in (*known.axes, *known.tapped):
        if not pair.virtual:
            inside.setdefault(id(pair.other), set()).add(pair.one.part)
    for pair in pins:
        shaft, hub = pair.parts
        own = known.bores_on(shaft, pair.one)
        crossing = [bore for bore in known.bores[hub] if bore.hole and _is_across(bore, pair)]
        turned = is_round(known, shaft, own)
        across = [bore for bore in crossing if bore.radius <= MAX_ACROSS * pair.one.radius]
        slits = [bore for bore in across if _is_slit(known, bore, pair)]
        pinched = any(inside.get(id(bore)) for bore in slits)
        post = (pinched or hub in on.get(shaft, [])) and not screw_holes(known.bores[shaft], pair.one)
        if not crossing or not (turned or post):
            continue
        screws = [screw for bore in crossing if (screw := _screw(known, bore, pair, fastening)) is not None]
        if not turned and not (screws or pinched):
            continue
        around = known.bores_on(hub, pair.other)
        slit = any(not _is_released(known, inside.get(id(bore), ()), {*pair.parts, *fastening}) for bore in slits)
        fitted = abs(pair.clearance) <= FITTED * pair.other.radius
        alone = hub not in housed and any(not bore.hole for bore in around) and is_round(known, hub, around)
        filled = shared_length(pair.one, pair.other) >= FILLED * 2 * pair.other.half
        # what is in a hole across a round hub is its screw, unless it is a pin on which others turn
        clamps = any(_is_clamp(known, bore, pair, inside.get(id(bore), ()), fastening) for bore in across)
        if slit or (fitted and (screws or (alone and filled and clamps))):
            what = f"the screw {screws[0]!r}" if screws else "a screw that is not drawn, in a hole across it,"
            what = "a screw across its slit" if slit and not screws else what
            text = f"{what} holds {hub!r} to {shaft!r}"
            result.append(known.fastened(pair, text, *{*pair.parts, *screws[:1]}))
    return result


def _is_across(hole: Bore, pair: CommonAxis) -> bool:
    """Tell whether a hole of a hub stands across its shaft, where the shaft is: radial, or beside it.

    It comes out at the shaft: a hole that ends before that, as the bore of a cylinder does before the eye in its end,
    leaves a wall between what is in it and the shaft.
    """
    if abs(float(hole.axis @ pair.one.axis)) > ACROSS or hole.radius > MAX_TIP * pair.one.radius:
        return False
    first, last = hole.reach(hole.axis)
    middle = float(pair.other.point @ hole.axis)
    if max(first - middle, middle - last) > (1 + MAX_WALL) * pair.other.radius:
        return False
    height = float(hole.point @ pair.one.axis)
    (low, high), (first, last) = pair.one.reach(pair.one.axis), pair.other.reach(pair.one.axis)
    return max(low, first) < height < min(high, last)


def _from_axis(hole: Bore, pair: CommonAxis) -> float:
    """Measure the distance between the axis of a hole across a shaft and that of the shaft."""
    return abs(float((hole.point - pair.one.point) @ np.cross(hole.axis, pair.one.axis)))


def _is_radial(hole: Bore, pair: CommonAxis) -> bool:
    """Tell whether the axis of a hole across a shaft meets that of the shaft."""
    return _from_axis(hole, pair) <= FITTED * pair.one.radius


def _is_slit(known: Known, hole: Bore, pair: CommonAxis) -> bool:
    """Tell whether the hole of a screw beside a shaft goes across a slit of the hub, which the screw draws together.

    On the far side of the slit it may be as narrow as its thread.
    """
    radius, apart = pair.one.radius, _from_axis(hole, pair)
    along = [each for each in known.bores_on(hole.part, hole) if each.hole]
    spans = merged((span for each in along for span in each.spans_along(hole.axis)), SAME_LENGTH * hole.radius)
    gaps = [low - high for (_, high), (low, _) in pairwise(spans)]
    return radius < apart <= MAX_BESIDE * radius and len(gaps) == 1 and gaps[0] <= MAX_SLIT * radius


def _is_clamp(known: Known, hole: Bore, pair: CommonAxis, pins: Collection[str], fastening: Collection[str]) -> bool:
    """Tell whether a hole across a shaft is that of a screw: one that is not drawn, or a fastener beside the shaft that
    is in no other part."""
    aside = _from_axis(hole, pair) > pair.one.radius
    hosts = {each.other.part for each in known.axes if each.one.part in pins and not each.virtual}
    return not pins or (aside and {*pins} <= {*fastening} and hosts <= {pair.other.part})


def _is_released(known: Known, pins: Collection[str], others: Collection[str]) -> bool:
    """Tell whether a pin goes through a lever, too, which is none of the other parts."""
    return any(
        pair.one.part in pins
        and pair.other.part not in others
        and not is_round_about(known, pair.other.part, pair.other)
        for pair in known.axes
        if not pair.virtual
    )


def _screw(known: Known, hole: Bore, pair: CommonAxis, fastening: Collection[str]) -> str | None:
    """Find the screw or pin in a radial hole whose end is at the shaft, or in it.

    One that is wider than the hole of a set screw ends before the axis of the shaft: its tip presses on the shaft. One
    that ends in a slot along the shaft guides it, and one in a groove round the shaft lets it turn.
    """
    if not _is_radial(hole, pair):
        return None
    inside = [each for each in known.axes if each.other is hole and not each.virtual]
    inside = [each for each in inside if not _runs_in_slot(known, each.one.part, pair)]
    inside = [each for each in inside if (each.one.part, pair.one.part) not in known.in_ring_grooves]
    if any(_interlocks(known, each, pair) for each in inside):
        return None
    for each in inside:
        if each.one.part not in pair.parts and not _is_bush(known, each.one):
            places = [float((each.one.point - pair.one.point) @ hole.axis) + side * each.one.half for side in (-1, 1)]
            nearest = 0.0 if places[0] * places[1] < 0 else min(map(abs, places))
            short = nearest - pair.one.radius
            is_tip = hole.radius <= MAX_ACROSS * pair.one.radius or nearest > 0
            if is_tip and short <= MAX_SHORTFALL * hole.radius and not _passes(known, each, pair, short, fastening):
                return each.one.part
    return None


def _runs_in_slot(known: Known, screw: str, pair: CommonAxis) -> bool:
    """Tell whether a screw ends between two walls of a shaft along its axis, much longer than the tip is wide: a flat
    that a set screw presses on has no walls, and a dimple is no longer than the tip."""
    shaft, axis = known.solids[pair.one.part], pair.one.axis
    tips = [bore for bore in known.bores[screw] if not bore.hole]
    return any(
        abs(normal @ axis) < ACROSS
        for tip in tips
        for normal in walls_beside(tip, shaft, TIP_SLOT, MIN_STROKE * 2 * tip.radius)
    )


def _interlocks(known: Known, pin: CommonAxis, pair: CommonAxis) -> bool:
    """Tell whether a pin in a hole across a shaft ends between it and another shaft of the same part, as the interlock
    of a gear shift does: no side is open to tighten it from, and what else is in its hole closes that."""
    place = float(pair.one.point @ pin.other.axis)
    low, high = pin.one.reach(pin.other.axis)
    shafts = [each for each in known.axes if each.other.part == pair.other.part and beside(each.one, pair.one)]
    crossed = [each for each in shafts if not each.virtual and _is_across(pin.other, each)]
    ends = [float(each.one.point @ pin.other.axis) for each in crossed if _is_radial(pin.other, each)]
    return any(min(place, end) < low and high < max(place, end) for end in ends)


def _passes(known: Known, screw: CommonAxis, pair: CommonAxis, short: float, fastening: Collection[str]) -> bool:
    """Tell whether a pin in the hole of a hub belongs to a third part, which is no nut: it fits that part more tightly,
    as a stem does its disc, or ends `short` of the shaft, as a pivot in the wall of a cylinder does."""
    others = [
        each
        for each in known.axes
        if not each.virtual and each.one.part == screw.one.part and each.other.part not in (*pair.parts, *fastening)
    ]
    tighter = any(each.clearance < screw.clearance - SAME_FIT * screw.other.radius for each in others)
    return tighter or (bool(others) and short > FITTED * pair.one.radius)


def _is_bush(known: Known, pin: Bore) -> bool:
    """Tell whether a pin is the outside of a bush, which presses on no shaft."""
    return is_hollow(known, pin.part, known.bores_on(pin.part, pin))
