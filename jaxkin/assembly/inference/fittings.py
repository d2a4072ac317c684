"""Screwed fittings: threads with a hexagon and a bore along them, such as couplers of hoses."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.set_screws import FITTED
from jaxkin.assembly.inference.sleeves import is_hollow
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.surfaces import Plane

SIDES = 6
"""Plane faces of a hexagon for a wrench."""
ALIKE = 0.01
"""Distances of these faces from the axis that differ by no more, over the distance, are those of one hexagon."""


def screwed_fittings(known: Known) -> list[Inference]:
    """Join hollow parts whose thread, drawn as a plain cylinder, fits a hole, with a hexagon down on the face there,
    and tubes that meet the end of such a thread inside of the hole.

    A hexagon is for a wrench: what has one is tightened, and does not turn by itself. A tube that it is tightened
    against would be pushed out of the hole, if it were not screwed into that from the other side.
    """
    result = []
    for pair in known.axes:
        (fitting, host), axis = pair.parts, pair.one.axis
        if (
            not _fits(pair)
            or not _is_fitting(known, pair)
            or not known.touches_only_across(fitting, host, axis, pins=False)
        ):
            continue
        result.append(known.fastened(pair, f"the hexagon of {fitting!r} is down on {host!r}, into which it is screwed"))
        for other in known.axes:
            tube = other.one.part
            if other.other is pair.other and _fits(other) and known.touches_only_across(fitting, tube, axis):
                text = f"{fitting!r} is tightened against the end of {tube!r} in their hole of {host!r}"
                result.append(known.fastened(other, f"{text}: both are screwed in"))
    return result


def _fits(pair: CommonAxis) -> bool:
    """Tell whether a pin is in its hole as a thread is, drawn as such or as a plain cylinder."""
    return not pair.virtual and (pair.threaded or abs(pair.clearance) <= FITTED * pair.other.radius)


def _is_fitting(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a part is hollow along its thread, and has a hexagon about it that is wider."""
    name, axis = pair.one.part, pair.one.axis
    own = known.bores_on(name, pair.one)
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
