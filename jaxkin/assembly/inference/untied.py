"""Parts that nothing ties to the fixed ones: what they are drawn into, and what they are nearest to."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from jaxkin.assembly.inference.embedded import inside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.geometry.part import size
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.topology.components import connected

CANDIDATES = 6
"""Parts that a part may be nearest to, by their boxes: those that are measured."""
MIN_SUNK = 0.05
"""Share of the corners of a part in the material of another one, at least: what only touches it has less."""
SAMPLED = 64
"""Corners of a part that are looked for in the material of others, at most: a coil spring has thousands."""
MAX_NEAREST = 0.02
"""Distance to the nearest part, over the size of the assembly, up to which a part that touches nothing goes with it."""


def sunk_in_siblings(known: Known) -> list[Inference]:
    """Join parts that nothing ties with the part of their sub-assembly whose material they are drawn into, such as the
    thread of a screw that is a solid of its own."""
    tied = {part for tie in (*known.touching, *(each.parts for each in known.found)) for part in tie}
    tied |= {part for tie in (*known.rigid, *known.by_hand, known.fixed) for part in tie}
    result = []
    for part in (known.solids[name] for name in known.names if name not in tied):
        siblings = [each for each in known.measured.beside(part) if known.group[each.name] == known.group[part.name]]
        corners = part.outermost[:: -(-len(part.outermost) // SAMPLED)]
        shares = [(float(inside(corners, each).mean()), each.name) for each in siblings]
        share, host = max(shares, default=(0.0, ""))
        if share > MIN_SUNK and known.group[part.name] != ():
            text = f"{share:.0%} of {part.name!r} is drawn into {host!r}, which is in its sub-assembly"
            evidence = Evidence(EvidenceKind.ENCLOSED, (("share", share),), text)
            result.append(Inference(known.in_order((host, part.name)), evidence))
    return result


def tied_to_nothing(known: Known) -> list[Inference]:
    """Tie parts that nothing ties to the fixed ones to the part that they are nearest to, or hold them at rest.

    Groups of parts are joined by the shortest distances first, as a minimum spanning tree is made.
    """
    ties = (*known.touching, *(each.parts for each in known.found), *known.rigid, *known.by_hand)
    groups = connected(known.names, [pair for tie in ties for pair in combinations(tie, 2)])
    group_of = {name: number for number, group in enumerate(groups) for name in group}
    for name in known.fixed:
        group_of |= dict.fromkeys(groups[group_of[name]], group_of[known.fixed[0]])
    home, result = group_of[known.fixed[0]], []
    for _, distance, part, host in _distances(known, group_of):
        own, other = group_of[part], group_of[host]
        if own != other and frozenset((part, host)) in known.ignored:
            known.taken_back.add(frozenset((part, host)))
        elif own != other:
            text = f"{part!r} is tied to nothing, and {distance:.3g} from {host!r}"
            result.append(_nearest((host, part), distance, text))
            gone, stays = (own, other) if own != home else (other, own)
            group_of = {name: stays if number == gone else number for name, number in group_of.items()}
    for number in sorted({*group_of.values()} - {home}):
        part = next(name for name in known.names if group_of[name] == number)
        text = f"{part!r} is tied to nothing: left at rest"
        result.append(_nearest((known.fixed[0], part), np.inf, text))
    return result


def _nearest(parts: tuple[str, str], distance: float, text: str) -> Inference:
    return Inference(parts, Evidence(EvidenceKind.NEAREST, (("distance", distance),), text))


def _distances(known: Known, group_of: Mapping[str, int]) -> list[tuple[bool, float, str, str]]:
    """Measure the distances of parts that nothing ties to the parts next to them: first within sub-assemblies, the
    shortest first.

    Long ones are left out, but within sub-assemblies. The first entry is whether the two are in different ones.
    """
    home = group_of[known.fixed[0]]
    low, high = (np.array([part.box[end] for part in known.parts]) for end in (0, 1))
    numbers = np.array([group_of[name] for name in known.names])
    limit, found = MAX_NEAREST * size(tuple(known.parts)), []
    for index in np.flatnonzero(numbers != home).tolist():
        gaps = np.linalg.norm(np.maximum(np.maximum(low - high[index], low[index] - high), 0.0), axis=1)
        gaps[numbers == numbers[index]] = np.inf
        part = known.parts[index]
        own = known.group[part.name]
        apart = np.array([own == () or known.group[name] != own for name in known.names])
        for other in np.lexsort((gaps, apart))[:CANDIDATES].tolist():
            far = bool(apart[other])
            reach = limit if far else np.inf
            if np.isfinite(gaps[other]) and gaps[other] <= reach:
                distance = known.measured.distance(part, known.parts[other])
                if distance <= reach:
                    found.append((far, distance, part.name, known.parts[other].name))
    return sorted(found, key=lambda each: (each[0], each[1], known.order[each[3]], known.order[each[2]]))
