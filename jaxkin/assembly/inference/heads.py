"""Heads of pins: on both ends, as of rivets and clevis pins, or on what a screw clamps: these hold, and guide
nothing."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.axes import MAX_OFFSET, apart, shared_length
from jaxkin.assembly.inference.bores import Bore, merged, shared
from jaxkin.assembly.inference.contact_faces import shared_span
from jaxkin.assembly.inference.fasteners import MAX_EXPOSED, Stack
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS, WIDER, stands_across
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.surfaces import Cone
from jaxkin.joints.evidence import EvidenceKind

MAX_HEAD_GAP = 1.0
"""Distance of heads from the outermost holes, over the radius of the pin, at most: with a washer that is not drawn."""


def is_head_on_tube(known: Known, contact: Contact) -> bool:
    """Tell whether a contact is that of the flat head of a pin with the outside of the tube that the pin goes
    through."""
    pairs = [pair for pair in known.axes if {*pair.parts} == {*contact.parts} and not pair.virtual]
    return any(stands_across(surface, pair.one.axis) for surface in contact.surfaces for pair in pairs)


def is_beside_its_hole(known: Known, contact: Contact) -> bool:
    """Tell whether a contact is that of a pin with a wall of the part in whose hole the pin is, as where it stands out
    of the floor of a slot that is as wide: the wall goes on where the hole ends, and the pin rolls on nothing."""
    pairs = [pair for pair in known.axes if {*pair.parts} == {*contact.parts} and not pair.virtual]
    faces = dict(zip(contact.parts, contact.faces, strict=True))
    return any(faces[pair.one.part] in pair.one.faces for pair in pairs)


def is_countersunk(known: Known, contact: Contact) -> bool:
    """Tell whether a contact is that of the conical head of a pin with the countersink of the hole that the pin is in:
    about the axis of the pin, and wider than it, other than the point of a needle in its seat."""
    cone = contact.surfaces[0]
    if not isinstance(cone, Cone) or not contact.contact_state.is_fit:
        return False
    ends = np.array(shared_span(contact, known.solids, cone.axis)) - cone.apex @ cone.axis
    widest = np.tan(cone.half_angle) * np.abs(ends).max()
    pins = [pair.one for pair in known.axes if {*pair.parts} == {*contact.parts} and not pair.virtual]
    coaxial = [
        pin
        for pin in pins
        if np.linalg.norm(np.cross(cone.axis, pin.axis)) < ACROSS
        and np.linalg.norm(np.cross(cone.apex - pin.point, pin.axis)) < MAX_OFFSET * pin.radius
    ]
    return any(widest > WIDER * pin.radius for pin in coaxial)


def is_headed(known: Known, stack: Stack) -> bool:
    """Tell whether a stack has something wider than its pin on both sides of all holes that the pin is in, near to
    them."""
    along = stack.axis.axis
    pairs = [pair for pair in known.axes if not pair.virtual and pair.one.part in stack.fasteners]
    pairs = [pair for pair in pairs if pair.other.part in stack.held]
    if not pairs:
        return False
    radius = min(pair.one.radius for pair in pairs)
    ends = [end for pair in pairs for end in pair.other.reach(along)]
    low, high = min(ends), max(ends)
    corners = np.concatenate([known.solids[name].outermost for name in stack.fasteners]) - stack.axis.point
    heights = corners @ along
    wide = np.linalg.norm(corners - np.outer(heights, along), axis=1) > WIDER * radius
    heights = heights[wide] + float(stack.axis.point @ along)
    slack = MAX_HEAD_GAP * radius
    below, above = heights[heights <= low + slack], heights[heights >= high - slack]
    return bool(len(below) and len(above) and below.max() >= low - slack and above.min() <= high + slack)


def is_exposed(known: Known, stack: Stack) -> bool:
    """Tell whether most of the pins of a stack is in nothing, so that something may slide on it.

    What is drawn into the material of others is inside, and so is what is in a hole, however wide, of a part that the
    head lies on: screws are drawn as thin as the root of their thread.
    """
    along, own = stack.axis.axis, {*stack.fasteners}
    pairs = [pair for pair in known.axes if not pair.virtual and pair.one.part in own]
    if not pairs:
        return stack.guides
    pins = [bore for part in stack.fasteners for bore in known.bores_on(part, stack.axis) if not bore.hole]
    wide = [
        hole
        for part in stack.held
        if known.touches_across(part, along, *stack.fasteners)
        for hole in known.bores[part]
        if hole.hole and any(goes_through(pin, hole) for pin in pins)
    ]
    covered = merged(span for hole in (*(pair.other for pair in pairs), *wide) for span in hole.spans_along(along))
    lengths = merged(span for pair in pairs for span in pair.one.spans_along(along))
    inside = max(shared(lengths, covered), 0.0)
    for each in known.found:
        if each.evidence.kind is EvidenceKind.ENCLOSED and own & {*each.parts}:
            inside += dict(each.evidence.sizes).get("depth", 0.0)
    return sum(high - low for low, high in lengths) - inside > MAX_EXPOSED * inside


def goes_through(pin: Bore, hole: Bore) -> bool:
    """Tell whether a pin goes through a hole that may be wider and beside it, as that of an eccentric round the pin."""
    offset, tilt = apart(pin, hole)
    return tilt < ACROSS and offset + pin.radius < hole.radius and shared_length(pin, hole) > hole.half
