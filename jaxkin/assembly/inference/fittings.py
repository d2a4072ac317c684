"""Screwed fittings: threads with a hexagon and a bore along them, such as couplers of hoses."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.clamped import FITTED
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import is_hollow
from jaxkin.assembly.inference.trapped import ACROSS, stands_across
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind

SIDES = 6
"""Plane faces of a hexagon for a wrench."""
ALIKE = 0.01
"""Distances of these faces from the axis that differ by no more, over the distance, are those of one hexagon."""


def screwed_fittings(known: Known) -> list[Inference]:
    """Join hollow parts whose thread, drawn as a plain cylinder, fits a hole, with a hexagon down on the face there.

    A hexagon is for a wrench: what has one is tightened, and does not turn by itself.
    """
    result = []
    for pair in known.axes:
        fitting, host = pair.parts
        fits = pair.threaded or abs(pair.clearance) <= FITTED * pair.other.radius
        if pair.virtual or not fits or not _is_fitting(known, pair) or not _is_down(known, pair):
            continue
        text = f"the hexagon of {fitting!r} is down on {host!r}, into which it is screwed"
        sizes = (("radius", pair.one.radius), ("clearance", pair.clearance))
        parts = known.in_order(pair.parts)
        result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _is_fitting(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a part is hollow along its thread, and has a hexagon about it that is wider."""
    name, axis = pair.one.part, pair.one.axis
    own = [bore for bore in known.bores[name] if bore.on_axis_of(pair.one)]
    if not is_hollow(known, name, own):
        return False
    planes = [face.surface for face in known.solids[name].faces if isinstance(face.surface, Plane)]
    beside = [plane for plane in planes if abs(float(plane.normal @ axis)) < ACROSS]
    away = [float((plane.point - pair.one.point) @ plane.normal) for plane in beside]
    largest = max(away, default=0.0)
    if largest <= pair.one.radius or sum(each >= (1 - ALIKE) * largest for each in away) != SIDES:
        return False
    sides = [plane.normal for plane, each in zip(beside, away, strict=True) if each >= (1 - ALIKE) * largest]
    cosines = np.array([[one @ other for other in sides] for one in sides])
    steps = np.abs(2 * cosines - np.round(2 * cosines))  # normals a multiple of 60 degrees apart
    return bool(np.all(steps <= ALIKE))


def _is_down(known: Known, pair: CommonAxis) -> bool:
    """Tell whether all that two parts have in contact beside the thread are faces across it."""
    planes = [
        contact.surfaces[0]
        for contact in known.contacts
        if {*contact.parts} == {*pair.parts} and not contact.contact_state.is_pin
    ]
    return bool(planes) and all(stands_across(plane, pair.one.axis) for plane in planes)
