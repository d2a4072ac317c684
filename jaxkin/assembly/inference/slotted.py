"""Screws that end in the slot of a profile, with or without the slot nut that is drawn: they clamp what lies on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.screwed import crossings
from jaxkin.assembly.inference.slots import walls_beside
from jaxkin.assembly.inference.standing import on_floors
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind

PROFILE_SLOT = (1.05, 4.0)
"""Distance of the walls of a slot from the axis of a screw in it, over its radius: profiles of 20 to 45 mm have 1.2 to
2 with the screws they are made for. A pin that the slot guides fills it."""


def clamped_on_slots(known: Known, every: Sequence[Stack]) -> list[Inference]:
    """Find bodies that lie on a profile with a screw that ends in a slot of it, across its edges.

    What lies there is no screw or pin itself: one that ends on the floor of a channel draws nothing onto its edges.
    The slot has a floor below the screw, as profiles have; a slot that a pin slides in is cut through, or filled by the
    pin. A rivet that stands on the floor of its hole in a slider ends there, and not in the slot below.
    """
    body, on = known.body, on_floors(known)
    flat: dict[frozenset[str], list[tuple[Vector, tuple[str, str]]]] = {}
    elsewhere, fastening = set(), {part for stack in every for part in stack.fasteners}
    for contact in known.contacts:
        owners, surface = frozenset(body[part] for part in contact.parts), contact.surfaces[0]
        if contact.contact_state.is_flat and isinstance(surface, Plane):
            flat.setdefault(owners, []).append((surface.normal, contact.parts))
        else:
            elsewhere.add(owners)
    result = []
    for stack in every:
        owner = body[stack.fasteners[0]]
        axis = max((bore for name in stack.fasteners for bore in known.bores[name]), key=lambda bore: bore.half)
        if any(bore.hole for bore in known.bores[axis.part]) or axis.part in on:
            continue  # the outside of a nut or a washer is that of no screw, and what stands in a hole ends there
        for part in known.parts:
            pair = frozenset((owner, body[part.name]))
            lying = [] if len(pair) < 2 or pair in elsewhere else flat.get(pair, [])
            normals = [normal for normal, parts in lying if not {*parts} & fastening]
            if any(np.linalg.norm(np.cross(normal, axis.axis)) < ACROSS for normal in normals) and _in_slot(axis, part):
                screw = stack.fasteners[0]
                text = f"the screw {screw!r} ends in a slot of {part.name!r}, on the edges of which {owner!r} lies"
                evidence = Evidence(EvidenceKind.FASTENER, (("radius", axis.radius),), text)
                parts = known.in_order((owner, part.name))
                result.append(Inference(parts, evidence))
    return result


def _in_slot(screw: Bore, part: Part) -> bool:
    """Tell whether a screw ends between two walls of a part, with a floor of it ahead."""
    if not len(crossings(screw.point, screw.axis, part.triangles)):
        return False
    return bool(walls_beside(screw, part, PROFILE_SLOT))
