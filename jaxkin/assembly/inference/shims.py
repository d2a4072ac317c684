"""Shims: plates that fill the gap between two parts of one body, which a bolt and its nut draw together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from jaxkin._names import listed
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.contact_faces import faces_of
from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import is_round_about
from jaxkin.assembly.inference.stop_faces import stands_across
from jaxkin.contacts.overlap import flat, overlap
from jaxkin.geometry.pose import frame
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind

COVERED = 0.9
"""Share of a shim that is in front of the faces on both sides, at least: of a lever between two cheeks most stands
out."""


def shims(known: Known, every: Sequence[Stack]) -> list[Inference]:
    """Join plates with the body that clamps them: the head of a bolt and its nut, or their washers, lie on two parts of
    it, the faces of which the plate touches on both sides, with nothing of it beside them.

    The bolt draws the two parts together until they clamp what is between, as it cannot the two cheeks of a fork that
    are one part. What is round about the bolt may be a roller, and what touches anything else is a link.
    """
    result = []
    for stack in every:
        axis, owner = stack.axis, known.body[stack.fasteners[0]]
        pressed = {part for part in stack.held if known.touches_across(part, axis.axis, *stack.fasteners)}
        for part in (part for part in stack.held if known.body[part] != owner and known.bores_on(part, axis)):
            if is_round_about(known, part, axis) or not _is_alone(known, part, owner):
                continue
            behind, ahead = _side(known, part, axis, -1.0), _side(known, part, axis, 1.0)
            between = [side.parts & pressed for side in (behind, ahead)]
            filled = min(behind.area, ahead.area) * (behind.height + ahead.height)
            if not all(between) or between[0] & between[1] or filled < COVERED * known.solids[part].volume:
                continue
            host, other = known.in_order(known.in_order(each)[0] for each in between)
            drawing = listed([repr(each) for each in stack.fasteners])
            text = f"{part!r} fills the gap between {host!r} and {other!r}, which {drawing} draw together"
            evidence = Evidence(EvidenceKind.FASTENER, (("radius", axis.radius),), text)
            result.append(Inference(known.in_order((part, host)), evidence))
    return result


def _is_alone(known: Known, part: str, owner: str) -> bool:
    """Tell whether all that a part touches, or has an axis in common with, is of one other body."""
    pairs = [*known.touching, *(frozenset(pair.parts) for pair in known.axes)]
    return {known.body[each] for pair in pairs if part in pair for each in pair - {part}} == {owner}


class _Side(NamedTuple):
    """What lies flat on one side of a part."""

    parts: set[str]
    height: float
    """Where it does along the normal of that side."""
    area: float
    """What its faces share with those of the part."""


def _side(known: Known, part: str, axis: Bore, way: float) -> _Side:
    """Find what lies flat on a part, ahead along an axis or behind it; `way` is 1 or -1."""
    normal = way * axis.axis
    x, y, _, _ = frame(axis.point, normal).T[:, :3]
    parts, height, area = set[str](), -np.inf, 0.0
    for contact in (each for each in known.contacts if each.contact_state.is_flat and part in each.parts):
        plane, faces = contact.surfaces[contact.parts.index(part)], faces_of(contact, known.solids)
        if isinstance(plane, Plane) and stands_across(plane, normal) and plane.normal @ normal > 0:
            one, other = (flat(face.triangles, axis.point, x, y) for face in faces)
            shared = overlap(one, other, 0.0)
            parts |= {*contact.parts} - {part}
            height = max(height, float(plane.point @ normal))
            area += shared.area if shared else 0.0
    return _Side(parts, height, area)
