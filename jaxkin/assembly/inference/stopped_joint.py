"""Inferences that may replace a joint that slides, and the joint of two bodies about a common axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.axes import MAX_TILT, CommonAxis, shared_length
from jaxkin.assembly.inference.bores import NEAR_LENGTH, SAME_ANGLE, SAME_LENGTH, Bore
from jaxkin.assembly.inference.coaxial_features import CoaxialFeatures
from jaxkin.assembly.inference.inference import Inference, offset_told
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.slide_stops import Stop, slide_doubt
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind

NEAR_PLAY = 0.5
"""Play between faces along the axis, over the radius, up to which it is that of a hinge: tenths of a millimetre beside
a pin. What slides on purpose may have a stroke of no more than its own diameter, as the ram of a press."""


class StoppedJoint(NamedTuple):
    """An inference that may replace a sliding joint, and what stops the slide."""

    inference: Inference
    """A joint, or that two parts are one body."""
    stop: Stop
    replaces_slide: bool
    """Whether another joint of the two bodies slides, by exact contacts or as inferred: this one takes its place where
    that slide is of no use. Otherwise this one is all that is inferred of them."""


def joint_about(
    known: Known, coaxial: CoaxialFeatures, stop: Stop, free: float | None, room: float | None, touching: bool = False
) -> StoppedJoint:
    """Make a revolute joint with a play `free` along the axis, or a cylindrical one without it.

    `stop` is what stops the slide, and `room` the play that faces leave, None without faces on both sides.
    """
    pair, hole, exact = coaxial.first, coaxial.first.other, any(coaxial.pins)
    parts = known.in_order(pair.parts)
    make = pairs.cylindrical if free is None else pairs.revolute
    axis = _line(known, pair, coaxial.owners)
    middle = axis.point + ((hole.point - axis.point) @ axis.axis) * axis.axis
    joint = make("-".join(parts), *parts, point=middle, axis=axis.axis)
    sizes = [("radius", hole.radius), ("clearance", pair.clearance), ("offset", pair.offset), ("tilt", pair.tilt)]
    sizes += [] if free is None else [("play", free)]
    if pair.virtual:
        kind, text = EvidenceKind.VIRTUAL_PIN, f"{_bores_told(pair)} without a pin"
    else:
        how = "a clearance" if pair.clearance >= 0 else "an interference"
        fit = "fits" if exact else f"has {how} of {abs(pair.clearance):.2g}{offset_told(pair.offset, hole.radius)}"
        kind, text = EvidenceKind.CLEARANCE, f"the pin of radius {pair.one.radius:.4g} {fit}"
    doubt = None if touching else slide_doubt(stop, room, hole.radius)
    evidence = Evidence(kind, tuple(sizes), f"{text}; {_told(stop, free, room)}", doubt)
    # faces that stop a pin with play are no second reading: there is no other joint of the two bodies
    faced = stop is Stop.FACES or (stop is Stop.SHORT and room is not None)
    replaces = exact or not (faced or stop is Stop.NONE)
    return StoppedJoint(Inference.of(joint, evidence), stop, replaces)


def near_first(stopped: Sequence[StoppedJoint]) -> tuple[list[StoppedJoint], list[StoppedJoint]]:
    """Split joints whose slide faces stop into those with little play, and those whose play may be a stroke."""
    near, far = list[StoppedJoint](), list[StoppedJoint]()
    for each in stopped:
        sizes = dict(each.inference.evidence.sizes)
        is_near = sizes.get("play", 0.0) <= NEAR_PLAY * sizes.get("radius", 0.0)
        (near if is_near else far).append(each)
    return near, far


def _bores_told(pair: CommonAxis) -> str:
    """Name two bores with nothing in them by their radii, which may differ as those of a screw that is not drawn."""
    one, other = f"{pair.one.radius:.4g}", f"{pair.other.radius:.4g}"
    return f"equal bores of radius {other}" if one == other else f"bores of radius {one} and {other}"


def _told(stop: Stop, free: float | None, room: float | None) -> str:
    """Say what stops a slide."""
    if free is None:
        return "no face stops its slide"
    between = "" if room is None else f" of {room:.2g} between faces"
    return {
        Stop.ONE_FACE: f"a face {free:.2g} away and the fastener stop its slide",
        Stop.CENTRED: "the pin and its holes have one middle, where it is taken to stay",
        Stop.NO_STROKE: "the pin is no longer than its hole, or little: taken to turn",
        Stop.BALL_STUD: "the ball on its axis turns in a socket already: it is screwed or pressed in",
        Stop.FLANGES: "both have screws in a circle round their axis, as a motor has: taken to turn",
        Stop.SHORT: f"its hole is shorter than wide and would jam on a slide{between}: taken to turn",
    }.get(stop, f"faces stop its slide, with a play of {free:.2g}")


def _line(known: Known, pair: CommonAxis, owners: BodyPair) -> Bore:
    """Find the bore whose axis the joint turns about, where those of the two bodies are not quite one.

    It is an axis that parts of both bodies have alike, whatever is off it, such as a bolt. Else it is that of the pin:
    several links on one pin then turn about one axis, by however much their holes are off. Else it is that of the bore
    that is inside of the other one, as the eye is in a fork.
    """
    if pair.offset <= SAME_LENGTH * pair.other.radius:
        return pair.one
    body, near = known.body, (pair.offset + NEAR_LENGTH * pair.other.radius) / pair.one.radius
    around = [bore for part in known.names if body[part] in owners for bore in known.bores[part]]
    around = [bore for bore in around if bore.on_axis_of(pair.one, MAX_TILT, near)]
    around = [bore for bore in around if shared_length(bore, pair.other) > -pair.other.radius]
    for bore in around:
        alike = [each for each in around if each.on_axis_of(bore, SAME_ANGLE, SAME_LENGTH)]
        if {body[each.part] for each in alike} == owners:
            return bore
    if not pair.virtual:
        return pair.one
    reach = {
        owner: [end for bore in around if body[bore.part] == owner for end in bore.reach(pair.one.axis)]
        for owner in owners
    }
    return min((pair.one, pair.other), key=lambda bore: np.ptp(reach[body[bore.part]] or [0.0]))
