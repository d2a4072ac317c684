"""Pins that fit one part exactly, and have play in another one, which turns on them: the tight end holds."""

from __future__ import annotations

from collections.abc import Collection

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.trapped import play, stands_across
from jaxkin.joints.evidence import Evidence, EvidenceKind

CLOSED = 0.02
"""Play of a part between a head and a collar of its stud, over the radius, that counts as none."""


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
    """Join shafts with the hubs that fit them exactly, and on which the head of a screw in the end of the shaft lies.

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
            if _lies_across(known, screw, hub, pair):
                text = f"{screw!r} in the end of {shaft!r} holds {hub!r}, which fits the shaft exactly"
                result.append(_held(known, pair, text))
    return result


def _is_tight_end(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a pin fits a hole exactly, and another part has play on the same axis of the pin."""
    fit, body = SAME_FIT * pair.other.radius, known.body
    if pair.virtual or abs(pair.clearance) > fit:
        return False
    owners = {body[part] for part in pair.parts}
    return len(owners) == 2 and any(
        each.one.part == pair.one.part
        and not each.virtual
        and each.clearance > fit
        and body[each.other.part] not in owners
        and each.one.on_axis_of(pair.one)
        for each in known.axes
    )


def _lies_across(known: Known, screw: str, hub: str, pair: CommonAxis) -> bool:
    """Tell whether the head of a screw lies flat on a hub, across the axis of its shaft."""
    planes = [each.surfaces[0] for each in known.contacts if {*each.parts} == {screw, hub}]
    return any(stands_across(plane, pair.one.axis) for plane in planes)


def _held(known: Known, pair: CommonAxis, text: str) -> Inference:
    sizes = (("radius", pair.one.radius), ("clearance", pair.clearance))
    text = f"{text}: what has play on that pin turns"
    parts = known.in_order(pair.parts)
    return Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text))
