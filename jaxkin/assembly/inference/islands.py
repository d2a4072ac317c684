"""Parts that lie on one other part only, and parts that nothing ties to the fixed ones."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known, Pair
from jaxkin.assembly.inference.trapped import ACROSS
from jaxkin.geometry.part import size
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.topology.components import connected

CANDIDATES = 6
"""Parts that a part may be nearest to, by their boxes: those that are measured."""
NEAR = 0.02
"""Distance to the nearest part, over the size of the assembly, up to which a part that touches nothing goes with it."""


def lying_on_one(known: Known) -> list[Inference]:
    """Find bodies that touch one other body only, and that by one plane."""
    body = known.body
    ties: dict[str, set[str]] = {}
    planes: dict[Pair, list[Vector]] = {}
    jointed = [each.parts for each in known.found if each.joint] + [tuple(pair) for pair in known.by_hand]
    # in the order of the file: the first of several bodies that could be added decides what the others touch
    touching = [sorted(pair, key=known.order.__getitem__) for pair in known.touching]
    touching.sort(key=lambda pair: [known.order[part] for part in pair])
    for parts in (*touching, *jointed):
        one, other = (body[part] for part in parts)
        ties.setdefault(one, set()).add(other)
        ties.setdefault(other, set()).add(one)
    for contact in known.contacts:
        owners = frozenset(body[part] for part in contact.parts)
        surface = contact.surfaces[0]
        planes.setdefault(owners, []).append(surface.normal if isinstance(surface, Plane) else np.zeros(3))
        if not contact.contact_state.is_flat:
            planes[owners].append(np.zeros(3))
    hinged = {frozenset(body[part] for part in parts) for parts in jointed}
    result = []
    for one, others in ties.items():
        others = others - {one}
        if len(others) != 1 or body[one] == body[known.fixed[0]]:
            continue
        (other,) = others
        normals = planes.get(frozenset((one, other)), [])
        flat = normals and all(np.linalg.norm(np.cross(n, normals[0])) < ACROSS and np.any(n) for n in normals)
        if flat and frozenset((one, other)) not in hinged:
            text = f"{one!r} touches {other!r} only, and that on one plane"
            parts = tuple(sorted((one, other), key=known.order.__getitem__))
            result.append(Inference(parts, Evidence(EvidenceKind.ENCLOSED, (), text)))
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
    for distance, part, host in _distances(known, group_of):
        own, other = group_of[part], group_of[host]
        if own != other:
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


def _distances(known: Known, group_of: Mapping[str, int]) -> list[tuple[float, str, str]]:
    """Measure the distances of parts that nothing ties to the parts next to them, the shortest first; long ones are
    left out."""
    home = group_of[known.fixed[0]]
    low, high = (np.array([part.box[end] for part in known.parts]) for end in (0, 1))
    numbers = np.array([group_of[name] for name in known.names])
    limit, found = NEAR * size(tuple(known.parts)), []
    for index in np.flatnonzero(numbers != home).tolist():
        gaps = np.linalg.norm(np.maximum(np.maximum(low - high[index], low[index] - high), 0.0), axis=1)
        gaps[numbers == numbers[index]] = np.inf
        part = known.parts[index]
        for other in np.argsort(gaps, kind="stable")[:CANDIDATES].tolist():
            if gaps[other] <= limit and (distance := known.measured.distance(part, known.parts[other])) <= limit:
                found.append((distance, part.name, known.parts[other].name))
    return sorted(found, key=lambda each: (each[0], known.order[each[2]], known.order[each[1]]))
