"""Find the contacts between the parts of an assembly (Section 3 of the paper).

The broad phase finds parts, then faces, whose bounding boxes overlap. The narrow phase decides for two faces whether
their unbounded surfaces are in one of the sixteen states, and whether the contact region lies on both faces.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from jaxkin.contacts.boxes import Boxes, crossing, face_box, overlapping
from jaxkin.contacts.contact import Contact, Contacts, NearMiss
from jaxkin.contacts.edges import edge_note
from jaxkin.contacts.frames import contact_frames
from jaxkin.contacts.reason import reason
from jaxkin.contacts.region import ContactRegion, contact_region
from jaxkin.contacts.slots import pins_in_slots
from jaxkin.contacts.states import CONTACT_STATES, ContactState
from jaxkin.contacts.tolerance import (
    NEAR,
    NEAR_SLOT,
    USUAL_LENGTH,
    ContactTolerance,
    default_length,
    outline_length,
    reach,
    smaller_radius,
)
from jaxkin.contacts.touch import Touch
from jaxkin.geometry.part import Face, Part, size
from jaxkin.geometry.pose import Vector

KINDS = ("plane", "cylinder", "cone", "sphere")
"""Kinds of surface in the order of the paper: surface 1 of a state is of the earlier kind."""


def find_contacts(
    parts: tuple[Part, ...],
    length: float | None = None,
    angle: float = ContactTolerance.angle,
    fit: float = ContactTolerance.fit,
    progress: Callable[[int, int], None] | None = None,
) -> Contacts:
    """Find all contacts between the parts in their assembled pose.

    `length` is the gap up to which surfaces count as touching, in the unit of the parts; by default 1e-5 of the
    diagonal of the assembly, so that the unit does not matter, or more where the numbers of the files are rounded so
    much (see `default_length`), which the notes then tell; a larger one loses no contact. `angle`, radians, is that up
    to which directions count as parallel, by default 1e-4. `fit` is the clearance, relative to the radius (0.02 by
    default), up to which a pin fills its hole (e), or a ball its bore (j) or its socket (o); with a larger clearance
    the surfaces are in contact only where they touch along a line or at a point. Two faces that miss a state by little
    more than the tolerances, or meet only along the edge of one of them, are listed in `near_misses`, and so are pins
    with play between the walls of a slot; nothing is guessed. `progress(done, total)` is called after each pair of
    parts whose boxes meet.
    """
    notes = [f"{part.name}: {note}" for part in parts for note in part.notes]
    if sum(bool(part.faces) for part in parts) < 2:
        return Contacts((), notes=tuple(notes))
    default, outlines = default_length(parts), outline_length(parts)
    if length is None and default > USUAL_LENGTH * size(parts):
        notes.append(_rounded(parts, default))
    tolerance = ContactTolerance(default if length is None else length, outlines, angle, fit)
    margin = max(NEAR * tolerance.length, outlines)
    parts = tuple(part for part in parts if part.faces)
    boxes = [np.stack([face_box(face) for face in part.faces]) for part in parts]
    around = np.stack([np.stack([box[:, 0].min(axis=0), box[:, 1].max(axis=0)]) for box in boxes])
    contacts: list[Contact] = []
    near_misses: list[NearMiss] = []
    pairs = overlapping(around, margin)
    for done, (i, j) in enumerate(pairs, start=1):
        tol = tolerance.between(parts[i], parts[j])
        found = []
        near = crossing(boxes[i], boxes[j], margin)
        for a, b in near:
            at = _between(boxes[i][a], boxes[j][b])
            found.append(_examine((parts[i], parts[j]), (parts[i].faces[a], parts[j].faces[b]), at, tol))
        here = [result for result in found if isinstance(result, Contact)]
        contacts += here
        missed = [result for result in found if isinstance(result, NearMiss)]
        for a, b in ((i, j), (j, i)):
            missed += _in_slots((parts[a], parts[b]), (boxes[a], boxes[b]), tol, found)
        near_misses += _worth_telling(missed, here)
        if len(near) and not any(found):
            one, two = _with_faces(parts[i], near[:, 0]), _with_faces(parts[j], near[:, 1])
            if note := edge_note(one, two, max(tolerance.length, outlines)):
                notes.append(note)
        if progress:
            progress(done, len(pairs))
    return Contacts(tuple(contacts), tuple(near_misses), tuple(notes))


def is_about(note: str, part: Part) -> bool:
    """Tell whether a note of `find_contacts` is about a part: about its faces, or where they meet another part."""
    faces = [f"{part.name} {label}" for face in part.faces for label in face.name.split(", ")]
    return note.startswith((f"{part.name}: ", *faces)) or any(f" and {face}" in note for face in faces)


def _rounded(parts: tuple[Part, ...], length: float) -> str:
    """Tell that gaps are not seen up to a length, since the numbers of a file are rounded."""
    worst = max(parts, key=lambda part: part.resolution)
    return (
        f"gaps of up to {length:.2g} count as none: the place of {worst.name!r} is rounded by {worst.resolution:.2g}, "
        "so far from the origin: export nearer to it, or ask for a smaller length"
    )


def _between(box1: Float[np.ndarray, "2 3"], box2: Float[np.ndarray, "2 3"]) -> Vector:
    """Find the middle of what two boxes share, or of what is between them."""
    return (np.maximum(box1[0], box2[0]) + np.minimum(box1[1], box2[1])) / 2


def _with_faces(part: Part, indices: Int[np.ndarray, " faces"]) -> Part:
    """Take a part with some of its faces only, in their order."""
    return replace(part, faces=tuple(part.faces[index] for index in np.unique(indices)))


def _worth_telling(near_misses: list[NearMiss], contacts: list[Contact]) -> list[NearMiss]:
    """Drop the near misses along an edge of a face that is itself in contact.

    Such a face also meets the neighbours of the face that it touches, along their common edges: no news.
    """
    touching = {side for contact in contacts for side in zip(contact.parts, contact.faces, strict=True)}
    return [miss for miss in near_misses if not (miss.rim and touching & set(zip(miss.parts, miss.faces, strict=True)))]


def _in_slots(
    parts: tuple[Part, Part],
    boxes: tuple[Boxes, Boxes],
    tol: ContactTolerance,
    found: Sequence[Contact | NearMiss | None],
) -> list[NearMiss]:
    """Find the near misses, beside those that were `found`, of pins of the first part in slots of the second one."""
    known = [{*zip(result.parts, result.faces, strict=True)} for result in found if result]
    misses: dict[tuple[str, str], NearMiss] = {}
    for pin, *walls in pins_in_slots(*parts, *boxes):
        sides = []
        for wall in walls:
            faces, at = (parts[0].faces[pin], parts[1].faces[wall]), _between(boxes[0][pin], boxes[1][wall])
            play = NEAR_SLOT * smaller_radius(faces[0].surface, faces[1].surface)
            sides.append(_examine(parts, faces, at, replace(tol, near_length=max(tol.near_length, play))))
        if all(isinstance(side, NearMiss) and not side.rim for side in sides):
            misses |= {side.faces: side for side in sides if isinstance(side, NearMiss)}
    return [miss for miss in misses.values() if {*zip(miss.parts, miss.faces, strict=True)} not in known]


class _Nearly(NamedTuple):
    """A state that two faces are nearly in, with the place of the touch and the region."""

    state: ContactState
    touch: Touch
    region: ContactRegion


FoundTouch = tuple[ContactState, Touch, ContactRegion]
"""A state that two faces are in, with the place of the touch and the region."""


def _examine(
    parts: tuple[Part, Part], faces: tuple[Face, Face], at: Vector, tol: ContactTolerance
) -> Contact | NearMiss | None:
    """Find the contact of two faces, else the state that they miss by the least length, else None.

    `at` is a point near the contact, (3,).
    """
    if KINDS.index(faces[0].surface.kind) > KINDS.index(faces[1].surface.kind):
        parts, faces = (parts[1], parts[0]), (faces[1], faces[0])
    found = _state(faces, at, tol)
    if isinstance(found, _Nearly):
        return _near_miss(found, parts, faces, at, tol)
    return None if found is None else _contact(parts, faces, *found)


def _state(faces: tuple[Face, Face], at: Vector, tol: ContactTolerance) -> FoundTouch | _Nearly | None:
    """Find the first state that two faces are in, else the one that they are nearest to, else None.

    The kinds of the faces are in the order of `KINDS`; `at` is a point near the contact, (3,).
    """
    s1, s2 = faces[0].surface, faces[1].surface
    nearest, least = None, np.inf
    for state in _ROWS[s1.kind, s2.kind]:
        if (getattr(s1, "side", 1), getattr(s2, "side", 1)) not in state.sides:
            continue
        touch = state.touch(s1, s2, at)
        if touch is None or not tol.near(touch, s1, s2):
            continue
        region = _region(state, touch, faces, tol)
        if region is not None:
            touch = state.touch(s1, s2, region.centre) or touch
            fits = tol.fits(touch, region.extent, s1, s2)
            if fits and region.inside:
                return state, touch, region
            if fits or region.inside:
                excess = tol.excess(touch, region.extent, s1, s2)
                if excess < least / 2:  # only what is much nearer supersedes a fit, which comes first
                    nearest, least = _Nearly(state, touch, region), excess
        if tol.fits(touch, 0.0, s1, s2):
            break  # what fills its hole is not also a loose pin that leans against it
    return nearest


def _region(state: ContactState, touch: Touch, faces: tuple[Face, Face], tol: ContactTolerance) -> ContactRegion | None:
    """Find the region that two faces share where their surfaces touch; None if they share none.

    It must be wide and long beside a length: that of the tolerance, or else one that the touch itself fits within.
    """
    length = max(tol.length, tol.least_length)
    region = contact_region(state.region, touch, *faces, length)
    if region is not None and region.inside:
        return region
    needed = max(tol.least_length, reach(touch, 0.0 if region is None else region.extent))
    closer = contact_region(state.region, touch, *faces, needed) if needed < length else None
    return closer if closer is not None and closer.inside else region


def _contact(
    parts: tuple[Part, Part], faces: tuple[Face, Face], state: ContactState, touch: Touch, region: ContactRegion
) -> Contact:
    """Make the contact of two faces, surface 1 of the state first, with its frames."""
    surfaces = (faces[0].surface, faces[1].surface)
    return Contact(
        parts=(parts[0].name, parts[1].name),
        faces=(faces[0].name, faces[1].name),
        state=state.letter,
        region=state.region,
        frames=contact_frames(state, *surfaces, touch, region.centre),
        surfaces=surfaces,
        centre=region.centre,
        misfit=max(reach(touch, region.extent), abs(touch.clearance or 0.0)),
    )


def _near_miss(
    nearly: _Nearly, parts: tuple[Part, Part], faces: tuple[Face, Face], at: Vector, tol: ContactTolerance
) -> NearMiss:
    """Make the report on two faces that are nearly in a state, with the tolerances that would make it a contact."""

    def works(other: ContactTolerance) -> bool:
        """Check whether the faces would be in this state with other tolerances."""
        found = _state(faces, at, other)
        return found is not None and not isinstance(found, _Nearly) and found[0] is nearly.state

    state, touch, region = nearly
    names = (parts[0].name, parts[1].name)
    return NearMiss(
        parts=names,
        faces=(faces[0].name, faces[1].name),
        state=state.letter,
        region=state.region,
        gap=touch.gap,
        tilt=touch.tilt,
        rim=not region.inside,
        reason=reason(names, touch, region, tol, (faces[0].surface, faces[1].surface), works),
    )


def _by_kinds() -> dict[tuple[str, str], list[ContactState]]:
    """Group the states by the kinds of their surfaces, in the order of `CONTACT_STATES`."""
    rows = defaultdict(list)
    for state in CONTACT_STATES:
        rows[state.kinds].append(state)
    return rows


_ROWS = _by_kinds()
"""The states for each two kinds of surface, in the order in which they are tried."""
