"""Rolling bearings: a ring inside a ring, with balls, rollers, a cage and shields between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import Bore
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.surfaces import Cone

THICKEST = 0.45
"""Radius of the inner ring over that of the hole of the outer one, at least: rings of catalogues have 0.6 to 0.9, and
needle bearings nearly 1."""
ROUND = 1.02
"""A ring reaches no farther from its axis than this, over its largest radius: it is a body of revolution."""
FLUSH = 0.05
"""Ends of two rings that are flush, over the width of the wider one: what a bearing without its balls is known by."""
ROLLING = 3
"""Balls or rollers that centre a ring, at least."""
MAX_RACE_GAP = 0.15
"""Play of a ball or roller beside each ring, over the room between both, at most: what leaves more centres no ring."""
SLACK = 0.05
"""Play that parts between two rings have beyond the section of the rings, over the radius of the outer one."""
MAX_TAPER = np.deg2rad(35.0)
"""Half angle of the raceway of a tapered roller bearing, at most: those of catalogues have 10 to 30 degrees, chamfers
have 45."""


class Bearing(NamedTuple):
    """A rolling bearing."""

    outer: str
    inner: str
    between: tuple[str, ...]
    """Balls, rollers, cage and shields, which are taken for one body with the inner ring."""
    axis: Bore
    """The outside of the inner ring."""
    rolling: int
    """Number of balls or rollers."""


class Ring(NamedTuple):
    """A body of revolution with a hole."""

    part: Part
    hole: Bore
    """The narrowest one."""
    outside: Bore
    """The widest one."""
    coaxial: tuple[Bore, ...]
    """All its bores and pins about its axis."""
    plain: bool
    """Whether it has no holes beside its axis, as rings have that are screwed on."""
    told: str = "has the size of a ball bearing"
    """What tells that it is a whole bearing, where it is one, as a clause."""


def bearings(parts: Sequence[Part], bores: Mapping[str, Sequence[Bore]]) -> list[Bearing]:
    """Find the bearings among the parts: each ring belongs to one, those with the most room between come first.

    `bores` are the bores and pins of each part by its name.
    """
    rings = [ring for part in parts if (ring := ring_of(part, [*bores[part.name], *_tapered(part)])) is not None]
    nested = [(outer, inner) for outer in rings for inner in rings if outer is not inner and _inside(outer, inner)]
    coaxial = {ring.part.name for ring in rings}
    inside = [[part for part in parts if part not in (a.part, b.part) and _between(part, a, b)] for a, b in nested]
    rolling = [
        sum(_pieces(part) for part in between if part.name not in coaxial and _rolls(part, *pair))
        for pair, between in zip(nested, inside, strict=True)
    ]
    likely = [each for each in zip(nested, inside, rolling, strict=True) if each[2] >= ROLLING or _flush(*each[0])]
    sure = [pair for pair, *_ in likely]
    seated = [each for each in likely if not _hides_a_bearing(*each[0], sure)]
    found: list[Bearing] = []
    taken: set[str] = set()
    for (outer, inner), between, count in sorted(seated, key=lambda each: _room(*each[0]), reverse=True):
        members = tuple(part.name for part in between if part.name not in taken)
        if not {outer.part.name, inner.part.name} & taken:
            taken |= {outer.part.name, inner.part.name, *members}
            found.append(Bearing(outer.part.name, inner.part.name, members, inner.outside, count))
    return found


def _rolls(part: Part, outer: Ring, inner: Ring) -> bool:
    """Tell whether what is between two rings reaches from one to the other, with its middle beside both: a screw
    through a flange does not, nor what else is on a long hollow axle."""
    away, along = _section(part, outer.hole)
    gap, slack = MAX_RACE_GAP * _room(outer, inner), SLACK * outer.outside.radius
    ends, middle = np.array([reach_of(ring, outer.hole) for ring in (outer, inner)]), (along.min() + along.max()) / 2
    beside = ends[:, 0].max() - slack <= middle <= ends[:, 1].min() + slack
    return bool(beside and away.min() <= inner.outside.radius + gap and away.max() >= outer.hole.radius - gap)


def _pieces(part: Part) -> int:
    """Count the solids that a part is drawn of: the balls of a bearing may be one part."""
    corners, index = np.unique(part.triangles.reshape(-1, 3), axis=0, return_inverse=True)
    first, second, third = index.reshape(-1, 3).T
    ends = np.concatenate([first, second]), np.concatenate([second, third])
    graph = coo_array((np.ones(len(ends[0])), ends), shape=(len(corners), len(corners)))
    return int(connected_components(graph, directed=False, return_labels=False))


def outside_of(found: Sequence[Bearing], axes: Sequence[CommonAxis]) -> list[CommonAxis]:
    """Leave out common axes that only bearings have: between the parts of one, of what is between its rings, and of the
    holes of outer rings, which are full."""
    of = {name: number for number, each in enumerate(found) for name in (each.outer, each.inner, *each.between)}
    hidden = {name for each in found for name in each.between}
    outer = {each.outer for each in found}
    return [
        pair
        for pair in axes
        if not (pair.virtual and {*pair.parts} & outer)
        and not {*pair.parts} & hidden
        and (pair.one.part not in of or of[pair.one.part] != of.get(pair.other.part))
    ]


def ring_of(part: Part, own: Sequence[Bore]) -> Ring | None:
    """Make the ring that a part with the bores and pins `own` is; None where it is not round, or has no hole."""
    holes, outsides = [bore for bore in own if bore.hole], [bore for bore in own if not bore.hole]
    if not holes or not outsides:
        return None
    outside = max(outsides, key=lambda bore: bore.radius)
    hole = min((bore for bore in holes if bore.on_axis_of(outside)), key=lambda bore: bore.radius, default=None)
    about = tuple(bore for bore in own if bore.on_axis_of(outside))
    beside = [bore for bore in own if bore not in about]
    if hole is None or not all(bore.hole for bore in beside):
        return None
    away, _ = _section(part, outside)
    return Ring(part, hole, outside, about, not beside) if away.max() <= ROUND * outside.radius else None


def _tapered(part: Part) -> list[Bore]:
    """Find the conical raceways of a part, each as a hole of its least radius, or as a pin of its largest one."""
    cones = [(face, face.surface) for face in part.faces if isinstance(face.surface, Cone)]
    return [_raceway(part, face, cone) for face, cone in cones if cone.half_angle <= MAX_TAPER]


def _raceway(part: Part, face: Face, cone: Cone) -> Bore:
    heights = (face.triangles.reshape(-1, 3) - cone.apex) @ cone.axis
    low, high = float(heights.min()), float(heights.max())
    middle, half, hole = (low + high) / 2, (high - low) / 2, cone.side < 0
    radius = (low if hole else high) * float(np.tan(cone.half_angle))
    point = cone.apex + middle * cone.axis
    return Bore(part.name, (face.name,), point, cone.axis, radius, hole, half, ((-half, half),))


def _section(part: Part, axis: Bore) -> tuple[np.ndarray, np.ndarray]:
    """Measure the distances of the corners of a part from an axis, and where they are along it."""
    corners = part.triangles.reshape(-1, 3) - axis.point
    along = corners @ axis.axis
    return np.linalg.norm(corners - np.outer(along, axis.axis), axis=1), along


def _inside(outer: Ring, inner: Ring) -> bool:
    """Tell whether a ring is inside another one, with room for balls, and at the same place of one axis."""
    ratio = inner.outside.radius / outer.hole.radius
    if not THICKEST <= ratio < 1 / ROUND or not inner.outside.on_axis_of(outer.hole):
        return False
    (low1, high1), (low2, high2) = (reach_of(ring, outer.hole) for ring in (outer, inner))
    return min(high1, high2) - max(low1, low2) > min(high1 - low1, high2 - low2) / 2


def _room(outer: Ring, inner: Ring) -> float:
    return outer.hole.radius - inner.outside.radius


def _hides_a_bearing(outer: Ring, inner: Ring, sure: Sequence[tuple[Ring, Ring]]) -> bool:
    """Tell whether a bearing is seated in the one of two rings or on the other: a roller on its bearing, with the
    spacer beside that, is none."""
    return any(
        (around is not outer and any(_is_seated(around.outside, bore) for bore in outer.coaxial if bore.hole))
        or (within is not inner and any(_is_seated(bore, within.hole) for bore in inner.coaxial if not bore.hole))
        for around, within in sure
    )


def _is_seated(pin: Bore, hole: Bore) -> bool:
    """Tell whether a round part fills a hole on its axis."""
    return 1 / ROUND < pin.radius / hole.radius < ROUND and pin.on_axis_of(hole)


def reach_of(ring: Ring, axis: Bore) -> tuple[float, float]:
    """Find where a ring begins and ends along an axis, from the point of that."""
    along = _section(ring.part, axis)[1]
    return float(along.min()), float(along.max())


def _flush(outer: Ring, inner: Ring) -> bool:
    if not (outer.plain and inner.plain):
        return False
    ends = np.array([reach_of(ring, outer.hole) for ring in (outer, inner)])
    return bool(np.abs(ends[0] - ends[1]).max() <= FLUSH * np.ptp(ends, axis=1).max())


def _between(part: Part, outer: Ring, inner: Ring) -> bool:
    """Tell whether a part is inside of the section that both rings make together."""
    reach, slack = outer.outside.radius, SLACK * outer.outside.radius
    middle = part.box.mean(axis=0) - outer.hole.point
    if np.linalg.norm(middle) > 2 * reach + outer.hole.half:  # before all corners are looked at
        return False
    away, along = _section(part, outer.hole)
    ends = np.array([reach_of(ring, outer.hole) for ring in (outer, inner)])
    within = along.min() >= ends[:, 0].min() - slack and along.max() <= ends[:, 1].max() + slack
    return bool(within and away.min() > inner.hole.radius and away.max() < outer.outside.radius)
