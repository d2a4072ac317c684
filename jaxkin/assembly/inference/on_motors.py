"""What is on the shaft of a motor that is one solid with it: it turns."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.bores import NEAR_LENGTH, Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import MAX_LOOSE, SAME_FIT
from jaxkin.assembly.inference.slide_stops import Stop
from jaxkin.assembly.inference.solid_motors import SolidMotor
from jaxkin.assembly.inference.steppers import SAME_SHAFT
from jaxkin.assembly.inference.stop_faces import ACROSS, stands_across
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Certainty, Doubt, Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind

_NAMED = Doubt(JointKind.FIXED, "only the name of one of its parts tells that it is a motor", Certainty.NAMED_MOTOR)


def on_shafts(known: Known) -> list[tuple[SolidMotor, CommonAxis]]:
    """Find the hubs on the shafts of motors; what lies on the flange of a motor is no hub, nor is what has play on the
    pin of a part that only its name makes a motor, such as a wall that it goes through."""
    result = []
    for each in known.measured.motors:
        for pair in known.axes:
            on = pair.one.part == each.part and pair.one.on_axis_of(each.shaft) and not pair.virtual
            if on and abs(pair.one.radius / each.shaft.radius - 1) <= SAME_SHAFT:
                hub = pair.other.part
                tight = pair.clearance <= (SAME_FIT if each.named else MAX_LOOSE) * pair.other.radius
                if tight and not _lies_on_flange(known, each, hub):
                    result.append((each, pair))
    return result


def _lies_on_flange(known: Known, motor: SolidMotor, part: str) -> bool:
    """Tell whether a part lies on a face of a motor across its shaft, other than the end of that."""
    axis = motor.shaft.axis
    ends, middle = motor.shaft.reach(axis), float(known.solids[motor.part].box.mean(axis=0) @ axis)
    tip = max(ends, key=lambda end: abs(end - middle))
    planes = [
        each.surfaces[each.parts.index(motor.part)] for each in known.between.get(frozenset((motor.part, part)), ())
    ]
    across = [plane for plane in planes if isinstance(plane, Plane) and stands_across(plane, axis)]
    return any(abs(float(plane.point @ axis) - tip) > NEAR_LENGTH * motor.shaft.radius for plane in across)


def bracket_of(known: Known, motor: str, body: Mapping[str, str]) -> str | None:
    """Find the only body that a motor touches beside what is on its shaft: it is screwed on there. What touches nothing
    of it but the shaft, such as the set screw of a hub, holds no case."""
    on_shaft = {body[part] for pair in known.driven if motor in pair for part in pair}
    shafts = [each.shaft for each in known.measured.motors if each.part == motor]
    case = [
        pair
        for pair in known.touching
        if motor in pair and not all(any(_is_at(each, shaft) for shaft in shafts) for each in known.between[pair])
    ]
    owners = {body[part] for pair in case for part in pair} - on_shaft - {body[motor]}
    return owners.pop() if len(owners) == 1 else None


def _is_at(contact: Contact, shaft: Bore) -> bool:
    """Tell whether a contact is on a shaft or in its end, and not on the face that it comes out of."""
    slack = NEAR_LENGTH * shaft.radius
    low, high = shaft.reach(shaft.axis)
    height = float(contact.centre @ shaft.axis)
    away = float(np.linalg.norm(np.cross(contact.centre - shaft.point, shaft.axis)))
    return low + slack < height < high + slack and away <= shaft.radius + slack


def held_motors(known: Known) -> list[Inference]:
    """Join motors that drive something with the only body that they touch otherwise: no case turns in its seat."""
    result = []
    for motor in dict.fromkeys(each.part for each in known.measured.motors):
        drives = any(motor in pair for pair in known.driven)
        if drives and (bracket := bracket_of(known, motor, known.body)) is not None:
            text = f"the motor {motor!r} touches only {bracket!r} beside what it drives, and is held there"
            evidence = Evidence(EvidenceKind.ENCLOSED, (), text)
            result.append(Inference(known.in_order((motor, bracket)), evidence))
    return result


def _is_on_flat(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a hub has a plane face along the shaft in contact with one of the shaft, so that both turn."""
    planes = [each.surfaces[0] for each in known.between.get(frozenset(pair.parts), ()) if each.contact_state.is_flat]
    return any(isinstance(plane, Plane) and abs(float(plane.normal @ pair.one.axis)) < ACROSS for plane in planes)


def motor_joints(known: Known) -> list[StoppedJoint]:
    """Make a revolute joint of each motor and the hubs on its shaft.

    Where the hub fits exactly, it only stops the slide that contacts allow; on a flat of the shaft contacts allow
    nothing else, and the joint is taken at once.
    """
    body, result, taken = known.body, [], {*known.jointed}
    for motor, pair in sorted(on_shafts(known), key=lambda each: engaged(each[1]), reverse=True):
        owners = frozenset(body[part] for part in pair.parts)
        if len(owners) < 2 or owners in taken:
            continue
        taken.add(owners)
        exact = any(owners == {body[part] for part in each} for each in known.pinned) and not _is_on_flat(known, pair)
        parts = known.in_order(pair.parts)
        joint = pairs.revolute("-".join(parts), *parts, point=pair.other.point, axis=motor.shaft.axis)
        text = f"{pair.other.part!r} is on the shaft of {motor.part!r}, which {motor.told}, and is one solid with it"
        sizes = (("radius", motor.shaft.radius), ("clearance", pair.clearance))
        doubt = _NAMED if motor.named else None
        inference = Inference.of(joint, Evidence(EvidenceKind.ENCLOSED, sizes, text, doubt))
        result.append(StoppedJoint(inference, Stop.BEARING, exact))
    return result
