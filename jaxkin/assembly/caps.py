"""Parts that turn on the end of a pin by exact contacts, and may be pressed on there: knobs, grips, pans and feet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.inference.contact_faces import faces_of
from jaxkin.assembly.inference.stop_faces import WIDER, stands_across
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Part
from jaxkin.geometry.surfaces import Cylinder
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def told_caps(mechanism: Mechanism) -> list[str]:
    """Tell which parts turn on the end of a pin that fits their blind hole and stands on its floor, where nothing else
    holds them.

    Exact contacts make such a joint a hinge, and it stays one. A hinge mostly goes through, or has play: the part may
    be pressed or glued on, which one line says.
    """
    solids = {part.name: part for part in mechanism.solids}
    owner = body_of_parts(mechanism.bodies)
    result = []
    for joint in mechanism.all_joints:
        found = _cap(joint, mechanism.contacts.get(joint.name, ()), solids)
        if found is not None and _is_last(mechanism, owner, owner[found[1]]):
            pin, cap = found
            text = f"{cap!r} turns on the end of the pin of {pin!r}, by exact contacts, and nothing else holds it"
            result.append(f"{text}: if it is pressed on there, say rigid=[[{pin!r}, {cap!r}]]")
    return result


def _cap(joint: Joint, contacts: Sequence[Contact], solids: Mapping[str, Part]) -> tuple[str, str] | None:
    """Find the pin and the cap on its end of a joint of exact contacts; None where the joint is another one."""
    pins = [each for each in contacts if each.contact_state.is_pin]
    if joint.kind is not JointKind.REVOLUTE or len(pins) != 1 or len(contacts) < 2:
        return None
    sides = [surface.side for surface in pins[0].surfaces if isinstance(surface, Cylinder)]
    if sorted(sides) != [-1, 1]:
        return None
    pin, cap = pins[0].parts if sides[0] > 0 else pins[0].parts[::-1]
    others = [each for each in contacts if each is not pins[0]]
    on_floor = all({*each.parts} == {pin, cap} and _is_on_floor(each, pins[0], solids) for each in others)
    return (pin, cap) if on_floor else None


def _is_on_floor(contact: Contact, pin: Contact, solids: Mapping[str, Part]) -> bool:
    """Tell whether a contact is that of the end of a pin with the floor of its hole."""
    axis = next(surface for surface in pin.surfaces if isinstance(surface, Cylinder))
    if not stands_across(contact.surfaces[0], axis.axis):
        return False
    corners = [face.triangles.reshape(-1, 3) - axis.point for face in faces_of(contact, solids)]
    away = [np.linalg.norm(np.cross(each, axis.axis), axis=1).max() for each in corners]
    return bool(min(away) <= WIDER * axis.radius)


def _is_last(mechanism: Mechanism, owner: Mapping[str, str], body: str) -> bool:
    """Tell whether a body that is not fixed has one joint only."""
    joints = [joint for joint in mechanism.all_joints if body in {owner[part] for part in joint.parts}]
    moving = [joint for joint in joints if len({owner[part] for part in joint.parts}) > 1]
    return len(moving) == 1 and body not in {owner.get(part, part) for part in mechanism.fixed}
