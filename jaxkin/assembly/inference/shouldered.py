"""What a nut presses against a shoulder of a shaft goes with the shaft: cranks, pulleys, inner rings."""

from __future__ import annotations

from collections.abc import Collection

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.stop_faces import WIDER
from jaxkin.joints.evidence import Evidence, EvidenceKind


def pressed_on_shoulders(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Join shafts with their nuts and with what is between a nut and a shoulder of the shaft.

    The shoulder is the end of a thicker length, with which the shaft is in another part: it turns there, as a stud does
    with its ball. That of a bolt, its head, is in none. Where a flat of the shaft keeps some of them from turning, as
    the washers of a friction hinge, what has play on it turns. A ring that is set into another part, too, is a bearing
    drawn as one ring, and goes with that part: a bush is not clamped.
    """
    body, result = known.body, []
    for pair in known.axes:
        thread, nut = pair.one, pair.other.part
        if pair.virtual or nut not in fastening or not all(bore.hole for bore in known.bores[nut]):
            continue
        shaft = thread.part
        on = {each.other.part: each for each in known.axes if each.one is thread and not each.virtual}
        between, shouldered = _pressed(known, nut, shaft, on, thread)
        if any(body[part] == body[shaft] for part in between):
            loose = {part for part in between if on[part].clearance > SAME_FIT * thread.radius}
            between -= {part for part in loose if body[part] != body[shaft]}
        between -= {part for part in known.sleeves if body[part] != body[shaft]}
        if not shouldered or not between - {nut}:
            continue
        thicker = [bore for bore in known.bores[shaft] if _is_thicker(bore, thread)]
        seats = {
            each.other.part for each in known.axes if not each.virtual and any(each.one is bore for bore in thicker)
        }
        if (seats | _sockets(known, shaft)) - between - {shaft}:
            pressed = known.in_order(between - {nut})
            text = f"{nut!r} presses {', '.join(map(repr, pressed))} against a shoulder of {shaft!r}"
            parts = known.in_order({shaft, *between})
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, (("radius", thread.radius),), text)))
    return result


def _pressed(known: Known, nut: str, shaft: str, on: Collection[str], axis: Bore) -> tuple[set[str], bool]:
    """Find the parts on a thread that lie flat on each other from a nut on, and whether one lies on the shaft."""
    found, shouldered = [nut], False
    for part in found:  # grows while it is read
        for other in known.parts_flat_on(part, axis.axis):
            shouldered |= other == shaft
            found += [other] if other in on and other not in found else []
    return {*found}, shouldered


def _sockets(known: Known, shaft: str) -> set[str]:
    """Find the parts in which balls of a shaft are."""
    return {each.hole.part for each in known.sockets if each.ball.part == shaft}


def _is_thicker(bore: Bore, thread: Bore) -> bool:
    """Tell whether a pin of the same part is thicker than its thread, on the same axis."""
    return not bore.hole and bore.radius > WIDER * thread.radius and bore.on_axis_of(thread)
