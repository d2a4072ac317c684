"""Short parallel pins with play in holes of another part that lies on theirs: dowels, bosses, threaded inserts."""

from __future__ import annotations

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.coaxial_features import coaxial_features
from jaxkin.assembly.inference.fasteners import beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.walls import MAX_TURN, turns
from jaxkin.joints.evidence import Evidence, EvidenceKind

MIN_GUIDE = 2.5
"""Length in its hole of a pin that guides beside another one, over its radius, at least: what only places a part on
another one is shorter."""


def _turn(known: Known, pin: CommonAxis) -> float:
    """Measure how far walls let two bodies turn about a pin that joins them, as pegs that are not round leave it."""
    one, other = ([each for each in known.parts if known.body[each.name] == known.body[part]] for part in pin.parts)
    return turns(one, other, pin.other.point, pin.one.axis)


def dowelled(known: Known) -> list[Inference]:
    """Join bodies that lie flat on each other, across two or more parallel pins of one in holes of the other: pins with
    play, all of them short. Screws that hold them together are left out of such drawings."""
    result = []
    for coaxial in coaxial_features(known):
        pins = [each for each in coaxial.found if not each.virtual]
        parallel = any(beside(each.one, pins[0].one) for each in pins[1:])
        short = all(engaged(each) < MIN_GUIDE * each.other.radius for each in pins)
        flat = (known.touches_only_across(*contact.parts, coaxial.first.one.axis) for contact in coaxial.touching)
        if not (pins and short and coaxial.touching and all(flat)):
            continue
        one, other = pins[0].parts
        if parallel:
            sizes = (("axes", float(len(pins))), ("clearance", pins[0].clearance))
            text = f"{len(pins)} short parallel pins of {one!r} in {other!r}, and faces that meet around them"
            result.append(Inference(known.in_order((one, other)), Evidence(EvidenceKind.BOLT_PATTERN, sizes, text)))
        elif (turn := _turn(known, pins[0])) <= MAX_TURN:
            sizes = (("turn", turn), ("clearance", pins[0].clearance))
            text = (
                f"a short pin of {one!r} in {other!r}, faces that meet around it, and walls that leave {turn:.2g} rad"
            )
            result.append(Inference(known.in_order((one, other)), Evidence(EvidenceKind.BOLT_PATTERN, sizes, text)))
    return result
