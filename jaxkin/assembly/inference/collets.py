"""Split rings that grip a shaft: halves with the steps of its groove inside, and the ring that closes them."""

from __future__ import annotations

from jaxkin.assembly.inference.axes import shared_length
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.joints.evidence import Evidence, EvidenceKind

STEP_FIT = 0.05
"""Radius of a step inside of a split ring less that of the shaft there, over the radius, at most."""


def collets(known: Known) -> list[Inference]:
    """Join split rings with the shaft that they grip, and with the part that holds their pieces together.

    A piece has two radii inside, those of a groove of the shaft and of the shaft beside it: it is laid on from the side
    and cannot slide, and nothing would close it that did not press it on. A shell of a plain bearing, of which the
    shaft turns, has one radius.
    """
    result = []
    for pair in known.axes:
        piece, shaft = pair.other, pair.one
        if pair.virtual or piece.part in known.fixed or not piece.is_half_open:
            continue
        if not _has_steps(known, piece, shaft) or any(piece.part in each.parts for each in result):
            continue
        around = [each for each in known.bores_on(piece.part, piece) if not each.hole]
        closing = (
            each
            for name in known.names
            if name not in (piece.part, shaft.part)
            for each in known.bores[name]
            if each.hole and any(_closes(each, outside) for outside in around)
        )
        # what also holds other pieces comes first; the hole that the shaft itself is in, too, is no closing ring
        if (ring := next(closing, None)) is not None:
            text = f"the split ring {piece.part!r} is in a groove of {shaft.part!r}, and {ring.part!r} closes it"
            parts = known.in_order((piece.part, shaft.part, ring.part))
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, (("radius", piece.radius),), text)))
    return result


def _has_steps(known: Known, piece: Bore, shaft: Bore) -> bool:
    """Tell whether a piece has holes of two radii about a shaft, each on a pin of the shaft that fits it."""
    fitted = set()
    for hole in known.bores[piece.part]:
        for pin in known.bores[shaft.part]:
            fits = abs(hole.radius - pin.radius) <= STEP_FIT * hole.radius and hole.on_axis_of(pin)
            if hole.hole and not pin.hole and fits and shared_length(hole, pin) > 0:
                fitted.add(id(pin))
    return len(fitted) > 1


def _closes(hole: Bore, outside: Bore) -> bool:
    """Tell whether a hole holds the outside of a piece."""
    fits = abs(hole.radius - outside.radius) <= STEP_FIT * hole.radius
    return bool(fits and hole.on_axis_of(outside) and shared_length(hole, outside) > outside.radius * STEP_FIT)
