"""Round parts in grooves that are open by half, as axles in the floor of a car and wheels in their arches are, and
between the flanges of a channel, as rollers."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from jaxkin.assembly.inference.axes import shared_length
from jaxkin.assembly.inference.bores import MAX_HOLE_ARC, NEAR_LENGTH, Bore
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import is_round_about
from jaxkin.assembly.inference.walls import MAX_SIDE_PLAY
from jaxkin.geometry.outline import widest_gap

MIN_CHANNEL = 2.0
"""Length of both flanges of a channel over the width between them, from which on what is between them travels: nuts and
spacers fill their pockets."""


def in_grooves(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the parts of the form of a fastener that are in nothing but grooves of one body, which are open by half.

    No fastener is held there, since it would fall out: what lies in such a groove turns. Grooves of two parts of the
    body that are round a pin together are a whole hole of it, as those of a dowel half in a bush and half in what that
    is pressed into; not round a shaft, which comes out of its halves on both sides.
    """
    body, result = known.body, set[str]()
    for name in fastening:
        pairs = [pair for pair in known.axes if name in pair.parts and not pair.virtual]
        holes = [pair.other for pair in pairs if pair.one.part == name]
        if not holes or len(holes) < len(pairs) or len({body[hole.part] for hole in holes}) > 1:
            continue
        if all(hole.is_half_open for hole in holes) and not _is_whole(known, pairs[0].one, holes):
            result.add(name)
    return result


def _is_whole(known: Known, pin: Bore, halves: Sequence[Bore]) -> bool:
    """Tell whether grooves go round a pin together, along a length that all have, out of which it does not come on both
    sides."""
    first, axis = max(halves, key=lambda each: each.half), pin.axis
    if not all(each.on_axis_of(first) and shared_length(each, first) > first.half for each in halves):
        return False
    corners = [
        face.triangles.reshape(-1, 3)
        for each in halves
        for face in known.solids[each.part].faces
        if face.name in each.faces
    ]
    around = np.concatenate(corners) - pin.point
    x = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    if widest_gap(np.arctan2(around @ np.cross(axis, x), around @ x)) > MAX_HOLE_ARC:
        return False
    heights = known.solids[pin.part].outermost @ axis
    ends = [each.reach(axis) for each in halves]
    beyond = min(low for low, _ in ends) - heights.min(), heights.max() - max(high for _, high in ends)
    return bool(min(beyond) <= NEAR_LENGTH * pin.radius)


def rollers_in_channels(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the rollers of the form of a nut: round rings on a stub, which is no fastener, between the flanges of a
    channel of a third body, with no more play than what slides between walls.

    A nut has room for a wrench about it, and none to travel.
    """
    body, result = known.body, set[str]()
    slotted = {}
    for each in known.measured.slotted_pins(known.clearance):
        width = 2 * each.half
        if 2 * each.clearance <= MAX_SIDE_PLAY * width and each.length >= MIN_CHANNEL * width:
            slotted.setdefault(each.pin.part, []).append(each)
    for pair in known.axes:
        name, stub = pair.other.part, pair.one
        if pair.virtual or name not in fastening or stub.part in fastening or not is_round_about(known, name, stub):
            continue
        third = (each for each in slotted.get(name, ()) if body[each.part] not in (body[name], body[stub.part]))
        if any(each.pin.on_axis_of(stub) for each in third):
            result.add(name)
    return result
