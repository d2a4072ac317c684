"""Screws, nuts, washers, rivets and dowels: parts of one axis, what they hold, and patterns of them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import SAME_ANGLE, SAME_LENGTH, Bore, merged, shared
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.geometry.outline import roundness
from jaxkin.geometry.part import Part
from jaxkin.joints.evidence import Evidence, EvidenceKind

MAX_HEAD = 4.02
"""Farthest a fastener reaches from its axis, over its smallest radius: flanges, large washers and knobs of four radii
are within, as rounded by files."""
MAX_NUT = 3.0
"""The same of parts with a hole only, nuts and rings: larger ones are plates with a bore, or washers (`MAX_WASHER`)."""
MAX_WASHER = 0.25
"""Thickness of a large washer over its outer radius: those of ISO 7093 have 0.17 to 0.25."""
MIN_THREADED = 0.2
"""Share of the length of a nut that its holes are deep, at least: stand-offs with a thread in both ends have a third, a
post with a hole in its end less."""
WASHER_ROUND = 0.95
"""Roundness of a large washer seen along its axis, at least: triangles of few chords leave a circle as much."""
MIN_ROUND = 0.84
"""Roundness of a screw seen along its axis, at least: a hexagon has 0.866."""
MIN_PIN = 0.4
"""Share of a fastener that is pin, where it is not round: pins with a flag or a handle have more, levers less."""
MAX_CROSS = 0.4
"""Radius of bores on other axes than that of a fastener, over the smallest one on it: holes for cotter pins, lock wire
and the screw of a flag have up to a third."""
MAX_END_HOLE = 0.5
"""Length of a small hole along a pin over that of the pin, at most, to be one in its end, as for a grease nipple."""
MAX_EXPOSED = 1.0
"""Length of a pin outside of its holes, over the length inside: rods that something slides on have more."""

_PARALLEL = float(np.cos(0.01))
"""Cosine of the angle up to which the axes of a pattern are parallel: bolts are drawn askew by no hundredth."""


def fasteners(
    parts: Sequence[Part], bores: Sequence[Bore], every: Mapping[str, Sequence[Bore]], plugged: Collection[int] = ()
) -> set[str]:
    """Find the parts that have the form of a fastener: all bores on one axis, and nothing far from that axis.

    `bores` are those on an axis with others; of all other bores of a part, which are in `every`, small ones across are
    those of cotter pins. Holes that are `plugged_holes` do not count where they are small ones in an end.
    """
    by_part: dict[str, list[Bore]] = {}
    for bore in bores:
        by_part.setdefault(bore.part, []).append(bore)
    by_part = {name: _without_small_holes(own, plugged) for name, own in by_part.items()}
    solids = {part.name: part for part in parts}
    return {
        name
        for name, own in by_part.items()
        if _on_one_axis(own, every[name]) and _slim(solids[name], own) and _is_mostly_pin(solids[name], own)
    }


def _without_small_holes(own: Sequence[Bore], plugged: Collection[int]) -> list[Bore]:
    """Leave out the small holes across a pin, and those in its ends that are plugged."""
    pins = [bore for bore in own if not bore.hole]
    if not pins:
        return [*own]
    first = max(pins, key=lambda bore: bore.half)
    least = MAX_CROSS * min(bore.radius for bore in pins)

    def small(bore: Bore) -> bool:
        in_end = bore.half <= MAX_END_HOLE * first.half and id(bore) in plugged
        return bore.hole and bore.radius <= least and (in_end or not bore.on_axis_of(first))

    return [bore for bore in own if not small(bore)]


def _on_one_axis(own: Sequence[Bore], every: Sequence[Bore]) -> bool:
    least = MAX_CROSS * min(bore.radius for bore in own)
    # holes along the axis, however small, are those of a flange
    across = [bore for bore in every if bore not in own and (bore.radius > least or parallel(bore, own[0]))]
    return all(bore.on_axis_of(own[0], SAME_ANGLE, SAME_LENGTH) for bore in (*own[1:], *across))


def _slim(part: Part, own: Sequence[Bore]) -> bool:
    """Tell whether a part reaches no farther from its axis than heads, nuts and washers do."""
    away, least = away_from(part, own[0]), min(bore.radius for bore in own)
    if not all(bore.hole for bore in own):
        return away <= MAX_HEAD * least
    thick = np.ptp(part.outermost @ own[0].axis)
    is_washer = thick <= MAX_WASHER * away and _roundness(part, own[0]) > WASHER_ROUND
    deep = sum(high - low for low, high in merged(span for bore in own for span in bore.spans_along(own[0].axis)))
    return bool(away <= (MAX_HEAD if is_washer else MAX_NUT) * least and deep >= MIN_THREADED * thick)


def away_from(part: Part, about: Bore) -> float:
    """Measure how far a part reaches from the axis of a bore."""
    return float(np.linalg.norm(np.cross(part.outermost - about.point, about.axis), axis=1).max())


def _is_mostly_pin(part: Part, own: Sequence[Bore]) -> bool:
    """Tell whether a part with a pin is round about its axis, or is little more than the pin, such as one with a
    flag."""
    pins = [bore for bore in own if not bore.hole]
    if not pins:
        return True
    pinned = sum(2 * np.pi * bore.radius**2 * bore.half for bore in pins)
    return _roundness(part, pins[0]) > MIN_ROUND or pinned > MIN_PIN * part.volume


def _roundness(part: Part, about: Bore) -> float:
    """Measure how round the outline of a part is, seen along an axis: see `roundness`."""
    x = np.cross(about.axis, np.eye(3)[np.argmin(np.abs(about.axis))])
    x /= np.linalg.norm(x)
    outline = (part.outermost - about.point) @ np.column_stack([x, np.cross(about.axis, x)])
    return roundness(outline, np.zeros(2))


@dataclass(frozen=True, eq=False)
class Stack:
    """Fasteners on one axis, such as a screw with its washers and nut, and what they go through."""

    fasteners: tuple[str, ...]
    held: tuple[str, ...]
    """The parts that are no fasteners, of which a bore is on the axis or a face touches a fastener."""
    axis: Bore
    """One bore of a fastener."""
    guides: bool
    """Whether most of the pin is outside of its holes, so that something may slide on it."""


def stacks(
    found: Sequence[CommonAxis],
    fastening: Collection[str],
    touching: Collection[frozenset[str]],
    order: Mapping[str, int],
) -> list[Stack]:
    """Find the stacks of an assembly; `touching` are the pairs of parts with contacts. A gland nut, through which a
    shaft passes, is in no stack with that."""
    import networkx as nx  # here, as it takes as long to import as half of JAX

    across = [pair for pair in found if is_cotter(pair, found, fastening)]
    found = [pair for pair in found if not pair.virtual or {*pair.parts} <= {*fastening}]
    glands = [pair for pair in found if _is_passed(pair, found, fastening, touching)]
    found = [pair for pair in found if pair not in across and pair not in glands]
    graph = nx.Graph(pair.parts for pair in found if {*pair.parts} <= {*fastening})
    graph.add_nodes_from(part for pair in found for part in pair.parts if part in fastening)
    result = []
    for members in nx.connected_components(graph):
        pairs = [pair for pair in found if members & {*pair.parts}]
        held = {part for pair in pairs for part in pair.parts} | {
            p for each in touching if each & members for p in each
        }
        bore = next(b for pair in pairs for b in (pair.one, pair.other) if b.part in members)
        holes = [pair for pair in pairs if pair.one.part in members]
        covered = merged(span for pair in holes for span in pair.other.spans_along(bore.axis))
        pins = merged(span for pair in holes for span in pair.one.spans_along(bore.axis))
        inside = max(shared(pins, covered), 0.0) if holes else 0.0
        length = sum(high - low for low, high in pins)
        names = tuple(sorted(members, key=order.__getitem__))
        through = tuple(sorted(held - {*fastening}, key=order.__getitem__))
        result.append(Stack(names, through, bore, length - inside > MAX_EXPOSED * inside))
    alone = {pair.one.part: pair for pair in across if not any(pair.one.part in each.fasteners for each in result)}
    result += [Stack((name,), (pair.other.part,), pair.one, guides=False) for name, pair in alone.items()]
    return sorted(result, key=lambda stack: order[stack.fasteners[0]])


def _is_passed(
    pair: CommonAxis, found: Sequence[CommonAxis], fastening: Collection[str], touching: Collection[frozenset[str]]
) -> bool:
    """Tell whether a pin only passes through a fastener, with play and without touching it, as a shaft through a gland
    nut: that fits what is no fastener on the same axis, as the neck of a cover, and holds on to it."""
    if pair.virtual or not {*pair.parts} <= {*fastening} or frozenset(pair.parts) in touching:
        return False
    ring = pair.other.part
    others = [each for each in found if not each.virtual and ring in each.parts and not {*each.parts} <= {*fastening}]
    others = [each for each in others if each.one.on_axis_of(pair.other)]
    loose = pair.clearance > SAME_FIT * pair.other.radius
    return loose and any(abs(each.clearance) <= SAME_FIT * each.other.radius for each in others)


def is_cotter(pair: CommonAxis, found: Sequence[CommonAxis], fastening: Collection[str]) -> bool:
    """Tell whether a fastener is in a hole across another one, which is the pin in some hole itself."""
    return (
        not pair.virtual
        and {*pair.parts} <= {*fastening}
        and any(each.one.part == pair.other.part and not parallel(each.one, pair.other) for each in found)
    )


def patterns(
    found: Sequence[CommonAxis], every: Sequence[Stack], body: Mapping[str, str]
) -> dict[frozenset[str], list[Bore]]:
    """Find the parallel axes that two bodies have in common, two or more, through fasteners or as bores without a
    pin."""
    shared: dict[frozenset[str], list[Bore]] = {}
    through = [
        (frozenset(pair), stack.axis) for stack in every if not stack.guides for pair in combinations(stack.held, 2)
    ]
    empty = [(frozenset(body[part] for part in pair.parts), pair.one) for pair in found if pair.virtual]
    for pair, bore in (*through, *empty):
        known = shared.setdefault(pair, [])
        if all(beside(bore, other) for other in known):
            known.append(bore)
    return {pair: axes for pair, axes in shared.items() if len(pair) > 1 and len(axes) > 1}


def beside(one: Bore, other: Bore) -> bool:
    """Tell whether two axes are parallel and not the same."""
    offset = other.point - one.point
    apart2 = float(offset @ offset) - float(offset @ one.axis) ** 2
    return parallel(one, other) and apart2 > max(one.radius, other.radius) ** 2


def parallel(one: Bore, other: Bore) -> bool:
    """Tell whether the axes of two fasteners are parallel, as those of one pattern are."""
    return abs(float(one.axis @ other.axis)) > _PARALLEL


def bolted(shared: Mapping[frozenset[str], list[Bore]], order: Mapping[str, int]) -> list[Inference]:
    """Find parts that two or more parallel axes hold to each other."""
    result = []
    for pair, axes in shared.items():
        parts = tuple(sorted(pair, key=order.__getitem__))
        text = f"{len(axes)} parallel common axes of {' and '.join(map(repr, parts))}"
        result.append(Inference(parts, Evidence(EvidenceKind.BOLT_PATTERN, (("axes", float(len(axes))),), text)))
    return result
