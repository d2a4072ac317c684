"""Bearing blocks: they have the form of a nut, but lie on what carries them with a face along their shaft."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.surfaces import Plane


def bearing_blocks(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the parts of the form of a nut that have play on all pins through them, and lie on one plane of other parts
    that is along these: a nut has no play on its thread, and lies on what it clamps, across its bolt."""
    on: dict[str, list[CommonAxis]] = {}
    for pair in known.axes:
        if not pair.virtual and pair.other.part in fastening:
            on.setdefault(pair.other.part, []).append(pair)
    return {name for name, axes in on.items() if all(map(_is_loose, axes)) and _lies_along(known, name, axes)}


def _is_loose(pair: CommonAxis) -> bool:
    return pair.clearance > SAME_FIT * pair.other.radius


def _lies_along(known: Known, name: str, axes: Collection[CommonAxis]) -> bool:
    """Tell whether a part lies on others than its pins with faces along these, all of which look one way."""
    pins = {pair.one.part for pair in axes}
    axis = next(pair.one.axis for pair in axes)
    flat = [
        surface
        for pair, contacts in known.between.items()
        if name in pair and not pair & pins
        for contact in contacts
        if contact.contact_state.is_flat
        for part, surface in zip(contact.parts, contact.surfaces, strict=True)
        if part == name
    ]
    normals = np.array([plane.normal for plane in flat if isinstance(plane, Plane)]).reshape(-1, 3)
    along = normals[abs(normals @ axis) < ACROSS]
    return len(along) > 0 and bool((along @ along[0] > np.cos(ACROSS)).all())
