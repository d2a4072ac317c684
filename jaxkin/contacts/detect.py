"""Detection of the contacts between the parts of an assembly (Section 3 of the paper).

Broad phase by the boxes of parts, then of faces. Narrow phase: are the infinite surfaces in one of the states, and does
the contact region lie on both trimmed faces?
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from jaxkin.contacts.boxes import crossing, overlapping
from jaxkin.contacts.contact import Contact, Contacts, NearMiss
from jaxkin.contacts.frames import contact_frames
from jaxkin.contacts.reason import reason
from jaxkin.contacts.region import ContactRegion, contact_region
from jaxkin.contacts.states import STATES, ContactState
from jaxkin.contacts.tolerance import NEAR, Tolerance, default_length, reach
from jaxkin.contacts.touch import Touch
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Vector

KINDS = ("plane", "cylinder", "cone", "sphere")


def find_contacts(
    parts: tuple[Part, ...], length: float | None = None, angle: float = 1e-4, fit: float = 0.02
) -> Contacts:
    """All contacts between the parts in their assembled pose.

    `length`: gap that still counts as touching, in the unit of the parts; by default 1e-5 of the diagonal of the
    assembly, so that the unit does not matter. `angle`: radians that still count as parallel. `fit`: clearance,
    relative to the radius, up to which a pin fills its hole (e), a ball its bore (j) or its socket (o); larger ones
    are loose and touch where they touch, if they do. What misses a state by little more than the tolerances, or only
    meets it along the edge of a face, is listed in `near_misses`; nothing is guessed.
    """
    notes = tuple(f"{part.name}: {note}" for part in parts for note in part.notes)
    if sum(bool(part.faces) for part in parts) < 2:
        return Contacts((), notes=notes)
    tolerance = Tolerance(default_length(parts) if length is None else length, angle, fit)
    margin = NEAR * tolerance.length
    parts = tuple(part for part in parts if part.faces)
    boxes = [np.stack([_box(face) for face in part.faces]) for part in parts]
    outlines = np.stack([np.stack([box[:, 0].min(axis=0), box[:, 1].max(axis=0)]) for box in boxes])
    contacts: list[Contact] = []
    near_misses: list[NearMiss] = []
    for i, j in overlapping(outlines, margin):
        found = []
        for a, b in crossing(boxes[i], boxes[j], margin):
            at = (np.maximum(boxes[i][a, 0], boxes[j][b, 0]) + np.minimum(boxes[i][a, 1], boxes[j][b, 1])) / 2
            found.append(_examine((parts[i], parts[j]), (parts[i].faces[a], parts[j].faces[b]), at, tolerance))
        between = [result for result in found if isinstance(result, Contact)]
        touching = {
            (part, face) for contact in between for part, face in zip(contact.parts, contact.faces, strict=True)
        }
        contacts += between
        near_misses += [
            result
            for result in found
            # a face that is in contact meets the neighbours of the other face along its edges: nothing to report
            if isinstance(result, NearMiss)
            and not (result.rim and touching & set(zip(result.parts, result.faces, strict=True)))
        ]
    return Contacts(tuple(contacts), tuple(near_misses), notes)


def _examine(
    parts: tuple[Part, Part], faces: tuple[Face, Face], at: Vector, tol: Tolerance
) -> Contact | NearMiss | None:
    """The first state that the pair of faces is in, else what it nearly is by the least misfit."""
    if KINDS.index(faces[0].surface.kind) > KINDS.index(faces[1].surface.kind):
        parts, faces = (parts[1], parts[0]), (faces[1], faces[0])
    s1, s2 = faces[0].surface, faces[1].surface
    near, least = None, np.inf
    for state in _ROWS[s1.kind, s2.kind]:
        if (getattr(s1, "side", 1), getattr(s2, "side", 1)) not in state.sides:
            continue
        touch = state.touch(s1, s2, at)
        if touch is None or not tol.near(touch, s1, s2):
            continue
        region = contact_region(state.region, touch, *faces, tol.length)
        if region is not None:
            touch = state.touch(s1, s2, region.centre) or touch
            fits = tol.fits(touch, region.extent, s1, s2)
            if fits and region.inside:
                return _contact(state, parts, faces, touch, region)
            if fits or region.inside:
                excess = tol.excess(touch, region.extent, s1, s2)
                if excess < least / 2:  # only what is much nearer supersedes a fit, which comes first
                    near, least = _near_miss(state, parts, faces, touch, region, tol), excess
        if tol.fits(touch, 0.0, s1, s2):
            break  # what fills its hole is not also a loose pin that leans against it
    return near


def _contact(
    state: ContactState, parts: tuple[Part, Part], faces: tuple[Face, Face], touch: Touch, region: ContactRegion
) -> Contact:
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
    state: ContactState,
    parts: tuple[Part, Part],
    faces: tuple[Face, Face],
    touch: Touch,
    region: ContactRegion,
    tol: Tolerance,
) -> NearMiss:
    return NearMiss(
        parts=(parts[0].name, parts[1].name),
        faces=(faces[0].name, faces[1].name),
        state=state.letter,
        region=state.region,
        gap=touch.gap,
        tilt=touch.tilt,
        rim=not region.inside,
        reason=reason(touch, region, tol, faces[0].surface, faces[1].surface),
    )


def _box(face: Face) -> np.ndarray:
    """The box of a face with the bulge of its surface over the triangles."""
    corners = face.triangles
    middles = np.concatenate([(corners + np.roll(corners, 1, axis=1)) / 2, corners.mean(axis=1, keepdims=True)], axis=1)
    bulge = np.abs(face.surface.distance(middles.reshape(-1, 3))).max()
    return face.box + np.array([[-bulge], [bulge]])


def _by_kinds() -> dict[tuple[str, str], list[ContactState]]:
    rows = defaultdict(list)
    for state in STATES:
        rows[state.kinds].append(state)
    return rows


_ROWS = _by_kinds()
