"""Parts that lie on one other part only, and parts that nothing ties to the fixed ones."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from jaxkin.assembly.inference.embedded import boxes_meet
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known, Pair
from jaxkin.assembly.inference.trapped import ACROSS
from jaxkin.geometry.part import Part, size
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.topology.components import connected

NEAR = 0.02
"""Distance to the nearest part, over the size of the assembly, up to which a part that touches nothing goes with it."""


def lying_on_one(known: Known) -> list[Inference]:
    """Bodies that touch one other body only, and that by one plane."""
    body = known.body
    ties: dict[str, set[str]] = {}
    planes: dict[Pair, list[Vector]] = {}
    jointed = [each.parts for each in known.found if each.joint] + [tuple(pair) for pair in known.by_hand]
    for parts in (*map(tuple, known.touching), *jointed):
        one, other = (body[part] for part in parts)
        ties.setdefault(one, set()).add(other)
        ties.setdefault(other, set()).add(one)
    for contact in known.contacts:
        owners = frozenset(body[part] for part in contact.parts)
        surface = contact.surfaces[0]
        planes.setdefault(owners, []).append(surface.normal if isinstance(surface, Plane) else np.zeros(3))
        if contact.state != "a":
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
    """Parts that nothing ties to the fixed ones: with the part that they are most likely rigid with, or at rest."""
    result: list[Inference] = []
    extent = size(tuple(known.parts))
    ties = [
        *map(tuple, known.touching),
        *(each.parts for each in known.found),
        *known.rigid,
        *map(tuple, known.by_hand),
    ]
    groups = connected(known.names, [pair for tie in ties for pair in combinations(tie, 2)])
    held = {name for group in groups if {*known.fixed} & {*group} for name in group}
    islands = [sorted(group, key=known.order.__getitem__) for group in groups if not held & {*group}]
    while islands:
        distance, island, part, host = min(
            (
                (_distance(known.solids[part], known.solids[host]), island, part, host)
                for island in islands
                for part in island
                for host in held
            ),
            key=lambda each: (each[0], known.order[each[2]], known.order[each[3]]),
        )
        islands.remove(island)
        held |= {*island}
        near = distance <= NEAR * extent
        host = host if near else known.fixed[0]
        where = f", and {distance:.3g} from {host!r}" if near else ": left at rest"
        text = f"{part!r} is tied to nothing{where}"
        result.append(Inference((host, part), Evidence(EvidenceKind.NEAREST, (("distance", distance),), text)))
    return result


def _distance(one: Part, other: Part) -> float:
    """Distance between the boxes of two parts."""
    if boxes_meet(one, other):
        return 0.0
    gap = np.maximum(np.maximum(other.box[0] - one.box[1], one.box[0] - other.box[1]), 0.0)
    return float(np.linalg.norm(gap))
