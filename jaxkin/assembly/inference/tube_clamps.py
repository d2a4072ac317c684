"""Clamps on tubes and shafts: halves that screws draw together across a gap, and U-bolts."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import parallel
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.set_screws import FITTED
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.walls import facing
from jaxkin.joints.evidence import Evidence, EvidenceKind

SPLIT = (0.02, 0.5)
"""Gap between two halves over the radius of the tube: that of a bearing in halves is none, and it is not pinched."""


def clamped_halves(known: Known) -> list[Inference]:
    """Join two halves round a tube with the tube, where screws across both draw them together over a gap: that leaves
    nothing but the tube for them to press on. The halves of a bearing lie on each other."""
    result, pieces = [], []
    for pair in known.axes:
        if not pair.virtual and abs(pair.clearance) <= FITTED * pair.other.radius and pair.other.is_half_open:
            pieces.append(pair)
    for one, other in combinations(pieces, 2):
        first, second = one.other.part, other.other.part
        if one.one is not other.one or first == second or frozenset((first, second)) in known.touching:
            continue
        gap = _split(known, one, second)
        if gap is not None:
            tube = one.one.part
            text = f"screws draw {first!r} and {second!r} onto {tube!r}, across a gap of {gap:.2g} between them"
            evidence = Evidence(EvidenceKind.FASTENER, (("radius", one.one.radius), ("gap", gap)), text)
            result.append(Inference(known.in_order((first, second, tube)), evidence))
    return result


def _split(known: Known, pair: CommonAxis, other: str) -> float | None:
    """Measure the gap between one half of a clamp, with its tube, and the other half, which screws across it close;
    None where it is none of a clamp."""
    one, axis = pair.other.part, pair.one
    gaps = [
        (normal, gap)
        for normal, gap, _ in facing(known.solids[one], [known.solids[other]])
        if abs(float(normal @ axis.axis)) < ACROSS and SPLIT[0] <= gap / axis.radius <= SPLIT[1]
    ]
    pins = {id(each.one): each.one for each in known.axes if each.other.part == one and not each.virtual}
    screws = [each.one for each in known.axes if each.other.part == other and id(each.one) in pins]
    closed = [gap for normal, gap in gaps for each in screws if np.linalg.norm(np.cross(normal, each.axis)) < ACROSS]
    return max(closed, default=None)


def u_bolts(known: Known) -> list[Inference]:
    """Join tubes with the U-bolts whose legs they fill, and with what is on both legs: nuts draw that and the bend onto
    the tube. What is narrower than the legs are apart may move between them."""
    on: dict[int, set[str]] = {}
    for pair in known.axes:
        if not pair.virtual:
            on.setdefault(id(pair.one), set()).add(pair.other.part)
    result = []
    for name in known.names:
        legs = [bore for bore in known.bores[name] if id(bore) in on]
        for one, other in combinations(legs, 2):
            held = on[id(one)] & on[id(other)]
            tubes = (bore for part in known.names if part not in (name, *held) for bore in known.bores[part])
            for tube in tubes if held and parallel(one, other) else ():
                if _is_between(tube, one, other) and _is_in_bend(known, name, tube, one):
                    on_both = ", ".join(map(repr, known.in_order(held)))
                    text = f"{name!r} has {tube.part!r} in its bend, and draws {on_both} on both of its legs onto that"
                    evidence = Evidence(EvidenceKind.FASTENER, (("radius", tube.radius),), text)
                    result.append(Inference(known.in_order((name, tube.part, *held)), evidence))
    return result


def _is_between(tube: Bore, one: Bore, other: Bore) -> bool:
    """Tell whether a tube is across two parallel legs and fills the room between them."""
    if tube.hole or abs(float(tube.axis @ one.axis)) > ACROSS:
        return False
    aside = np.cross(tube.axis, one.axis)
    places = [float((leg.point - tube.point) @ aside) for leg in (one, other)]
    short = [abs(abs(place) - leg.radius - tube.radius) for place, leg in zip(places, (one, other), strict=True)]
    return places[0] * places[1] < 0 and max(short) <= FITTED * tube.radius


def _is_in_bend(known: Known, part: str, tube: Bore, leg: Bore) -> bool:
    """Tell whether a part is around a tube, which does not come out on either side along a leg of it."""
    along = (known.solids[part].outermost - tube.point) @ leg.axis
    return bool(min(-along.min(), along.max()) >= tube.radius)
