"""What a ball bearing that is drawn as one ring implies: its outside belongs to what it sits in, and in its hole turns
what is there; one by itself is a roller."""

from __future__ import annotations

from collections.abc import Sequence

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.bearings import Ring
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import MAX_LOOSE
from jaxkin.assembly.inference.slide_stops import Stop
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind

MAX_SEAT = 0.05
"""Clearance of a bearing in its seat, over the radius, at most, where the same part holds what is in it more closely:
printed seats have up to 0.03, room about a roller 0.08."""


def in_closed_bearings(known: Known, found: Sequence[Ring]) -> list[CommonAxis]:
    """Find the pins in the holes of bearings: they turn there, and are no body with the ring."""
    names = {each.part.name for each in found}
    return [pair for pair in known.axes if not pair.virtual and pair.other.part in names and pair.one.part not in names]


def closed_bearing_bodies(known: Known, found: Sequence[Ring]) -> list[Inference]:
    """Join each bearing with what its outside sits in."""
    result = []
    for each in found:
        outsides = {id(own) for own in each.coaxial if not own.hole}  # the widest one may be that of a flange
        seats = [pair for pair in known.axes if id(pair.one) in outsides and not pair.virtual]
        seats = [pair for pair in seats if pair.clearance <= MAX_LOOSE * pair.other.radius]
        seats = [pair for pair in seats if not _is_room(known, pair)]
        if seats:
            seat = max(seats, key=engaged)
            text = f"{each.part.name!r} {each.told}, and sits in {seat.other.part!r}"
            result.append(Inference(known.in_order(seat.parts), _evidence(each, text)))
    return result


def _is_room(known: Known, seat: CommonAxis) -> bool:
    """Tell whether what a bearing is in with much play is room for it, and no seat: the same part holds a pin in the
    bearing more closely, as an arm holds the axle of its roller. With both rings in one part it would not turn."""
    if seat.clearance <= MAX_SEAT * seat.other.radius:
        return False
    within = {pair.one.part for pair in known.axes if pair.other.part == seat.one.part and not pair.virtual}
    return any(
        pair.one.part in within and pair.other.part == seat.other.part and pair.clearance < seat.clearance
        for pair in known.axes
        if not pair.virtual and pair.one.on_axis_of(seat.one)
    )


def closed_bearing_joints(known: Known, found: Sequence[Ring]) -> list[StoppedJoint]:
    """Make a revolute joint of each bearing and what turns in it; one for several bearings on an axis of two bodies.

    Of pins that fit exactly it only stops the slide that contacts allow.
    """
    body, lines, result = known.body, {}, []
    of = {each.part.name: each for each in found}
    taken = {*known.jointed}
    for pair in sorted(in_closed_bearings(known, found), key=engaged, reverse=True):
        owners = frozenset(body[part] for part in pair.parts)
        exact = any(owners == {body[part] for part in each} for each in known.pinned)
        others = lines.setdefault(owners, [])
        if len(owners) < 2 or (owners in taken and not others) or any(pair.one.on_axis_of(line) for line in others):
            continue
        others.append(pair.one)
        parts = known.in_order(pair.parts)
        joint = pairs.revolute("-".join(parts), *parts, point=pair.other.point, axis=pair.one.axis)
        text = f"{pair.one.part!r} turns in {pair.other.part!r}, which {of[pair.other.part].told}"
        inference = Inference.of(joint, _evidence(of[pair.other.part], text))
        result.append(StoppedJoint(inference, Stop.BEARING, exact))
    return result


def lone_rollers(known: Known, found: Sequence[Ring]) -> list[Inference]:
    """Make revolute joints of bearings with nothing in them or around them, which lie on one part only, over a hole of
    it: their bolt is not drawn, and they roll on something."""
    body, result = known.body, []
    bored = {part for pair in (*known.axes, *known.tapped) for part in pair.parts}
    for each in found:
        name = each.part.name
        hosts = known.in_order({part for pair in known.touching if name in pair for part in pair} - {name})
        if name in bored or len(hosts) != 1 or body[name] == body[hosts[0]]:
            continue
        under = [bore for bore in known.bores_on(hosts[0], each.hole) if bore.hole]
        if under and known.touches_only_across(name, hosts[0], each.hole.axis):
            parts = known.in_order((name, hosts[0]))
            joint = pairs.revolute("-".join(parts), *parts, point=each.hole.point, axis=each.hole.axis)
            text = f"{name!r} {each.told}, with nothing around it, and lies on {hosts[0]!r} over a "
            text += f"hole of radius {under[0].radius:.4g}, as on a bolt that is not drawn"
            result.append(Inference.of(joint, _evidence(each, text)))
    return result


def _evidence(bearing: Ring, text: str) -> Evidence:
    sizes = (("bore", 2 * bearing.hole.radius), ("outside", 2 * bearing.outside.radius))
    return Evidence(EvidenceKind.BEARING, sizes, text)
