"""Pins that stand in a part or on it, without a hole that they go through: posts, dowels, rods set into material."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.embedded import MIN_DEPTH
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT, is_round_about
from jaxkin.assembly.inference.stop_faces import WIDER, stands_across
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind


def embedded_pins(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Find pins that stand in the material of parts that have no hole for them.

    A screw that is in the hole of its thread is held there: what its head is drawn into is a clash, and holds nothing.
    """
    related = known.touching | {frozenset(pair.parts) for pair in known.axes}
    screwed = {pair.one.part: WIDER * pair.one.radius for pair in known.axes if pair.threaded}
    result = []
    for part in (known.solids[name] for name in known.names if name in fastening):
        thinnest = min((bore.radius for bore in known.bores[part.name] if not bore.hole), default=np.inf)
        near = [each for each in known.measured.beside(part) if frozenset((each.name, part.name)) not in related]
        widest = screwed.get(part.name, np.inf)
        found = [(known.measured.depth_inside(part, each, widest), each.name) for each in near]
        found = [(depth, name) for depth, name in found if depth >= MIN_DEPTH * thinnest]
        for depth, host in sorted(found, reverse=True)[:1]:
            text = f"{part.name!r} stands in the material of {host!r}, {depth:.3g} deep"
            evidence = Evidence(EvidenceKind.ENCLOSED, (("depth", depth),), text)
            result.append(Inference(known.in_order((host, part.name)), evidence))
    return result


def butting_pins(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Find pins whose ends stand on faces of a part without a hole for them: on two opposite ones, or on a coaxial end.

    A pin that fits the hole of a third part, as a stop screw does its cap, is held there, and stops what it touches.
    """
    fitting = [pair for pair in known.axes if not pair.virtual and abs(pair.clearance) <= SAME_FIT * pair.other.radius]
    axis_of = {bore.part: bore for pair in known.axes for bore in (pair.one, pair.other) if bore.part in fastening}
    directions: dict[tuple[str, str], set[bool]] = {}
    for contact in known.contacts:
        for pin, other in (contact.parts, contact.parts[::-1]):
            surface = contact.surfaces[contact.parts.index(pin)]
            if not contact.contact_state.is_flat or pin not in axis_of or frozenset(contact.parts) in known.pinned:
                continue
            if isinstance(surface, Plane) and stands_across(surface, axis_of[pin].axis):
                directions.setdefault((pin, other), set()).add(bool(surface.normal @ axis_of[pin].axis > 0))
    result = []
    for (pin, other), ways in directions.items():
        # where there is a hole on the axis, the pin or what it is on goes through
        sides = {bore.hole for bore in known.bores_on(other, axis_of[pin])}
        elsewhere = any(pair.one.part == pin and pair.other.part != other for pair in fitting)
        coaxial, between = sides == {False} and not elsewhere, len(ways) == 2 and True not in sides
        if between or coaxial:
            where = "between two faces" if between else "on the coaxial end"
            evidence = Evidence(EvidenceKind.ENCLOSED, (), f"{pin!r} stands {where} of {other!r}")
            result.append(Inference(known.in_order((pin, other)), evidence))
    return result


def on_floors(known: Known) -> dict[str, list[str]]:
    """Map each part to the parts of which it has a bore in contact, and a plane face beside that: its floor."""
    on: dict[str, dict[str, None]] = {}
    for contact in known.contacts:
        if contact.contact_state.is_flat and frozenset(contact.parts) in known.pinned:
            for part, other in (contact.parts, contact.parts[::-1]):
                on.setdefault(part, {})[other] = None
    return {part: [*others] for part, others in on.items()}


def standing_rods(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Find plain rods that fit a hole exactly and stand on its floor: posts and dowels, which are set into it, and rods
    with caps that touch nothing else on both ends.

    A rod with a round hub that does not turn on it is the shaft of a motor.
    """
    on = on_floors(known)
    neighbours: dict[str, set[str]] = {}
    for pair in known.touching:
        for part in pair:
            neighbours.setdefault(part, set()).update(pair - {part})
    body, result = known.body, []
    for rod in (name for name in known.names if name in fastening):
        if len(known.bores[rod]) != 1 or known.bores[rod][0].hole or len(known.solids[rod].faces) != 3:
            continue  # it has faces beside those of a pin with two ends
        if any(
            body[hub] == body[rod] and is_round_about(known, hub, known.bores[rod][0])
            for hub in known.names
            if hub != rod
        ):
            continue  # it drives a round hub that does not turn on it, as the shaft of a motor does
        caps = [host for host in on.get(rod, ()) if neighbours[host] == {rod}]
        for host in on[rod] if len(on.get(rod, ())) == 1 else caps:
            evidence = Evidence(EvidenceKind.ENCLOSED, (), f"{rod!r} stands on the floor of its hole in {host!r}")
            result.append(Inference(known.in_order((rod, host)), evidence))
    return result
