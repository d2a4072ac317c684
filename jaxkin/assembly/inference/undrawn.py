"""Screws that are not drawn: empty holes of a part that end on a face of another one, against which it lies flat."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known, Pair
from jaxkin.assembly.inference.screwed import crossings
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind

AT_FACE = 0.05
"""Distance of the end of a hole from the face that covers it, over its radius."""


def screwed_flat(known: Known) -> list[Inference]:
    """Find bodies that lie flat on each other, one of them with two or more empty holes that end on the other's face.

    Nothing else holds them to each other, so that they would slide and turn on that face.
    """
    body = known.body
    between: dict[Pair, list[Contact]] = {}
    for contact in known.contacts:
        between.setdefault(frozenset(body[part] for part in contact.parts), []).append(contact)
    used = {id(bore) for pair in (*known.axes, *known.tapped) for bore in (pair.one, pair.other)}
    jointed = {frozenset(body[part] for part in each.parts) for each in known.found if each.joint}
    result = []
    for owners, contacts in between.items():
        planes = [each.surfaces[0] for each in contacts]
        flat = all(each.contact_state.is_flat for each in contacts) and all(isinstance(p, Plane) for p in planes)
        if len(owners) < 2 or owners in jointed or not flat:
            continue
        normals = [plane.normal for plane in planes if isinstance(plane, Plane)]
        if any(np.linalg.norm(np.cross(normal, normals[0])) > ACROSS for normal in normals):
            continue
        for part, other in {pair for each in contacts for pair in (each.parts, each.parts[::-1])}:
            holes = [bore for bore in known.bores[part] if bore.hole and id(bore) not in used]
            ends = _covered(known, holes, other, normals[0])
            if len(ends) > 1:
                where = f"end on the face of {other!r} that it lies on"
                text = f"{len(ends)} empty holes of {part!r} {where}, as for screws that are not drawn"
                parts = known.in_order((part, other))
                evidence = Evidence(EvidenceKind.BOLT_PATTERN, (("axes", float(len(ends))),), text)
                result.append(Inference(parts, evidence))
    return result


def _covered(known: Known, holes: list[Bore], other: str, normal: np.ndarray) -> list[Bore]:
    """Find holes across a face, on axes beside each other, that end on triangles of the other part."""
    found: list[Bore] = []
    triangles = known.solids[other].triangles
    for hole in holes:
        if np.linalg.norm(np.cross(hole.axis, normal)) > ACROSS or not all(beside(hole, each) for each in found):
            continue
        distances = np.abs(crossings(hole.point, hole.axis, triangles)) - hole.half
        if np.any(np.abs(distances) <= AT_FACE * hole.radius):
            found.append(hole)
    return found
