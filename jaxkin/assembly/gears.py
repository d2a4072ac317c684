"""Gears proposed from solids: parts with teeth, about axes of joints, whose pitch circles touch.

Teeth are counted in sections across the axes (`jaxkin.geometry.teeth`). That two wheels mesh is not known from that, so
nothing is coupled before somebody says so:

    mechanism = mechanism.with_couplings([each.coupling for each in jk.gear_proposals(mechanism)])
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations, product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin.assembly.gear_proposal import GearProposal, Meshing
from jaxkin.assembly.racks import rack_proposal
from jaxkin.assembly.toothed_parts import MODULE, PARALLEL_AXES, Turn, is_around, slides_of, turns_of
from jaxkin.geometry.part import Part, box_corners, size
from jaxkin.geometry.pose import Points
from jaxkin.geometry.teeth import Teeth, find_teeth
from jaxkin.joints.coupling import Coupling, gear, relation
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

COAXIAL = 1e-4
"""Distance between axes that count as one, and by which axes of bevel wheels miss each other, over the assembly's size:
twice what drawn clearances leave."""
MIN_TRIANGLES = 60
"""Triangles of a part with teeth, at least: two flanks and a tip on each of six teeth."""
MIN_FACES = 12
"""The same of faces, two flanks on each of six teeth, where no face is a free form, which may go round all teeth."""


class _Pair(NamedTuple):
    """Two meshing outlines."""

    teeth: tuple[Teeth, Teeth]
    meshing: Meshing
    module: float
    senses: float
    """+1 where positive turns about the two axes go together, -1 where they go against each other."""


def gear_proposals(mechanism: Mechanism) -> tuple[GearProposal, ...]:
    """Propose gears between toothed parts of a mechanism with solids; none is assumed anywhere.

    Two parts are a gear where both have teeth about the axis of a joint, their pitch circles touch, and a body carries
    both axes: outer teeth, a ring with inner teeth, or bevel wheels whose axes meet. A wheel whose carrier turns about
    the other one's axis, such as a planet, is coupled by the equation of Willis. A part with teeth in a row along its
    slide, at the pitch circle of a wheel on the same carrier, is a rack. Of a sector its teeth are counted, and those
    that a full turn would have follow from their distance. Worm gears are not looked for. `print` of a proposal shows
    both numbers of teeth and the equation.
    """
    body = body_of_parts(mechanism.bodies)
    turns = turns_of(mechanism, body)
    largest = size(mechanism.solids) if mechanism.solids else 0.0
    toothed = [part for part in mechanism.solids if turns.get(body.get(part.name, "")) and _has_flanks(part)]
    found = []
    for one, other in combinations(toothed, 2):
        if body[one.name] == body[other.name] or not _boxes_meet(one, other):
            continue
        if proposal := _proposed(one, other, turns[body[one.name]], turns[body[other.name]], turns, largest):
            found.append(proposal)
    slides = slides_of(mechanism, body)
    sliding = [part for part in mechanism.solids if slides.get(body.get(part.name, "")) and _has_flanks(part)]
    for wheel, row in product(toothed, sliding):
        if body[wheel.name] != body[row.name] and _boxes_meet(wheel, row):
            pairs = product(turns[body[wheel.name]], slides[body[row.name]])
            proposals = (rack_proposal(wheel, row, turn, slide) for turn, slide in pairs)
            found += [each for each in proposals if each][:1]
    return tuple(found)


def _has_flanks(part: Part) -> bool:
    """Tell whether a part has as many triangles, and as many faces where all are analytic, as the fewest teeth need."""
    exact = sum(len(face.triangles) for face in part.faces) == len(part.triangles)
    return len(part.triangles) >= MIN_TRIANGLES and not (exact and len(part.faces) < MIN_FACES)


def _boxes_meet(one: Part, other: Part) -> bool:
    return bool(np.all(one.box[0] <= other.box[1]) and np.all(other.box[0] <= one.box[1]))


def _proposed(
    one: Part,
    other: Part,
    turns_1: list[Turn],
    turns_2: list[Turn],
    turns: Mapping[str, list[Turn]],
    largest: float,
) -> GearProposal | None:
    """Propose a gear of two parts, about the first axes that fit; None where none do."""
    for turn_1, turn_2 in product(turns_1, turns_2):
        ties = list(_ties(turn_1, turn_2, turns, COAXIAL * largest))
        if ties and (pair := _pair(one, other, turn_1, turn_2, COAXIAL * largest)):
            n_1, n_2 = (each.number for each in pair.teeth)
            coupling = _coupling(turn_1, turn_2, ties[0], n_1, pair.senses * n_2)
            counted = (pair.teeth[0].counted, pair.teeth[1].counted)
            return GearProposal((one.name, other.name), (n_1, n_2), pair.meshing, pair.module, coupling, counted)
    return None


CarrierTurns = dict[str, float]
"""Turns by which one carrier turns against the other about the axis of a wheel: factors by coordinate, of wheel 1 and
of wheel 2; empty where both wheels are on one carrier."""


def _ties(
    turn_1: Turn, turn_2: Turn, turns: Mapping[str, list[Turn]], near: float
) -> Iterator[tuple[CarrierTurns, CarrierTurns]]:
    """Find how the carriers of two wheels are connected, such that one of them carries both axes."""
    if turn_1.carrier == turn_2.carrier:
        yield {}, {}
    for between in turns.get(turn_2.carrier, ()):  # the carrier of wheel 2 turns about the axis of wheel 1
        if between.carrier == turn_1.carrier and (sense := _same_line(between, turn_1, near)):
            yield {between.coordinate: -sense}, {}
    for between in turns.get(turn_1.carrier, ()):
        if between.carrier == turn_2.carrier and (sense := _same_line(between, turn_2, near)):
            yield {}, {between.coordinate: -sense}


def _same_line(one: Turn, other: Turn, near: float) -> float:
    """Return 1 or -1, the sense of one axis in terms of the other, where both are one line; 0 where they are not."""
    if np.linalg.norm(np.cross(one.axis, other.axis)) > PARALLEL_AXES:
        return 0.0
    if np.linalg.norm(np.cross(one.point - other.point, other.axis)) > near:
        return 0.0
    return float(np.sign(one.axis @ other.axis))


def _coupling(
    turn_1: Turn, turn_2: Turn, tie: tuple[CarrierTurns, CarrierTurns], n_1: float | int, n_2: float | int
) -> Coupling:
    """Write that both wheels pass as many teeth, `n_1 w_1 = n_2 w_2` with turns against the body that carries both."""
    if tie == ({}, {}):
        return gear(turn_1.coordinate, turn_2.coordinate, n_1 / n_2)
    first = {turn_1.coordinate: 1.0, **tie[0]}
    second = {turn_2.coordinate: 1.0, **tie[1]}
    factors = {name: n_1 * factor for name, factor in first.items()}
    factors |= {name: factors.get(name, 0.0) - n_2 * factor for name, factor in second.items()}
    return relation(factors, name=f"gear {turn_1.coordinate} {turn_2.coordinate}")


def _pair(one: Part, other: Part, turn_1: Turn, turn_2: Turn, near: float) -> _Pair | None:
    """Find outlines of two parts about two axes whose pitch circles touch; None where there are none."""
    corners = box_corners(np.stack([np.maximum(one.box[0], other.box[0]), np.minimum(one.box[1], other.box[1])]))
    parallel = np.linalg.norm(np.cross(turn_1.axis, turn_2.axis)) < PARALLEL_AXES
    apex = None if parallel else _meeting(turn_1, turn_2, near)
    if not parallel and apex is None:
        return None
    if parallel and not _can_touch(one, other, turn_1, turn_2, near):
        return None
    wheels = ((one, turn_1), (other, turn_2))
    if not all(is_around(part, turn) for part, turn in wheels):
        return None
    outlines = []
    for part, turn in wheels:
        heights = corners @ turn.axis
        outlines.append(find_teeth(part.triangles, turn.point, turn.axis, (float(heights.min()), float(heights.max()))))
        if not outlines[-1]:
            return None
    for teeth_1, teeth_2 in product(*outlines):
        found = (
            _on_parallel_axes(teeth_1, teeth_2, turn_1, turn_2)
            if apex is None
            else _bevel(teeth_1, teeth_2, turn_1, turn_2, apex)
        )
        if found:
            return found
    return None


def _can_touch(one: Part, other: Part, turn_1: Turn, turn_2: Turn, near: float) -> bool:
    """Tell whether two wheels on parallel axes reach each other: before teeth are counted, which takes longer.

    Wheels on one axis do not mesh, and of two others at least one reaches half the way to the other axis.
    """
    apart = np.linalg.norm(np.cross(turn_2.point - turn_1.point, turn_1.axis))
    reach = sum(
        np.linalg.norm(np.cross(part.outermost - turn.point, turn.axis), axis=1).max()
        for part, turn in ((one, turn_1), (other, turn_2))
    )
    return bool(near < apart <= reach)


def _on_parallel_axes(teeth_1: Teeth, teeth_2: Teeth, turn_1: Turn, turn_2: Turn) -> _Pair | None:
    apart = turn_2.point - turn_1.point
    apart = apart - (apart @ turn_1.axis) * turn_1.axis
    n_1, n_2 = teeth_1.number, teeth_2.number
    sides = {teeth_1.side, teeth_2.side}
    if sides == {"inner"}:
        return None
    meshing: Meshing = "external" if sides == {"outer"} else "internal"
    if meshing == "internal" and (n_1 < n_2) == (teeth_1.side == "inner"):
        return None  # a ring has more teeth than the wheel in it
    together = n_1 + n_2 if meshing == "external" else abs(n_1 - n_2)
    if not together:
        return None
    module = 2 * float(np.linalg.norm(apart)) / together
    if not _of_module(teeth_1, module) or not _of_module(teeth_2, module):
        return None
    sense = float(np.sign(turn_1.axis @ turn_2.axis))
    return _Pair((teeth_1, teeth_2), meshing, module, -sense if meshing == "external" else sense)


def _of_module(teeth: Teeth, module: float) -> bool:
    return bool(abs(2 * teeth.pitch_radius / teeth.number - module) < MODULE * module)


def _bevel(teeth_1: Teeth, teeth_2: Teeth, turn_1: Turn, turn_2: Turn, apex: Points) -> _Pair | None:
    """Bevel wheels roll on pitch cones whose common line, from the apex, has distances from the axes as the teeth."""
    if {teeth_1.side, teeth_2.side} != {"outer"}:
        return None
    rims = [teeth.height - apex @ turn.axis for teeth, turn in ((teeth_1, turn_1), (teeth_2, turn_2))]
    axes = [np.sign(rim) * turn.axis for rim, turn in zip(rims, (turn_1, turn_2), strict=True)]  # from apex to rim
    between = np.arccos(np.clip(axes[0] @ axes[1], -1.0, 1.0))
    cones = [
        np.arctan2(np.sin(between), other / own + np.cos(between))
        for own, other in ((teeth_1.number, teeth_2.number), (teeth_2.number, teeth_1.number))
    ]
    for teeth, rim, cone in zip((teeth_1, teeth_2), rims, cones, strict=True):
        if abs(abs(rim) * np.tan(cone) - teeth.pitch_radius) > MODULE * teeth.pitch_radius:
            return None
    # the point where the cones touch moves with both wheels: w_1 a_1 x p = w_2 a_2 x p
    p = np.sin(cones[1]) * axes[0] + np.sin(cones[0]) * axes[1]
    senses = float(np.sign(np.cross(turn_1.axis, p) @ np.cross(turn_2.axis, p)))
    return _Pair((teeth_1, teeth_2), "bevel", 2 * teeth_1.pitch_radius / teeth_1.number, senses)


def _meeting(turn_1: Turn, turn_2: Turn, near: float) -> Points | None:
    """Find the point where two axes meet; None where they miss each other."""
    normal = np.cross(turn_1.axis, turn_2.axis)
    apart = turn_2.point - turn_1.point
    if abs(apart @ normal) > near * np.linalg.norm(normal):
        return None
    return turn_1.point + np.cross(apart, turn_2.axis) @ normal / (normal @ normal) * turn_1.axis
