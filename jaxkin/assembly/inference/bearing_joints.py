"""What a rolling bearing means for an assembly: one body of all but the outer ring, and one revolute joint."""

from __future__ import annotations

from collections.abc import Sequence

from jaxkin.assembly.inference.axes import MAX_CLEARANCE, MAX_INTERFERENCE, MAX_TILT, CommonAxis, apart, engaged
from jaxkin.assembly.inference.bearings import Bearing
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind

MAX_SHIFT = 0.1
"""Distance of the axis of a shaft from that of the ring that it goes through, over the radius of the ring, at most."""


def bearing_bodies(known: Known, found: Sequence[Bearing]) -> list[Inference]:
    """Join the inner ring of each bearing with its shaft and what is between the rings; the outer one with its
    housing."""
    result = []
    for each in found:
        if each.between:
            result.append(Inference((each.inner, *each.between), _evidence(each, "they turn with the inner ring")))
        shafts = _centred(known, each.inner) or _off_centre(known, each.inner)
        housings = [pair for pair in known.axes if pair.one.part == each.outer and not pair.virtual]
        for seats, ring in ((shafts, each.inner), (housings, each.outer)):
            if seats:
                seat = max(seats, key=engaged)
                parts = known.in_order(seat.parts)
                result.append(Inference(parts, _evidence(each, f"{ring!r} sits on the other one")))
    return result


def _centred(known: Known, ring: str) -> list[CommonAxis]:
    """Find the pins in the hole of an inner ring."""
    return [pair for pair in known.axes if pair.other.part == ring and not pair.virtual]


def _off_centre(known: Known, ring: str) -> list[CommonAxis]:
    """Find the pins of other parts in the hole of an inner ring that are farther off its axis than pins in their holes
    are: what goes through such a ring is its shaft."""
    result = []
    for hole in (bore for bore in known.bores[ring] if bore.hole):
        for part in known.measured.beside(known.solids[ring]):
            for pin in (bore for bore in known.bores[part.name] if not bore.hole):
                offset, tilt = apart(pin, hole)
                pair = CommonAxis(pin, hole, offset, tilt)
                fits = -MAX_INTERFERENCE * hole.radius <= pair.clearance <= MAX_CLEARANCE * hole.radius
                if fits and tilt <= MAX_TILT and offset <= MAX_SHIFT * hole.radius and engaged(pair) > hole.half:
                    result.append(pair)
    return result


def bearing_joints(known: Known, found: Sequence[Bearing]) -> list[Inference]:
    """Make a revolute joint for each two bodies that bearings join, however many of them are on their common axis."""
    body, lines, result = known.body, {}, []
    for each in found:
        owners = frozenset((body[each.outer], body[each.inner]))
        if len(owners) < 2 or owners in {frozenset(body[part] for part in pair) for pair in known.by_hand}:
            continue
        shafts = [] if _centred(known, each.inner) else _off_centre(known, each.inner)
        axis = max(shafts, key=engaged).one if shafts else each.axis  # what else the shaft is in shares its axis
        if any(axis.on_axis_of(line) for line in lines.setdefault(owners, [])):
            continue
        lines[owners].append(axis)
        parts = (each.outer, each.inner)
        joint = pairs.revolute("-".join(parts), *parts, point=axis.point, axis=axis.axis)
        evidence = _evidence(each, "turns in the outer ring")
        result.append(Inference.of(joint, evidence))
    return result


def _evidence(bearing: Bearing, what: str) -> Evidence:
    of = f"with {bearing.rolling} balls or rollers" if bearing.rolling else "of two rings of one width"
    text = f"a bearing {of}, {bearing.inner!r} inside of {bearing.outer!r}: {what}"
    sizes = (("radius", bearing.axis.radius), ("balls or rollers", float(bearing.rolling)))
    return Evidence(EvidenceKind.BEARING, sizes, text)
