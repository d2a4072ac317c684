"""Nuts that lock a thread: what is screwed into a part and does not turn in it."""

from __future__ import annotations

from collections.abc import Collection

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.set_screws import FITTED
from jaxkin.assembly.inference.stop_faces import WIDER, gap, stands_across
from jaxkin.joints.evidence import Evidence, EvidenceKind


def locked_threads(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Join parts of which one is screwed into the other, as a rod end or an adjusting screw is: a nut lies on the other
    part, flat or on its round side, and nothing but the thread pulls it there.

    A pin whose head or second nut stands beyond the other part is that of a hinge, or of a clamp. A washer there, loose
    on the pin and away from the other part, is pressed on something else.
    """
    result = []
    for on_nut in known.axes:
        pin, nut = on_nut.one, on_nut.other.part
        if on_nut.virtual or nut not in fastening or not all(bore.hole for bore in known.bores[nut]):
            continue
        threads = [pair for pair in known.axes if pair.one.part == pin.part and pair.one.on_axis_of(pin)]
        for pair in threads:
            host = pair.other.part
            fits = pair.threaded or abs(pair.clearance) <= FITTED * pair.other.radius
            if host == nut or not fits or not _lies_on(known, nut, host, pin):
                continue
            after = float((on_nut.other.point - pair.other.point) @ pin.axis)
            others = [
                each.other for each in threads if each.other.part not in (nut, host) and _presses(known, each, host)
            ]
            beyond = any(float((each.point - pair.other.point) @ pin.axis) * after < 0 for each in others)
            own, theirs = (known.measured.stops(known.solids[part], pair.other) for part in (pin.part, host))
            ahead = after * float(pin.axis @ pair.other.axis) > 0
            own = [stop for stop in own if stop.outer > WIDER * pair.other.radius]  # its end passes through the hole
            one, other = (own, theirs) if ahead else (theirs, own)
            if not beyond and gap(one, other, pair.other.radius) is None:
                text = f"{pin.part!r} is screwed into {host!r} and locked by {nut!r}"
                parts = known.in_order((pin.part, host, nut))
                sizes = (("radius", pin.radius), ("clearance", pair.clearance))
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _presses(known: Known, on_pin: CommonAxis, host: str) -> bool:
    """Tell whether what is on a pin may press on a part there: it is tight on the pin, or touches the part."""
    tight = on_pin.clearance <= FITTED * on_pin.other.radius
    return tight or frozenset((on_pin.other.part, host)) in known.touching


def _lies_on(known: Known, one: str, other: str, axis: Bore) -> bool:
    """Tell whether two parts touch with a plane face across an axis: on a plane one, or on a round side."""
    contacts = known.between.get(frozenset((one, other)), ())
    return any(stands_across(face, axis.axis) for each in contacts for face in each.surfaces)
