"""Bodies that only lie on another one, with faces that look one way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind


def lying_on_one(known: Known, guided: Sequence[StoppedJoint] = ()) -> list[Inference]:
    """Find bodies that only touch others with their plane faces, which look one way: another one, or one of their
    sub-assembly.

    What is `guided` by walls on both sides of it, with a play, slides between them.
    """
    body = known.body
    slides = {frozenset(body[part] for part in each.inference.parts) for each in guided}
    around: dict[str, dict[str, list[Vector]]] = {}
    met: dict[tuple[str, str], tuple[str, str]] = {}
    # in the order of the file: the first of several bodies that could be added decides what the others touch
    contacts = sorted(known.contacts, key=lambda each: sorted(known.order[part] for part in each.parts))
    jointed = [each.parts for each in known.found if each.joint] + [known.in_order(pair) for pair in known.by_hand]
    for contact in contacts:
        for k, part in enumerate(contact.parts):
            surface, other = contact.surfaces[k], body[contact.parts[1 - k]]
            normal = surface.normal if isinstance(surface, Plane) else np.zeros(3)
            around.setdefault(body[part], {}).setdefault(other, []).append(normal)
            met.setdefault((body[part], other), (part, contact.parts[1 - k]))
    for parts in jointed:
        one, other = (body[part] for part in parts)
        around.setdefault(one, {}).setdefault(other, []).append(np.zeros(3))
        around.setdefault(other, {}).setdefault(one, []).append(np.zeros(3))
    result = []
    for one, others in around.items():
        normals = [normal for other, some in others.items() for normal in some if other != one]
        if one == body[known.fixed[0]] or not normals or not _one_way(normals):
            continue
        if len(others.keys() - {one}) == 1:
            (other,) = others.keys() - {one}
            if {one, other} in slides:
                continue
            part, base = met[one, other]
            evidence = Evidence(EvidenceKind.ENCLOSED, (), f"{part!r} touches {base!r} only, and that on one plane")
        else:
            mates = [other for other in others if other != one and _together(known, body, one, other)]
            if len(mates) != 1:
                continue
            (other,) = mates
            part, base = met[one, other]
            text = f"{part!r} only lies on others, of which {base!r} is in its sub-assembly"
            evidence = Evidence(EvidenceKind.SUBASSEMBLY, (), text)
        result.append(Inference(known.in_order((part, base)), evidence))
    return result


def _one_way(normals: Sequence[Vector]) -> bool:
    """Tell whether all are normals of parallel planes; zeros stand for other surfaces."""
    return all(np.any(n) and np.linalg.norm(np.cross(n, normals[0])) < ACROSS for n in normals)


def _together(known: Known, body: Mapping[str, str], one: str, other: str) -> bool:
    """Tell whether some parts of two bodies are in one sub-assembly that does not hold everything."""
    groups = [{known.group[part] for part in known.names if body[part] == owner} - {()} for owner in (one, other)]
    return bool(groups[0] & groups[1])
