"""The faces of solids that are in contact, and where they are beside each other."""

from __future__ import annotations

from collections.abc import Mapping

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Vector


def faces_of(contact: Contact, solids: Mapping[str, Part]) -> list[Face]:
    """Find the two faces in contact, in the order of its parts; `solids` are the parts by name."""
    sides = zip(contact.parts, contact.faces, strict=True)
    return [next(face for face in solids[part].faces if face.name == name) for part, name in sides]


def shared_span(contact: Contact, solids: Mapping[str, Part], direction: Vector) -> tuple[float, float]:
    """Find where along a direction two faces in contact are both, from their extents."""
    places = [face.triangles.reshape(-1, 3) @ direction for face in faces_of(contact, solids)]
    return max(float(each.min()) for each in places), min(float(each.max()) for each in places)
