"""Bodies that are set on a pin though nothing drawn holds them there: brackets that would jam, what fits exactly beside
what has play."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.coaxial_features import CoaxialFeatures, coaxial_features
from jaxkin.assembly.inference.contact_faces import shared_span
from jaxkin.assembly.inference.hinges import MIN_GUIDED
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.slide_stops import Stop
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.components import connected

MAX_BEARING_OFFSET = 0.02
"""Distance of the axis of a bearing from that of its shaft, over the radius of the shaft, at most."""


def set_on_pins(known: Known, joined: Sequence[StoppedJoint], guided: Sequence[Inference] = ()) -> list[StoppedJoint]:
    """Find bodies that do not move on the pin that they fit exactly, though exact contacts let them slide.

    What is `joined` by a hinge already is left to that, and what is `guided` along the pin by faces or on wheels of a
    third body slides there, as on a lead screw.
    """
    body, result = known.body, []
    hinged = {frozenset(body[part] for part in each.inference.parts) for each in joined}
    turning = [*known.found, *(each.inference for each in joined)]
    for coaxial in coaxial_features(known):
        pair = coaxial.first
        if pair.virtual or not any(coaxial.pins) or coaxial.owners in hinged:
            continue
        if length := _jams(known, coaxial):
            text = (
                f"a face keeps it from turning on the pin of {pair.one.part!r}, and it holds no more than {length:.3g}"
            )
            text += f" of a radius of {pair.other.radius:.4g}: it would jam on a slide"
            result.append(_held(known, pair, text, ("length", length), Stop.SHORT))
        elif _slides_along(known, pair, guided):
            continue
        elif other := _turning(known, coaxial, turning):
            text = f"it fits the shaft of {pair.one.part!r} exactly, which turns in {other!r}: it turns with it"
            result.append(_held(known, pair, text, ("clearance", pair.clearance), Stop.TIGHT))
        elif all(coaxial.pins) and (play := _looser(known, pair)):
            text = f"it fits the pin of {pair.one.part!r} exactly, on which others have a play of {play:.2g}"
            result.append(_held(known, pair, text, ("play", play), Stop.TIGHT))
    return result


def _held(known: Known, pair: CommonAxis, text: str, length: tuple[str, float], stop: Stop) -> StoppedJoint:
    parts = known.in_order(pair.parts)
    evidence = Evidence(EvidenceKind.FASTENER, (("radius", pair.other.radius), length), f"{pair.other.part!r}: {text}")
    return StoppedJoint(Inference(parts, evidence), stop, replaces_slide=True)


def _jams(known: Known, coaxial: CoaxialFeatures) -> float | None:
    """Find the length along a pin by which faces and holes guide a body that faces keep from turning; None if it could
    slide, or turn.

    A plate on a rod between rails is long enough, the ear of a bracket is not.
    """
    pair, axis = coaxial.first, coaxial.first.one.axis
    flat = [(contact, contact.surfaces[0]) for contact in coaxial.touching if contact.contact_state.is_flat]
    if not flat or len(flat) + sum(coaxial.pins) < len(coaxial.touching):
        return None
    if any(not isinstance(face, Plane) or abs(float(face.normal @ axis)) > ACROSS for _, face in flat):
        return None  # a face across the axis stops the slide
    holes = [end for each in coaxial.found for end in each.other.reach(axis)]
    shared = [shared_span(contact, known.solids, axis) for contact, _ in flat]
    guided = max([max(holes) - min(holes), *(high - low for low, high in shared)])
    return guided if guided < MIN_GUIDED * pair.other.radius else None


def _slides_along(known: Known, pair: CommonAxis, guided: Sequence[Inference]) -> bool:
    """Tell whether a third body guides what is on a pin along it."""
    body = known.body
    owner, hub = body[pair.one.part], body[pair.other.part]
    for each in guided:
        owners = {body[part] for part in each.parts}
        if hub in owners and owner not in owners and each.joint is not None:
            axis = np.asarray(each.joint.frames_1, float)[0, :3, 2]
            if np.linalg.norm(np.cross(axis, pair.one.axis)) < ACROSS:
                return True
    return False


def _turning(known: Known, coaxial: CoaxialFeatures, found: Sequence[Inference]) -> str | None:
    """Find the part in which a shaft turns, by a joint that was `found` on a common axis, where nothing but the
    shaft holds the body on it, which fits it exactly.

    A crank, a wheel or a tyre goes round with what it is on. A rod on a crank, and a nut on a lead screw, are guided by
    others.
    """
    pair, body = coaxial.first, known.body
    shaft, hub = body[pair.one.part], body[pair.other.part]
    if abs(pair.clearance) > SAME_FIT * pair.other.radius or pair.other.part in known.sleeves:
        return None
    for each in found:
        if each.joint is None or each.joint.kind is not JointKind.REVOLUTE:
            continue
        housing = next((part for part in each.parts if body[part] != shaft), None)
        frame = np.asarray(each.joint.frames_1, float)[0]
        offset = frame[:3, 3] - pair.one.point
        apart = np.linalg.norm(np.cross(offset, pair.one.axis))
        if (
            housing is not None
            and shaft in {body[part] for part in each.parts}
            and body[housing] != hub
            and np.linalg.norm(np.cross(frame[:3, 2], pair.one.axis)) < ACROSS
            and apart <= MAX_BEARING_OFFSET * pair.one.radius
            and not _is_tied(known, hub, shaft)
        ):
            return housing
    return None


def _is_tied(known: Known, hub: str, shaft: str) -> bool:
    """Tell whether contacts, axes or joints tie a body to the fixed parts otherwise than over its shaft."""
    body = known.body
    pairs = [*known.touching, *known.by_hand, *(pair.parts for pair in known.axes)]
    pairs += [each.parts for each in known.found if each.joint]
    ties = [tuple(body[part] for part in pair) for pair in pairs]
    free = [pair for pair in ties if shaft not in pair]
    groups = connected({*body.values()} - {shaft}, free)
    return any(hub in group and any(body[part] in group for part in known.fixed) for group in groups)


def _looser(known: Known, pair: CommonAxis) -> float | None:
    """Find the play of another body on the same pin, where that of a pair is none; None where all fit alike.

    The pin is held by the hole of another part, as a column in its base: a pin that is alone may turn in what it fits,
    and pass through the others. A bush or a nut in another part is there for the pin to move in it, however it fits;
    and what is between others slides.
    """
    body, fit = known.body, SAME_FIT * pair.other.radius
    on = [each for each in known.axes if each.one is pair.one and not each.virtual]
    owner, hub = body[pair.one.part], body[pair.other.part]
    if abs(pair.clearance) > fit or pair.other.part in known.sleeves:
        return None
    if not any(body[each.other.part] == owner for each in on):
        return None
    others = [each for each in on if body[each.other.part] not in (owner, hub)]
    own = pair.other.reach(pair.one.axis)
    ends = [each.other.reach(pair.one.axis) for each in on if body[each.other.part] != hub]
    if any(high <= own[0] for _, high in ends) and any(low >= own[1] for low, _ in ends):
        return None  # a linear bearing on its rod, which others hold on both ends
    return max((each.clearance for each in others if each.clearance > fit), default=None)
