"""Move solids and contacts along with the parts of a mechanism that is assembled anew."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Part, moved
from jaxkin.geometry.pose import Transform, apply

_ALIKE = 1e-12
"""Radians, or lengths over the distance from the origin: two parts that were moved by the same but for rounding."""


class MovedSolids(NamedTuple):
    """Solids and contacts where a new assembled pose has them."""

    solids: tuple[Part, ...]
    contacts: dict[str, tuple[Contact, ...]]
    """The contacts that could follow, by the name of their joint."""
    left_out: tuple[str, ...]
    """The joints whose contacts could not."""


def moved_solids(
    solids: Sequence[Part], contacts: Mapping[str, tuple[Contact, ...]], places: Mapping[str, Transform]
) -> MovedSolids:
    """Move solids, and contacts by the name of their joint, by the displacements of parts.

    Contacts whose frames belong to more than the two parts, such as a cylinder that rolls on a plane, are followed only
    where both parts have been moved alike; those of other joints are left out.
    """
    found = {
        name: tuple(_moved_contact(contact, places) for contact in some)
        for name, some in contacts.items()
        if all(_can_follow(contact, places) for contact in some)
    }
    displaced = tuple(moved(part, places[part.name]) for part in solids)
    return MovedSolids(displaced, found, tuple(name for name in contacts if name not in found))


def _can_follow(contact: Contact, places: Mapping[str, Transform]) -> bool:
    one, other = (places[part] for part in contact.parts)
    size = np.array([1.0, 1.0, 1.0, 1.0 + np.abs(contact.frames[:, :3, 3]).max()])
    return len(contact.frames) == 1 or bool(np.all(np.abs(one - other) <= _ALIKE * size))


def _moved_contact(contact: Contact, places: Mapping[str, Transform]) -> Contact:
    one, other = (places[part] for part in contact.parts)
    surfaces = contact.surfaces[0].moved(one), contact.surfaces[1].moved(other)
    return replace(contact, frames=one @ contact.frames, surfaces=surfaces, centre=apply(one, contact.centre))
