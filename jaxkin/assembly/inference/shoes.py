"""Shoes: blocks on a pin of one body, between the walls of a channel of another body, as in the rails of windows."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.fasteners import away_from
from jaxkin.assembly.inference.floating import wall_across
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.stop_faces import ACROSS, MAX_AXIAL_PLAY, WIDER, stands_across
from jaxkin.assembly.inference.walls import Looking, facing, slot_normals
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind


def shoes(known: Known) -> list[Inference]:
    """Infer the turn and the slide of shoes: a shoe turns on the pin, and slides along the walls of the channel.

    The floor of the channel stops it one way along the pin, a collar of the pin the other way; both stay where they are
    since the two bodies lie on each other. Where the pin fits exactly, its contact says that the shoe turns. The block
    of a yoke, which has play between its walls, slides there also where it stands out of them.
    """
    body, tied, result = known.body, known.jointed, []
    for pair in known.axes:
        shoe, axis = known.solids[pair.other.part], pair.one.axis
        carrier = body[pair.one.part]
        if pair.virtual or pair.threaded or frozenset((body[shoe.name], carrier)) in tied:
            continue
        around = known.around(shoe, body)
        for owner, beside in around.items():
            if owner == carrier or frozenset((body[shoe.name], owner)) in tied:
                continue
            looking = facing(shoe, beside)
            wall = wall_across(looking, axis)
            if wall is None:
                continue
            normal, play = wall
            if shoe.name in known.blocks and not _meet(known, shoe.name, owner):
                result.append(_slide(known, shoe, beside[0], np.cross(normal, axis), play))
                tied |= {frozenset((body[shoe.name], owner))}  # along the pin and about it, hinges tell
                continue
            room = _room(looking, facing(shoe, around.get(carrier, ())), axis)
            lying = _lie_on_each_other(known, carrier, owner, axis)
            if not lying or room is None or room > MAX_AXIAL_PLAY * pair.other.radius:
                continue
            result.append(_slide(known, shoe, beside[0], np.cross(normal, axis), play))
            if frozenset(pair.parts) not in known.pinned:
                result.append(_turn(known, pair, room))
            tied |= {frozenset((body[shoe.name], each)) for each in (owner, carrier)}
    return result


def blocks_between_walls(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the parts of the form of a nut that are shoes, too: each is on pins of parts that are no fasteners, and in
    contact with walls of a third part on both sides along the pin, as the block of a quick return is in its lever.

    Or it has play on plain pins, which have no head to clamp it with, and is between such walls in one direction only,
    with or without play: a nut in a pocket has walls all round.
    """
    on: dict[str, list[CommonAxis]] = {}
    for pair in known.axes:
        if not pair.virtual and pair.other.part in fastening:
            on.setdefault(pair.other.part, []).append(pair)
    result = set()
    for name, axes in on.items():
        pins, axis = {pair.one.part for pair in axes}, axes[0].one.axis
        if pins & {*fastening}:
            if _is_loose_on_plain_pins(known, axes) and _is_between_two_walls(known, name, pins, axis):
                result.add(name)
            continue
        beside = {part for each in known.touching if name in each for part in each} - {name, *pins}
        walls = (slot_normals(known.between[frozenset((name, other))], name) for other in beside)
        if any((np.abs(normals @ axis) < ACROSS).any() for normals in walls):
            result.add(name)
    return result


def _is_loose_on_plain_pins(known: Known, axes: Sequence[CommonAxis]) -> bool:
    """Tell whether a part has play on all pins that it is on, and none of these has a head."""
    return all(
        pair.clearance > SAME_FIT * pair.other.radius
        and away_from(known.solids[pair.one.part], pair.one) <= WIDER * pair.one.radius
        for pair in axes
    )


def _is_between_two_walls(known: Known, name: str, pins: Collection[str], axis: Vector) -> bool:
    """Tell whether a part is between walls of a body beside its pins, along the axis of these, in one direction."""
    body, part = known.body, known.solids[name]
    held = {body[pin] for pin in pins}
    around = {owner: beside for owner, beside in known.around(part, body).items() if owner not in held}
    return any(wall_across(facing(part, beside), axis) is not None for beside in around.values())


def _meet(known: Known, part: str, owner: str) -> bool:
    """Tell whether a part has a contact with a body, which says how it moves there."""
    return any(part in pair and owner in {known.body[each] for each in pair} for pair in known.touching)


def _lie_on_each_other(known: Known, one: str, other: str, axis: Vector) -> bool:
    """Tell whether faces across an axis are in contact between two bodies, and nothing else of them is."""
    body = known.body
    planes = [each.surfaces[0] for each in known.contacts if {body[part] for part in each.parts} == {one, other}]
    return bool(planes) and all(stands_across(plane, axis) for plane in planes)


def _room(one: Sequence[Looking], other: Sequence[Looking], axis: Vector) -> float | None:
    """Measure the play along an axis between a face of one body and one of the other, None without such faces."""
    ends = [
        [(float(normal @ axis), gap) for normal, gap, _ in some if np.linalg.norm(np.cross(normal, axis)) < ACROSS]
        for some in (one, other)
    ]
    rooms = [gap + back for way, gap in ends[0] for against, back in ends[1] if way * against < 0]
    return min(rooms, default=None)


def _slide(known: Known, shoe: Part, channel: Part, along: Vector, play: float) -> Inference:
    text = f"{shoe.name!r} is a shoe in a channel of {channel.name!r}, with a play of {play:.2g} between its walls"
    evidence = Evidence(EvidenceKind.CLEARANCE, (("play", play),), text)
    parts = known.in_order((shoe.name, channel.name))
    joint = pairs.prismatic("-".join(parts), *parts, point=shoe.box.mean(axis=0), axis=along)
    return Inference.of(joint, evidence)


def _turn(known: Known, pair: CommonAxis, room: float) -> Inference:
    pin, shoe = pair.parts
    text = f"the shoe {shoe!r} turns on {pin!r}, with a play of {room:.2g} along it between collar and channel"
    sizes = (("radius", pair.other.radius), ("clearance", pair.clearance), ("play", room))
    parts = known.in_order(pair.parts)
    joint = pairs.revolute("-".join(parts), *parts, point=pair.other.point, axis=pair.one.axis)
    return Inference.of(joint, Evidence(EvidenceKind.CLEARANCE, sizes, text))
