"""Joints of pins with play in straight slots."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.axes import MIN_ENGAGED
from jaxkin.assembly.inference.bores import shared
from jaxkin.assembly.inference.coaxial_features import coaxial_features
from jaxkin.assembly.inference.inference import Inference, offset_told
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.one_screw import THROUGH
from jaxkin.assembly.inference.slotted_pins import SlottedPin, round_ends
from jaxkin.assembly.inference.stop_faces import ACROSS, MAX_AXIAL_PLAY, WIDER, play, stands_across
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.contacts.tolerance import NEAR_SLOT
from jaxkin.geometry.pose import frame
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.components import connected


def slot_joints(known: Known, joined: Sequence[StoppedJoint] = ()) -> list[Inference]:
    """Infer joints of two bodies of which one has a pin with play in a slot of the other.

    Exact contacts of the two are faces across the pin, if there are any: all others say themselves what is left. With
    such faces, or with faces that leave little play along the pin, it slides in the slot and turns; two pins beside
    each other do not turn. Without them, it slides along its axis, too, and tilts along the slot, as exact contacts
    with the walls have it. A pin that does not touch what has the slot has no more play than what nearly touches.
    Bodies with a common axis are left to that, but for pins at the end of their slot. Where hinges along the pin keep
    both bodies level, `joined` or known, it does not slide along its axis either, and in a slot with round ends may
    have the play of round holes. A screw that clamps what has the slot, for adjusting, guides nothing, nor does the
    roller of a carriage that slides along the slot.
    """
    body, every = known.body, known.measured.slotted_pins(known.clearance)
    axes = [pair for pair in (*known.axes, *known.tapped) if id(pair) not in known.slot_ends]
    others = {*known.jointed, *(frozenset(body[part] for part in each.parts) for each in axes)}
    found: dict[BodyPair, list[SlottedPin]] = {}
    for each in every:
        owners = frozenset(body[part] for part in (each.pin.part, each.part))
        if len(owners) < 2 or owners in others or _is_carried(known, each):
            continue
        if not _is_sleeved(known, each, every):
            found.setdefault(owners, []).append(each)
    lying: set[BodyPair] = set()
    for contact in known.contacts if found else ():
        owners = frozenset(body[part] for part in contact.parts)
        if owners in found:
            flat = stands_across(contact.surfaces[0], found[owners][0].pin.axis)
            (lying if flat and contact.contact_state.is_flat else others).add(owners)
    result = []
    for owners, pins in found.items():
        pins.sort(key=lambda each: each.clearance)
        if owners in others or not _are_parallel(pins) or _may_clamp(known, pins[0]):
            continue
        if (made := _made(known, pins, owners in lying, joined)) is not None:
            result.append(made)
    return result


def _is_carried(known: Known, slotted: SlottedPin) -> bool:
    """Tell whether a body slides along a slot by what is inferred, and the pin turns in or on it."""
    body, pin = known.body, slotted.pin
    slides = [each.joint for each in known.found if each.joint and each.joint.kind is JointKind.PRISMATIC]
    ways = [(joint, np.cross(joint.frames_1[0][:3, 2], slotted.along)) for joint in slides]
    along = [{body[part] for part in joint.parts} for joint, tilt in ways if np.linalg.norm(tilt) < ACROSS]
    carriers = {owner for pair in along if body[slotted.part] in pair for owner in pair} - {body[slotted.part]}
    on = {part for each in known.axes if pin.part in each.parts and each.one.on_axis_of(pin) for part in each.parts}
    return any(body[part] in carriers for part in on)


def _are_parallel(pins: Sequence[SlottedPin]) -> bool:
    """Tell whether the pins are parallel to each other, and so are their slots."""
    axis, along = pins[0].pin.axis, pins[0].along
    tilts = [np.cross(*two) for each in pins for two in ((each.pin.axis, axis), (each.along, along))]
    return bool(np.linalg.norm(tilts, axis=1).max() < ACROSS)


def _is_sleeved(known: Known, slotted: SlottedPin, every: Sequence[SlottedPin]) -> bool:
    """Tell whether something is round a pin between its walls, as a block or a roller is: that is in the slot."""
    pin, least = slotted.pin, MIN_ENGAGED * slotted.pin.radius
    low, high = (float(pin.point @ pin.axis) + end for end in slotted.span)
    around = [each.other for each in known.axes if each.one is pin and each.other.part != slotted.part]
    around += [
        each.pin
        for each in every
        if each.part == slotted.part and each.pin.part != pin.part and each.pin.radius > WIDER * pin.radius
    ]
    around = [each for each in around if each.on_axis_of(pin)]
    return any(shared(each.spans_along(pin.axis), [(low, high)]) > least for each in around)


def _may_clamp(known: Known, slotted: SlottedPin) -> bool:
    """Tell whether a pin is a screw in an adjusting slot: what is on it lies on both sides of the part that has the
    slot, through which it goes with the clearance of a screw, and nothing else ties the two bodies but what only lies
    on them, as what a fork holds down does.

    A rivet has heads on both ends of its own: it holds nothing tight.
    """
    body, pin = known.body, slotted.pin
    if slotted.clearance < THROUGH * slotted.half or _has_two_heads(known, slotted):
        return False
    on = [part for part in known.names if part != slotted.part and known.bores_on(part, pin)]
    touching = (each for part in on for each in known.between.get(frozenset((part, slotted.part)), ()))
    normals = (each.surfaces[each.parts.index(slotted.part)] for each in touching if each.contact_state.is_flat)
    ways = {
        bool(each.normal @ pin.axis > 0)
        for each in normals
        if isinstance(each, Plane) and stands_across(each, pin.axis)
    }
    if len(ways) < 2:
        return False
    owners, stack = {body[pin.part], body[slotted.part]}, {body[part] for part in on}
    lying = {tie for tie in known.touching if known.touches_only_across(min(tie), max(tie), pin.axis)}
    ties = [*known.touching - lying, *known.jointed, *(each.parts for each in (*known.axes, *known.tapped))]
    ties = [{body[part] for part in tie} for tie in ties]
    ties = [(*tie,) for tie in ties if len(tie) == 2 and tie != owners and not tie & (stack - owners)]
    return not any(owners <= group for group in connected({*body.values()}, ties))


def _has_two_heads(known: Known, slotted: SlottedPin) -> bool:
    """Tell whether a pin has a wider length of its own part on both ends."""
    pin = slotted.pin
    wider = [each for each in known.bores_on(pin.part, pin) if not each.hole and each.radius > WIDER * pin.radius]
    low, high = pin.reach(pin.axis)
    ends = [sum(span) / 2 for each in wider for span in each.spans_along(pin.axis)]
    return any(end < low + pin.half for end in ends) and any(end > high - pin.half for end in ends)


def _made(known: Known, pins: Sequence[SlottedPin], lies: bool, joined: Sequence[StoppedJoint]) -> Inference | None:
    """Make the joint of two bodies by the pins that one has in slots of the other, the tightest first; they may lie on
    each other on faces across the pins. None where the pin is too loose for a joint without such faces."""
    first, pin = pins[0], pins[0].pin
    parts = known.in_order((pin.part, first.part))
    name = "-".join(parts)
    text = f"the pin {pin.part!r} of radius {pin.radius:.4g} has a clearance of {first.clearance:.2g}"
    text += f"{offset_told(first.offset, pin.radius)} between two walls of {first.part!r}"
    sizes = [("radius", pin.radius), ("clearance", first.clearance), ("offset", first.offset)]
    level = _are_level(known, first, joined)
    room = None if lies or level else _room(known, first)
    held = lies or level or (room is not None and room <= MAX_AXIAL_PLAY * pin.radius)
    milled = level and bool(round_ends(first, known.bores[first.part]))
    if not (lies or milled) and first.clearance > NEAR_SLOT * pin.radius:
        return None
    if level and not lies:
        text += "; hinges along it keep both level"
    if room is not None and held:
        text += f"; faces leave a play of {room:.2g} along it"
        sizes.append(("play", room))
    beside = any(not each.pin.on_axis_of(pin, length=1.0) for each in pins)
    joint: Joint
    if held and beside:
        text += ", and so has one beside it: they slide in a slot"
        joint = pairs.prismatic(name, *parts, point=first.middle, axis=first.along)
    elif held:
        text += ": it slides in a slot, and turns"
        joint = pairs.pin_in_slot(name, first.part, pin.part, point=first.middle, axis=pin.axis, direction=first.along)
    else:
        text += ": it slides in a slot and along its axis, turns, and tilts"
        wall, centre = frame(first.middle, first.normal), frame(first.middle, pin.axis)
        joint = pairs.contact_joint(name, first.part, pin.part, state="b", frames=[wall, centre])
    return Inference.of(joint, Evidence(EvidenceKind.CLEARANCE, tuple(sizes), text))


def _are_level(known: Known, slotted: SlottedPin, joined: Sequence[StoppedJoint]) -> bool:
    """Tell whether joints whose axes are along a pin, or slides across it, lead from its body to that of its slot, so
    that these do not move along it."""
    body, axis, edges = known.body, slotted.pin.axis, []
    every = (*known.found, *(each.inference for each in joined))
    for joint in (each.joint for each in every if each.joint is not None):
        tilt = float(np.linalg.norm(np.cross(joint.frames_1[0][:3, 2], axis)))
        across = joint.kind is JointKind.PRISMATIC and tilt > 1 - ACROSS
        if (joint.kind is JointKind.REVOLUTE and tilt < ACROSS) or across:
            edges.append(tuple(body[part] for part in joint.parts))
    for coaxial in coaxial_features(known):
        if coaxial.is_kept and np.linalg.norm(np.cross(coaxial.first.one.axis, axis)) < ACROSS:
            edges.append(tuple(coaxial.owners))
    owners = {body[slotted.pin.part], body[slotted.part]}
    return any(owners <= group for group in connected({*body.values()}, edges))


def _room(known: Known, slotted: SlottedPin) -> float | None:
    """Measure how far faces of the two bodies let a pin slide along its axis in all; None without faces."""
    body = known.body
    one, other = (
        [
            stop
            for part in known.parts
            if body[part.name] == body[name] and part.name not in known.springs
            for stop in known.measured.stops(part, slotted.pin)
        ]
        for name in (slotted.pin.part, slotted.part)
    )
    return play(one, other, slotted.pin.radius)
