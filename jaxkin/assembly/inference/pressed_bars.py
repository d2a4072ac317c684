"""Bars that the tip of a screw presses against the far wall of what they are in: tool bits, scraper and slide bars."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.contact_faces import faces_of
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS, WIDER, stands_across
from jaxkin.assembly.inference.walls import MAX_SIDE_PLAY, facing
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.joints.evidence import Evidence, EvidenceKind


def pressed_bars(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Join a screw, in the hole of its thread, with what its tip lies on, where a face of the body that it is screwed
    into stands behind that: drawn tight, it clamps the bar.

    What a screw moves has room behind it, and what is behind a gib is another body.
    """
    body, result = known.body, []
    for pair in known.axes:
        if not pair.threaded or pair.one.part not in fastening:
            continue
        screw, host = pair.parts
        for bar in known.parts_flat_on(screw, pair.one.axis):
            into = _into(known, bar, pair.one)
            if into is None or body[bar] in (body[host], body[screw]):
                continue
            behind = [part for part in known.parts if body[part.name] == body[host]]
            gap = _gap_behind(known.solids[bar], behind, into)
            if gap is not None:
                text = f"the tip of {screw!r} presses {bar!r} against {host!r}, with a play of {gap:.2g} behind it"
                sizes = (("radius", pair.one.radius), ("play", gap))
                parts = known.in_order((screw, bar))
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _into(known: Known, bar: str, pin: Bore) -> Vector | None:
    """Find the direction in which the tip of a screw presses on a part that lies flat on it; None where that lies on
    nothing but its head, which is wider than its pin."""
    for contact in known.between[frozenset((pin.part, bar))]:
        if not stands_across(contact.surfaces[0], pin.axis):
            continue
        own = faces_of(contact, known.solids)[contact.parts.index(pin.part)]
        offsets = own.triangles.reshape(-1, 3) - pin.point
        if np.linalg.norm(np.cross(offsets, pin.axis), axis=1).max() <= WIDER * pin.radius:
            return np.sign(offsets[0] @ pin.axis) * pin.axis
    return None


def _gap_behind(bar: Part, others: list[Part], into: Vector) -> float | None:
    """Measure the gap between the far side of a bar and the body that it is pressed against; None where that is not
    near."""
    gaps = [gap for normal, gap, _ in facing(bar, others) if normal @ into > 1 - ACROSS]
    thick = float(np.ptp(bar.outermost @ into))
    return min((gap for gap in gaps if gap <= MAX_SIDE_PLAY * thick), default=None)
