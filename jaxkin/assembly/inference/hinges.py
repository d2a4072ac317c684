"""Joints of two bodies about the axis that they have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known, Pair
from jaxkin.assembly.inference.trapped import ACROSS, MAX_PLAY, play
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind


def hinges(known: Known) -> list[tuple[Inference, bool]]:
    """Infer joints of two bodies about common axes; tell of each whether exact contacts say it but for the slide."""
    body, between = known.body, {}
    given = [*known.by_hand, *(each.parts for each in known.found if each.joint)]
    by_hand = {frozenset(body[part] for part in pair) for pair in given}
    for pair in _neighbours(known.axes, body):
        owners = frozenset(body[part] for part in pair.parts)
        if len(owners) == 2 and owners not in by_hand:
            between.setdefault(owners, []).append(pair)
    exact: dict[Pair, list[Contact]] = {}
    for contact in known.contacts:
        exact.setdefault(frozenset(body[part] for part in contact.parts), []).append(contact)
    result = []
    for owners, found in between.items():
        touching = exact.get(owners, [])
        pins = [contact.contact_state.is_pin for contact in touching]
        pair = min(found, key=lambda pair: (pair.virtual, abs(pair.clearance)))
        if not any(pins) or (all(pins) and all(each.other.on_axis_of(pair.other) for each in found)):
            faces = [contact.surfaces[0] for contact in touching if contact.contact_state.is_flat]
            planes = [face for face in faces if isinstance(face, Plane)]
            across = [np.linalg.norm(np.cross(plane.normal, pair.one.axis)) < ACROSS for plane in planes]
            if not all(across):
                continue  # faces along the axis keep it from turning: exact contacts say what is left
            result += [(joint, any(pins)) for joint in _hinge(known, pair, owners, any(pins), any(across))]
    return result


def _neighbours(axes: Sequence[CommonAxis], body: Mapping[str, str]) -> list[CommonAxis]:
    """Find the common axes of pins, and of bores without a pin those between neighbours along one axis.

    Five levers on one axis have four hinges: the others follow from these, and would lock nothing but say more.
    """
    import networkx as nx

    virtual = sorted((pair for pair in axes if pair.virtual), key=lambda pair: -engaged(pair))
    lines: list[tuple[Bore, nx.Graph]] = []
    kept = {id(pair) for pair in axes if not pair.virtual}
    for pair in virtual:
        graph = next((graph for line, graph in lines if pair.one.on_axis_of(line)), None)
        if graph is None:
            graph = nx.Graph()
            lines.append((pair.one, graph))
        one, other = (body[part] for part in pair.parts)
        if one != other and not (one in graph and other in graph and nx.has_path(graph, one, other)):
            graph.add_edge(one, other)
            kept.add(id(pair))
        elif graph.has_edge(one, other):
            kept.add(id(pair))
    return [pair for pair in axes if id(pair) in kept]


def _hinge(known: Known, pair: CommonAxis, owners: Pair, exact: bool, touching: bool) -> list[Inference]:
    """Make a revolute joint where faces stop the slide, otherwise a cylindrical one unless contacts say that exactly.

    Faces across the axis that touch stop it, as they do beside a pin that fits exactly.
    """
    body, hole = known.body, pair.other
    one, other = (
        [stop for part in known.parts if body[part.name] == owner for stop in known.measured.stops(part, hole)]
        for owner in owners
    )
    free = play(one, other, hole.radius)
    if free is not None and free > MAX_PLAY * hole.radius:
        free = None
    free = 0.0 if touching else free
    if exact and free is None:
        return []
    parts = tuple(sorted(pair.parts, key=known.order.__getitem__))
    make = pairs.cylindrical if free is None else pairs.revolute
    # several links on one pin then turn about one axis, by however much their holes are off
    middle = pair.one.point + ((hole.point - pair.one.point) @ pair.one.axis) * pair.one.axis
    joint = make("-".join(parts), *parts, point=middle, axis=pair.one.axis)
    sizes = [("radius", hole.radius), ("clearance", pair.clearance), ("offset", pair.offset), ("tilt", pair.tilt)]
    ends = "no face stops its slide" if free is None else f"faces stop its slide, with a play of {free:.2g}"
    sizes += [] if free is None else [("play", free)]
    if pair.virtual:
        kind, text = EvidenceKind.VIRTUAL_PIN, f"equal bores of radius {hole.radius:.4g} without a pin"
    else:
        how = "clearance" if pair.clearance >= 0 else "interference"
        fit = "fits" if exact else f"has a {how} of {abs(pair.clearance):.2g} and is {pair.offset:.1g} off"
        kind, text = EvidenceKind.CLEARANCE, f"the pin of radius {pair.one.radius:.4g} {fit}"
    evidence = Evidence(kind, tuple(sizes), f"{text}; {ends}")
    return [Inference(parts, evidence, replace(joint, evidence=evidence))]
