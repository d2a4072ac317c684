"""Pins that heads, nuts or rings keep on both ends, as rivets and clevis pins: they hold links, and guide nothing."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.trapped import ACROSS, WIDER
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.surfaces import Plane

NEAR = 1.0
"""Distance of heads from the outermost holes, over the radius of the pin, at most: with a washer that is not drawn."""


def is_head_on_tube(known: Known, contact: Contact) -> bool:
    """Tell whether a contact is that of the flat head of a pin with the outside of the tube that the pin goes
    through."""
    pairs = [pair for pair in known.axes if {*pair.parts} == {*contact.parts} and not pair.virtual]
    planes = [surface for surface in contact.surfaces if isinstance(surface, Plane)]
    return any(np.linalg.norm(np.cross(plane.normal, pair.one.axis)) < ACROSS for plane in planes for pair in pairs)


def lies_across(known: Known, part: str, stack: Stack) -> bool:
    """Tell whether a part lies flat on a fastener of a stack, across the axis, as a plate on the head of a bolt."""
    for contact in known.contacts:
        if part in contact.parts and {*contact.parts} & {*stack.fasteners}:
            plane = contact.surfaces[0]
            if isinstance(plane, Plane) and np.linalg.norm(np.cross(plane.normal, stack.axis.axis)) < ACROSS:
                return True
    return False


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
    slack = NEAR * radius
    below, above = heights[heights <= low + slack], heights[heights >= high - slack]
    return bool(len(below) and len(above) and below.max() >= low - slack and above.min() <= high + slack)
