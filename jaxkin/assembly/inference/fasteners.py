"""Screws, nuts, washers, rivets and dowels: parts of one axis, what they hold, and patterns of them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.bores import SAME_ANGLE, SAME_LENGTH, Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.geometry.part import Part
from jaxkin.joints.evidence import Evidence, EvidenceKind

MAX_HEAD = 4.0
"""Farthest a fastener reaches from its axis, over its smallest radius: flanges and large washers are within."""
MAX_NUT = 3.0
"""The same of parts with a hole only, nuts and thin rings: larger ones are plates with a bore."""
MAX_EXPOSED = 1.0
"""Length of a pin outside of its holes, over the length inside: rods that something slides on have more."""


def fasteners(parts: Sequence[Part], bores: Sequence[Bore]) -> set[str]:
    """Find the parts that have the form of a fastener: all bores on one axis, and nothing far from that axis."""
    by_part: dict[str, list[Bore]] = {}
    for bore in bores:
        by_part.setdefault(bore.part, []).append(bore)
    solids = {part.name: part for part in parts}
    return {name for name, own in by_part.items() if _on_one_axis(own) and _slim(solids[name], own)}


def _on_one_axis(own: Sequence[Bore]) -> bool:
    return all(bore.on_axis_of(own[0], SAME_ANGLE, SAME_LENGTH) for bore in own[1:])


def _slim(part: Part, own: Sequence[Bore]) -> bool:
    corners = part.outermost - own[0].point
    away = np.linalg.norm(corners - np.outer(corners @ own[0].axis, own[0].axis), axis=1)
    reach = MAX_NUT if all(bore.hole for bore in own) else MAX_HEAD
    return bool(away.max() <= reach * min(bore.radius for bore in own))


_PARALLEL = float(np.cos(0.01))
"""Cosine of the angle up to which the axes of a pattern are parallel: bolts are drawn askew by no hundredth."""


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
    """Find the stacks of an assembly; `touching` are the pairs of parts with contacts."""
    import networkx as nx

    found = [pair for pair in found if not pair.virtual or {*pair.parts} <= {*fastening}]
    graph = nx.Graph(pair.parts for pair in found if {*pair.parts} <= {*fastening})
    graph.add_nodes_from(part for pair in found for part in pair.parts if part in fastening)
    result = []
    for members in nx.connected_components(graph):
        pairs = [pair for pair in found if members & {*pair.parts}]
        held = {part for pair in pairs for part in pair.parts} | {
            p for each in touching if each & members for p in each
        }
        bore = next(b for pair in pairs for b in (pair.one, pair.other) if b.part in members)
        inside = sum(max(engaged(pair), 0.0) for pair in pairs if pair.one.part in members)
        length = max((2 * pair.one.half for pair in pairs if pair.one.part in members), default=0.0)
        names = tuple(sorted(members, key=order.__getitem__))
        through = tuple(sorted(held - {*fastening}, key=order.__getitem__))
        result.append(Stack(names, through, bore, length - inside > MAX_EXPOSED * inside))
    return sorted(result, key=lambda stack: order[stack.fasteners[0]])


def patterns(found: Sequence[CommonAxis], every: Sequence[Stack]) -> dict[frozenset[str], list[Bore]]:
    """Find the parallel axes that two parts have in common, two or more, through fasteners or as bores without a
    pin."""
    shared: dict[frozenset[str], list[Bore]] = {}
    through = [
        (frozenset(pair), stack.axis) for stack in every if not stack.guides for pair in combinations(stack.held, 2)
    ]
    empty = [(frozenset(pair.parts), pair.one) for pair in found if pair.virtual]
    for pair, bore in (*through, *empty):
        known = shared.setdefault(pair, [])
        if all(_beside(bore, other) for other in known):
            known.append(bore)
    return {pair: axes for pair, axes in shared.items() if len(axes) > 1}


def _beside(one: Bore, other: Bore) -> bool:
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
