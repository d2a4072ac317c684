"""What a rolling bearing means for an assembly: one body of all but the outer ring, and one revolute joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from jaxkin.assembly.inference.axes import engaged
from jaxkin.assembly.inference.bearings import Bearing
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind


def bearing_bodies(known: Known, found: Sequence[Bearing]) -> list[Inference]:
    """Join the inner ring of each bearing with its shaft and what is between the rings; the outer one with its
    housing."""
    result = []
    for each in found:
        if each.between:
            result.append(Inference((each.inner, *each.between), _evidence(each, "they turn with the inner ring")))
        shafts = [pair for pair in known.axes if pair.other.part == each.inner and not pair.virtual]
        housings = [pair for pair in known.axes if pair.one.part == each.outer and not pair.virtual]
        for seats, ring in ((shafts, each.inner), (housings, each.outer)):
            if seats:
                seat = max(seats, key=engaged)
                parts = tuple(sorted(seat.parts, key=known.order.__getitem__))
                result.append(Inference(parts, _evidence(each, f"{ring!r} sits on the other one")))
    return result


def bearing_joints(known: Known, found: Sequence[Bearing]) -> list[Inference]:
    """Make a revolute joint for each two bodies that bearings join, however many of them are on their common axis."""
    body, lines, result = known.body, {}, []
    for each in found:
        owners = frozenset((body[each.outer], body[each.inner]))
        if len(owners) < 2 or owners in {frozenset(body[part] for part in pair) for pair in known.by_hand}:
            continue
        if any(each.axis.on_axis_of(line) for line in lines.setdefault(owners, [])):
            continue
        lines[owners].append(each.axis)
        parts = (each.outer, each.inner)
        joint = pairs.revolute("-".join(parts), *parts, point=each.axis.point, axis=each.axis.axis)
        evidence = _evidence(each, "turns in the outer ring")
        result.append(Inference(parts, evidence, replace(joint, evidence=evidence)))
    return result


def _evidence(bearing: Bearing, what: str) -> Evidence:
    of = f"with {bearing.rolling} balls or rollers" if bearing.rolling else "of two rings of one width"
    text = f"a bearing {of}, {bearing.inner!r} inside of {bearing.outer!r}: {what}"
    sizes = (("radius", bearing.axis.radius), ("balls or rollers", float(bearing.rolling)))
    return Evidence(EvidenceKind.BEARING, sizes, text)
