"""Retaining rings: thin rings that spring into the groove of a shaft or of a bore, and go with it."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import GROOVE
from jaxkin.assembly.inference.stop_faces import play
from jaxkin.joints.evidence import Evidence, EvidenceKind

MAX_RING_WIDTH = 0.6
"""Width of a retaining ring over the radius of its groove, at most: those of DIN 471 have 0.1 to 0.3."""


def retaining_rings(known: Known) -> list[Inference]:
    """Join rings with the part in whose groove they are: it is drawn wider, or narrower, than the ring is when it is
    relaxed, and its faces hold the ring closely on both sides."""
    result = []
    for pair in known.axes:
        if pair.virtual or not pair.tight:
            continue
        for ring, host in (pair.parts, pair.parts[::-1]):
            if ring not in known.fixed and _is_in_groove(known, pair, ring, host):
                sizes = (("radius", pair.other.radius), ("clearance", pair.clearance))
                text = f"the ring {ring!r} springs into a groove of {host!r}"
                parts = known.in_order(pair.parts)
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _is_in_groove(known: Known, pair: CommonAxis, ring: str, host: str) -> bool:
    """Tell whether a thin part is between faces of another one that leave it little room along an axis."""
    width = float(np.ptp(known.solids[ring].outermost @ pair.one.axis))
    if width > MAX_RING_WIDTH * pair.other.radius:
        return False
    own, other = (known.measured.stops(known.solids[part], pair.other) for part in (ring, host))
    room = play(own, other, pair.other.radius)
    return room is not None and room <= GROOVE * width
