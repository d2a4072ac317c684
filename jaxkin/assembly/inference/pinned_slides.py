"""Pins across what slides: a tube that is pulled out of another one is held by the pin through both."""

from __future__ import annotations

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import MAX_HOLE_ARC, NEAR_LENGTH
from jaxkin.assembly.inference.hinges import MIN_TURN
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.slides import slide_between
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.walls import turns
from jaxkin.joints.evidence import Evidence, EvidenceKind


def pinned_slides(known: Known) -> list[Inference]:
    """Join bodies of which one is between faces of the other in two directions, so that it only slides, and a pin of
    the one goes across that through holes of both. A knob of the slide itself may be in a slot.

    Where no pin is drawn, round holes of one size in both are in line for one: a slide that is meant to move passes
    them, and nobody draws it just there.
    """
    body, result = known.body, []
    for pair in known.axes:
        owners = [body[part] for part in pair.parts]
        if owners[0] == owners[1] or pair.other.open_arc > MAX_HOLE_ARC:
            continue
        if pair.virtual:
            on = [pair.one.part] if pair.one.open_arc <= MAX_HOLE_ARC and _are_one_size(pair) else []
        else:
            pins = [each for each in known.axes if each.one is pair.one and body[each.other.part] == owners[0]]
            on = [each.other.part for each in pins]
        for part, beyond in ((pair.other.part, owners[0]), (on[0], owners[1])) if on else ():
            one, others = known.solids[part], known.around(known.solids[part], body).get(beyond, [])
            found = slide_between(one, others)
            if found is None or abs(float(found[0] @ pair.one.axis)) > ACROSS:
                continue
            if turns([one], others, pair.one.point, pair.one.axis) <= MIN_TURN:
                result.append(_held(known, pair, part, found[1]))
    return result


def _are_one_size(pair: CommonAxis) -> bool:
    """Tell whether two holes are of one size and on one axis, as those that are drilled for one pin."""
    radius = pair.other.radius
    return abs(pair.clearance) <= SAME_FIT * radius and pair.offset <= NEAR_LENGTH * radius


def _held(known: Known, pair: CommonAxis, part: str, play: float) -> Inference:
    pin, other = pair.parts
    if pair.virtual:
        text = f"equal bores of radius {pair.other.radius:.4g} without a pin go across {pin!r} and {other!r}; "
    else:
        text = f"{pin!r} goes across {other!r}; "
    text += f"{part!r} is between faces on both sides in two directions, with a play of "
    text += f"{play:.2g}, and neither turns on the pin nor slides"
    kind = EvidenceKind.VIRTUAL_PIN if pair.virtual else EvidenceKind.CLEARANCE
    evidence = Evidence(kind, (("clearance", pair.clearance), ("play", play)), text)
    return Inference(known.in_order(pair.parts), evidence)
