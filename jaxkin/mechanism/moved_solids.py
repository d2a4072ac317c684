"""Move solids and contacts along with the parts of a mechanism that is assembled anew."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Pose, apply

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_ALIKE = 1e-12
"""Radians, or lengths over the distance from the origin: two parts that were moved by the same but for rounding."""


def with_moved_solids(mechanism: Mechanism, assembled: Mechanism, places: Mapping[str, Pose]) -> Mechanism:
    """The newly `assembled` mechanism with the solids and contacts of `mechanism`, moved by the `places` of parts.

    Contacts whose frames belong to more than the two parts, such as a cylinder that rolls on a plane, are followed only
    where both parts have been moved alike; those of other joints are left out, and a note says so.
    """
    contacts, left_out = {}, []
    for name, some in mechanism.contacts.items():
        if all(_can_follow(contact, places) for contact in some):
            contacts[name] = tuple(_moved_contact(contact, places) for contact in some)
        else:
            left_out.append(repr(name))
    notes = assembled.notes
    if left_out:
        notes = (*notes, f"the contacts of {', '.join(left_out)} are not followed from here on: its parts have moved")
    solids = tuple(_moved_part(part, places[part.name]) for part in mechanism.solids)
    return replace(assembled, solids=solids, contacts=contacts, notes=notes)


def _moved_part(part: Part, place: Pose) -> Part:
    faces = tuple(
        replace(face, surface=face.surface.moved(place), triangles=apply(place, face.triangles)) for face in part.faces
    )
    return replace(part, faces=faces, triangles=apply(place, part.triangles))


def _can_follow(contact: Contact, places: Mapping[str, Pose]) -> bool:
    one, other = (places[part] for part in contact.parts)
    size = np.array([1.0, 1.0, 1.0, 1.0 + np.abs(contact.frames[:, :3, 3]).max()])
    return len(contact.frames) == 1 or bool(np.all(np.abs(one - other) <= _ALIKE * size))


def _moved_contact(contact: Contact, places: Mapping[str, Pose]) -> Contact:
    one, other = (places[part] for part in contact.parts)
    surfaces = contact.surfaces[0].moved(one), contact.surfaces[1].moved(other)
    return replace(contact, frames=one @ contact.frames, surfaces=surfaces, centre=apply(one, contact.centre))
