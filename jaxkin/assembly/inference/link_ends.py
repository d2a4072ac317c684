"""Ends of links whose screw is not drawn: a hole over a hole of another size of the next link."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.axes import MAX_BESIDE, MAX_TAPPED, CommonAxis, engaged
from jaxkin.assembly.inference.fasteners import beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import stands_across
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind


def hinged_ends(known: Known) -> list[Inference]:
    """Infer that links turn at the ends where their screw is not drawn: see `link_ends`."""
    result = []
    for link, pair in link_ends(known):
        wide, narrow = sorted((pair.one, pair.other), key=lambda bore: -bore.radius)
        parts = known.in_order(pair.parts)
        joint = pairs.revolute("-".join(parts), *parts, point=narrow.point, axis=narrow.axis)
        text = f"a hole of radius {wide.radius:.4g} beside one of {narrow.radius:.4g}, as for a screw to turn on: "
        text += f"all else that holds {link!r} is one pin beside it"
        sizes = (("radius", wide.radius), ("clearance", wide.radius - narrow.radius))
        result.append(Inference.of(joint, Evidence(EvidenceKind.VIRTUAL_PIN, sizes, text)))
    return result


def link_ends(known: Known) -> list[tuple[str, CommonAxis]]:
    """Find the links of which a hole is beside a hole of another body, of another size as one that a screw cuts its
    thread in, with nothing in both: each with that axis.

    All that ties the link otherwise is a pin of a third body, parallel to that axis, and faces across it: it may lie on
    the part with the other hole. With one end only it would carry nothing, and both ends on one body would lock it.
    """
    body = known.body
    empty = [pair for pair in (*known.tapped, *known.far) if pair.virtual and _are_of_a_screw(pair)]
    if not empty:
        return []
    touching = {frozenset(body[part] for part in tie) for tie in known.touching}
    ties = {frozenset(body[part] for part in tie) for tie in known.jointed}
    ties |= {frozenset(body[part] for part in pair.parts) for pair in known.axes}
    result = []
    for pair in empty:
        for link, other in (pair.parts, pair.parts[::-1]):
            own, beyond = body[link], body[other]
            around = {owner for tie in ties if own in tie for owner in tie} - {own}
            meets = {owner for tie in touching if own in tie for owner in tie} - {own, beyond}
            alone = sum(own in {body[part] for part in each.parts} for each in empty) == 1
            third = len(around) == 1 and meets <= around and beyond not in {own, *around}
            if third and alone and _is_hinged(known, own, pair):
                result.append((link, pair))
                break
    return result


def _are_of_a_screw(pair: CommonAxis) -> bool:
    """Tell whether two holes beside each other are one that a screw goes through and one that it is screwed into."""
    radius = max(pair.one.radius, pair.other.radius)
    return pair.tapped and abs(pair.clearance) <= MAX_TAPPED * radius and -engaged(pair) <= MAX_BESIDE * radius


def _is_hinged(known: Known, own: str, end: CommonAxis) -> bool:
    """Tell whether a body is on pins of one axis, beside and parallel to the hole of its end, and meets faces across
    it only."""
    body = known.body
    on = [pair for pair in known.axes if own in {body[part] for part in pair.parts}]
    on = [pair for pair in on if len({body[part] for part in pair.parts}) > 1]
    touching = [each for each in known.contacts if own in {body[part] for part in each.parts}]
    touching = [each for each in touching if len({body[part] for part in each.parts}) > 1]
    flat = all(stands_across(each.surfaces[0], end.one.axis) for each in touching if not each.contact_state.is_pin)
    one_axis = bool(on) and all(pair.other.on_axis_of(on[0].other, length=0.5) for pair in on)
    along = one_axis and bool(np.linalg.norm(np.cross(on[0].other.axis, end.one.axis)) < 0.01)
    return flat and along and beside(on[0].other, end.one)
