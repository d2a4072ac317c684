"""Spreaders: plain bars and tubes whose ends are set into two parts far apart, which they hold to each other."""

from __future__ import annotations

from typing import NamedTuple

from jaxkin.assembly.inference.axes import MAX_INTERFERENCE, CommonAxis
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import beside
from jaxkin.assembly.inference.holders import PRESSED
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.sleeves import FLUSH, SAME_FIT, is_round, is_round_about
from jaxkin.joints.evidence import Evidence, EvidenceKind

MIN_APART = 4.0
"""Distance between the two holes along a spreader, over its radius, at least; it is longer than either hole, too.
Levers beside each other turn on a pin, and such far from each other would tilt on it."""
MAX_ROOM = 1.0
"""Distance of an end from the floor of its blind hole, over the radius, at most; of both together less than the play of
a hinge along its axis."""


class _Spreader(NamedTuple):
    """A bar with its ends in two parts."""

    low: CommonAxis
    high: CommonAxis
    blind: bool
    """Whether both ends stand before the floors of their holes."""
    alone: bool
    """Whether nothing else is on the bar."""


def spreaders(known: Known) -> list[Inference]:
    """Join two parts, far apart, with the bar or the tube of one radius that both hold by an end and fit alike.

    The bar ends with the outer faces of both, or before the floors of blind holes. Nothing keeps either part on it, or
    the bar in them, and neither part is on both sides of the other, as a hinge would need: the ends are pressed, glued
    or welded in. Where something else is on the bar, which may turn or slide there, two such bars beside each other are
    asked for, in blind holes. What is round about the bar, as a wheel is, may turn on it.
    """
    body, found = known.body, dict[BodyPair, list[_Spreader]]()
    on: dict[str, list[CommonAxis]] = {}
    for pair in known.axes:
        if not pair.virtual:
            on.setdefault(pair.one.part, []).append(pair)
    for name, pairs in on.items():
        bar = _bar(known, name, pairs)
        if bar is not None and len(owners := frozenset(body[each.other.part] for each in (bar.low, bar.high))) == 2:
            found.setdefault(owners, []).append(bar)
    result = []
    for bars in found.values():
        held = [each for each in bars if each.alone or (each.blind and _has_second(each, bars))]
        for bar in held:
            low, high, name = bar.low.other.part, bar.high.other.part, bar.low.one.part
            where = "before the floors of blind holes" if bar.blind else "flush with their faces"
            text = f"{low!r} and {high!r} hold the two ends of {name!r} alike, {where}, with a clearance of "
            text += f"{max(bar.low.clearance, bar.high.clearance):.2g}"
            sizes = (("radius", bar.low.one.radius), ("clearance", bar.low.clearance))
            parts = known.in_order((low, high, name))
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _has_second(bar: _Spreader, bars: list[_Spreader]) -> bool:
    """Tell whether two bodies have another such bar beside one, which stands before floors, too."""
    return any(each.blind and beside(each.low.one, bar.low.one) for each in bars)


def _bar(known: Known, name: str, pairs: list[CommonAxis]) -> _Spreader | None:
    """Find how a part is a spreader between the parts of two of the holes that it is in; None where it is none."""
    own, pin = known.bores[name], pairs[0].one
    pins = [bore for bore in own if not bore.hole]
    if len(pins) > 1 or not all(bore.on_axis_of(pin) for bore in own) or not is_round(known, name, own):
        return None
    moving = known.sleeves | known.closed | known.springs | {part for ring in known.rings for part in ring}
    fixed = [each for each in pairs if each.other.part not in moving]
    low, high = ([each for each in fixed if _holds(known, each, way) is not None] for way in (-1.0, 1.0))
    if len(low) != 1 or len(high) != 1:
        return None
    one, other = low[0], high[0]
    parts = {one.other.part, other.other.part}
    clear = [each.clearance / pin.radius for each in (one, other)]
    if len(parts) < 2 or min(clear) < -MAX_INTERFERENCE or max(clear) > PRESSED or abs(clear[0] - clear[1]) > SAME_FIT:
        return None
    gap = other.other.reach(pin.axis)[0] - one.other.reach(pin.axis)[1]
    if gap < max(MIN_APART * pin.radius, 2 * one.other.half, 2 * other.other.half):
        return None
    if name in moving - known.sleeves or any(is_round_about(known, part, pin) for part in parts):
        return None
    touching = {part for pair in known.touching if name in pair for part in pair}
    alone = {part for each in pairs for part in each.parts} | touching <= {name, *parts}
    return _Spreader(one, other, all(_holds(known, each, way) for each, way in ((one, -1.0), (other, 1.0))), alone)


def _holds(known: Known, pair: CommonAxis, way: float) -> bool | None:
    """Tell whether a hole holds the end of a pin that is ahead along its axis, or behind it, and whether that stands
    before a floor; None where it does not hold it, or the pin comes out of the hole."""
    pin, hole = pair.one, pair.other
    end, mouth = (_ahead(each, pin, way) for each in (pin, hole))
    inner = _ahead(hole, pin, -way)
    if not -inner < end:  # the hole does not begin behind the end
        return None
    floors = known.measured.stops(known.solids[hole.part], hole)
    turned = 1.0 if hole.axis @ pin.axis > 0 else -1.0
    middle = float(pin.point @ hole.axis)
    for floor in floors:
        height = way * turned * (floor.height - middle)
        looks = floor.forwards == (way * turned < 0)
        if looks and floor.inner < pin.radius / 2 and -FLUSH * pin.radius <= height - end <= MAX_ROOM * pin.radius:
            return True
    return False if abs(mouth - end) <= FLUSH * pin.radius else None


def _ahead(bore: Bore, pin: Bore, way: float) -> float:
    """Measure how far a bore reaches along the axis of a pin, from the middle of that, ahead or behind."""
    low, high = (each - float(pin.point @ pin.axis) for each in bore.reach(pin.axis))
    return high if way > 0 else -low
