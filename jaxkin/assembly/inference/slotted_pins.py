"""Pins between two walls of another part that look at each other, with play: pins in straight slots."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.axes import MAX_CLEARANCE, MAX_OFFSET, MIN_ENGAGED, CommonAxis
from jaxkin.assembly.inference.bores import MAX_HOLE_ARC, SAME_LENGTH, Bore, merged
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane

MIN_SLOT = 0.25
"""Length over which both walls of a slot are beside each other, over its width, at least: shorter ones make up for
tolerances of holes."""


class SlottedPin(NamedTuple):
    """A pin between two walls of another part."""

    pin: Bore
    part: str
    """The part that has the walls."""
    normal: Vector
    """That of one of the walls."""
    half: float
    """Half the width between the walls."""
    offset: float
    """Distance of the pin from the middle between the walls."""
    span: tuple[float, float]
    """Where pin and walls are beside each other along the axis of the pin, from its middle."""
    length: float
    """Length over which both walls are beside each other along the slot."""

    @property
    def clearance(self) -> float:
        """Half the play of the pin between the walls."""
        return self.half - self.pin.radius

    @property
    def along(self) -> Vector:
        """The direction of the slot, a unit vector."""
        return np.cross(self.normal, self.pin.axis)

    @property
    def middle(self) -> Vector:
        """The point on the axis of the pin in the middle of what is between the walls."""
        return self.pin.point + sum(self.span) / 2 * self.pin.axis


class _Walls(NamedTuple):
    """The plane faces of a part."""

    faces: list[Face]
    normals: Float[np.ndarray, "faces 3"]
    points: Float[np.ndarray, "faces 3"]


def slotted_pins(
    parts: Sequence[Part],
    bores: Mapping[str, Sequence[Bore]],
    beside: Callable[[Part], Sequence[Part]],
    clearance: float | None = None,
) -> list[SlottedPin]:
    """Find the pins that go all the way round and stand between two walls of another part, under the limits of pins in
    round holes.

    `beside` lists the parts near to one. Walls that look at a pin from two directions are those of a square hole, and
    no slot. `clearance` is the largest distance between pin and wall where the pin is in the middle, in the unit of the
    file; by default MAX_CLEARANCE times half the width.
    """
    planes: dict[str, _Walls] = {}
    result = []
    for part in parts:
        pins = [bore for bore in bores[part.name] if not bore.hole and bore.open_arc <= MAX_HOLE_ARC]
        for other in beside(part) if pins else ():
            if other.name not in planes:
                planes[other.name] = _walls_of(other)
            for pin in pins:
                found = _between(pin, other.name, planes[other.name], clearance)
                if found and all(np.linalg.norm(np.cross(each.normal, found[0].normal)) < ACROSS for each in found):
                    result.append(min(found, key=lambda each: each.half))
    return result


def is_slot_end(pair: CommonAxis, slotted: Sequence[SlottedPin], bores: Sequence[Bore]) -> bool:
    """Tell whether a pin is in the half-round end of a slot that is closed on both ends: it is drawn at the end of its
    stroke. `bores` are those of the part that has the hole.

    A hook is open on the other side, and turns on its pin.
    """
    hole = pair.other
    for each in slotted:
        if each.pin is pair.one and each.part == hole.part and abs(each.half - hole.radius) <= MAX_OFFSET * hole.radius:
            ends = [abs(float((end.point - hole.point) @ each.along)) for end in round_ends(each, bores)]
            if any(away > 2 * MIN_SLOT * hole.radius for away in ends):
                return True
    return False


def round_ends(slotted: SlottedPin, bores: Sequence[Bore]) -> list[Bore]:
    """Find the round ends of a slot, as a mill leaves them: half holes as wide as the slot, in the middle between its
    walls. `bores` are those of the part that has the slot."""
    middle = slotted.pin.point @ slotted.normal
    slack = MAX_OFFSET * slotted.half
    return [
        each
        for each in bores
        if each.hole
        and abs(each.radius - slotted.half) <= slack
        and np.linalg.norm(np.cross(each.axis, slotted.pin.axis)) <= ACROSS
        and abs(float(each.point @ slotted.normal - middle)) <= slotted.offset + slack
    ]


def _walls_of(part: Part) -> _Walls:
    faces = [(face, face.surface) for face in part.faces if isinstance(face.surface, Plane)]
    normals, points = (
        np.array([getattr(surface, name) for _, surface in faces]).reshape(-1, 3) for name in ("normal", "point")
    )
    return _Walls([face for face, _ in faces], normals, points)


def _between(pin: Bore, part: str, walls: _Walls, clearance: float | None) -> list[SlottedPin]:
    """Find the pairs of walls that a pin stands between; those that it goes into do not hold it."""
    apart = np.sum((pin.point - walls.points) * walls.normals, axis=1)
    widest = pin.radius / (1 - MAX_CLEARANCE) if clearance is None else pin.radius + clearance
    least, most = pin.radius * (1 - MAX_OFFSET), 2 * widest - pin.radius * (1 - MAX_OFFSET)
    near = np.flatnonzero((np.abs(walls.normals @ pin.axis) <= ACROSS) & (apart >= least) & (apart <= most)).tolist()
    found = []
    for one, other in combinations(near, 2):
        if np.linalg.norm(walls.normals[one] + walls.normals[other]) >= ACROSS:
            continue
        half, offset = (apart[one] + apart[other]) / 2, abs(apart[one] - apart[other]) / 2
        loose = half - pin.radius
        if not -SAME_LENGTH * half <= loose <= widest - pin.radius or offset > max(loose, 0.0) + MAX_OFFSET * half:
            continue
        slack = max(loose, 0.0) + MAX_OFFSET * half  # of a pin at the end of its slot
        beside = _beside(pin, walls.normals[one], (walls.faces[one], walls.faces[other]), 2 * half * MIN_SLOT, slack)
        if beside is not None:
            found.append(SlottedPin(pin, part, walls.normals[one], float(half), float(offset), *beside))
    return found


def _beside(
    pin: Bore, normal: Vector, walls: tuple[Face, Face], least: float, slack: float
) -> tuple[tuple[float, float], float] | None:
    """Find where along its axis a pin is beside both of two walls, or within `slack` of their ends, and the length of
    these beside each other; None where it is not, or where that is less than some length.

    A wall may be in two lugs, as the flanges of two channels in one plane are, with nothing between them.
    """
    across = np.column_stack([np.cross(normal, pin.axis), pin.axis])
    places = [(face.triangles - pin.point) @ across for face in walls]
    low = np.max([each[..., 0].min() for each in places])
    high = np.min([each[..., 0].max() for each in places])
    if not low < slack or not -slack < high or high - low < least:
        return None
    lows, highs = ([end(each[..., 1], axis=1) for each in places] for end in (np.min, np.max))
    first, second = (merged(zip(*ends, strict=True)) for ends in zip(lows, highs, strict=True))
    common = [overlap for one in first for two in second for overlap in _overlap(one, two)]
    engaged = [overlap for one in common for span in merged(pin.spans) for overlap in _overlap(one, span)]
    if sum(end - start for start, end in engaged) <= MIN_ENGAGED * pin.radius:
        return None
    span = min(start for start, _ in engaged), max(end for _, end in engaged)
    return span, float(high - low)


def _overlap(one: tuple[float, float], other: tuple[float, float]) -> list[tuple[float, float]]:
    """List what two spans share: one span, or none."""
    low, high = max(one[0], other[0]), min(one[1], other[1])
    return [(low, high)] if low < high else []
