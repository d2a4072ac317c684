"""What lies flat on one ring of a rolling bearing: washers, spacers, shoulders and plates, which are clamped to it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.bearings import Bearing
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import MAX_NUT
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.joints.evidence import Evidence, EvidenceKind


def clamped_on_rings(known: Known, found: Sequence[Bearing]) -> list[Inference]:
    """Join each ring of a bearing with what lies flat on it and not on the other ring, through washers and spacers.

    It would rub there otherwise: what turns does so between the rings. A stack ends with the first part that reaches
    farther from the axis than a washer or a spacer does, such as the plate that a bolt holds the wheel to. A seal that
    fits the hole of the housing is pressed in there, and the shaft turns in it.
    """
    result = []
    for each in found:
        seals = _seals(known, each)
        on = {ring: _flat_on(known, ring, each.axis) for ring in (each.inner, each.outer)}
        for ring, other in ((each.inner, each.outer), (each.outer, each.inner)):
            shut_out = {each.inner, each.outer, *each.between, *on[other], *(seals if ring == each.inner else ())}
            stack = _stack(known, ring, each.axis, shut_out)
            if stack:
                parts = known.in_order((ring, *stack))
                text = f"{', '.join(map(repr, stack))} clamped to the ring {ring!r} of a bearing, and not to {other!r}"
                evidence = Evidence(EvidenceKind.BEARING, (("radius", each.axis.radius),), text)
                result.append(Inference(parts, evidence))
    return result


def _seals(known: Known, bearing: Bearing) -> set[str]:
    """Find the slim rings on the axis of a bearing that fit a hole of what its outer ring is in."""
    pairs = [pair for pair in known.axes if not pair.virtual and pair.one.on_axis_of(bearing.axis)]
    housings = {pair.other.part for pair in pairs if pair.one.part == bearing.outer}
    fitted = [pair for pair in pairs if abs(pair.clearance) <= SAME_FIT * pair.other.radius]
    rings = {pair.one.part for pair in fitted if pair.other.part in housings} - {bearing.outer}
    return {part for part in rings if _is_slim(known, part, bearing.axis)}


def _stack(known: Known, ring: str, axis: Bore, shut_out: set[str]) -> list[str]:
    """Find the parts that lie on a ring, and on the washers and spacers among them."""
    found = [ring]
    for part in found:  # grows while it is read
        if part == ring or _is_slim(known, part, axis):
            found += [each for each in _flat_on(known, part, axis) if each not in shut_out and each not in found]
    return found[1:]


def _flat_on(known: Known, part: str, axis: Bore) -> list[str]:
    """Find the parts that lie flat on a part across an axis, and have a hole or a pin there that the axis goes
    through."""
    lying = known.parts_flat_on(part, axis.axis)
    return [other for other in lying if any(_is_around(bore, axis) for bore in known.bores[other])]


def _is_around(bore: Bore, axis: Bore) -> bool:
    """Tell whether an axis goes through a hole or a pin, along it."""
    offset = axis.point - bore.point
    apart = np.linalg.norm(offset - (offset @ bore.axis) * bore.axis)
    return bool(np.linalg.norm(np.cross(bore.axis, axis.axis)) < ACROSS and apart < bore.radius)


def _is_slim(known: Known, part: str, axis: Bore) -> bool:
    """Tell whether a part is a washer or a spacer: it reaches little farther from the axis than its hole."""
    holes = [bore.radius for bore in known.bores[part] if bore.hole and _is_around(bore, axis)]
    corners = known.solids[part].outermost - axis.point
    away = np.linalg.norm(corners - np.outer(corners @ axis.axis, axis.axis), axis=1)
    return bool(holes) and bool(away.max() <= MAX_NUT * min(holes))
