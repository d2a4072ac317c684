"""Bars that the tip of a screw presses against the far wall of what they are in: tool bits, scraper and slide bars."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS, WIDER
from jaxkin.assembly.inference.walls import MAX_SIDE_PLAY, facing
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
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
        for contact in known.contacts:
            if pair.one.part not in contact.parts or not contact.contact_state.is_flat:
                continue
            bar = contact.parts[contact.parts[0] == pair.one.part]
            into = _into(known, contact, pair)
            if into is None or body[bar] in (body[pair.other.part], body[pair.one.part]):
                continue
            behind = [part for part in known.parts if body[part.name] == body[pair.other.part]]
            gap = _gap_behind(known.solids[bar], behind, into)
            if gap is not None:
                screw, host = pair.parts
                text = f"the tip of {screw!r} presses {bar!r} against {host!r}, with a play of {gap:.2g} behind it"
                sizes = (("radius", pair.one.radius), ("play", gap))
                parts = known.in_order((screw, bar))
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _into(known: Known, contact: Contact, pair: CommonAxis) -> Vector | None:
    """Find the direction in which the tip of a screw presses by a contact; None where the contact is not of its tip,
    but of its head."""
    plane, pin = contact.surfaces[0], pair.one
    if not isinstance(plane, Plane) or np.linalg.norm(np.cross(plane.normal, pin.axis)) > ACROSS:
        return None
    face = contact.faces[contact.parts.index(pin.part)]
    own = next(each for each in known.solids[pin.part].faces if each.name == face)
    away = np.linalg.norm(np.cross(own.triangles.reshape(-1, 3) - pin.point, pin.axis), axis=1)
    side = np.sign((plane.point - pin.point) @ pin.axis)
    return side * pin.axis if away.max() <= WIDER * pin.radius else None


def _gap_behind(bar: Part, others: list[Part], into: Vector) -> float | None:
    """Measure the gap between the far side of a bar and the body that it is pressed against; None where that is not
    near."""
    gaps = [gap for normal, gap, _ in facing(bar, others) if normal @ into > 1 - ACROSS]
    thick = float(np.ptp(bar.outermost @ into))
    return min((gap for gap in gaps if gap <= MAX_SIDE_PLAY * thick), default=None)
