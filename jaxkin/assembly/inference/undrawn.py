"""Screws that are not drawn: empty holes of a part that end on a face of another one, against which it lies flat, also
in the ends of shafts; nuts with nothing in them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore
from jaxkin.assembly.inference.fasteners import Stack, beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.one_screw import THROUGH
from jaxkin.assembly.inference.screwed import crossings
from jaxkin.assembly.inference.sleeves import is_round_about
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.topology.components import connected

AT_FACE = 0.05
"""Distance of the end of a hole from the face that covers it, over its radius."""
HEXAGON = 0.03
"""Difference of the distances of the six sides of a nut from its axis, over these, that is none."""


def empty_nuts(known: Known) -> list[Inference]:
    """Join hexagonal nuts that are on no screw with the part on whose hole they are: the nearest one along their axis.

    What is screwed into them is left out of such drawings, and a nut lies in a recess of what it belongs to, or on it.
    """
    on: dict[str, list[CommonAxis]] = {}
    for pair in known.axes:
        for part in pair.parts:
            on.setdefault(part, []).append(pair)
    body, result = known.body, []
    for name, some in on.items():
        own = known.bores[name]
        hole = max(own, key=lambda bore: bore.half)
        threaded = all(bore.hole and bore.on_axis_of(hole) for bore in own)  # also with the relief of its thread
        if not threaded or name in known.fixed or not all(pair.virtual for pair in some):
            continue
        if not is_hexagonal(known, hole):
            continue
        tied = {part for pair in known.touching if name in pair for part in pair} - {name}
        nearest = max(some, key=lambda pair: (bool({*pair.parts} & tied), engaged(pair)))
        if len({body[part] for part in nearest.parts}) > 1:
            (host,) = {*nearest.parts} - {name}
            text = f"the nut {name!r} is on a hole of {host!r}, and its screw is not drawn"
            evidence = Evidence(EvidenceKind.FASTENER, (("radius", hole.radius),), text)
            result.append(Inference(known.in_order((name, host)), evidence))
    return result


def is_hexagonal(known: Known, hole: Bore) -> bool:
    """Tell whether a part has six plane sides about its hole, as far from the axis, and no others."""
    planes = [face.surface for face in known.solids[hole.part].faces if isinstance(face.surface, Plane)]
    along = [plane for plane in planes if abs(plane.normal @ hole.axis) < ACROSS]
    if len(along) != 6:
        return False
    away = np.array([(plane.point - hole.point) @ plane.normal for plane in along])
    return bool(away.min() > 0 and np.ptp(away) <= HEXAGON * away.max())


def screwed_on_shafts(known: Known) -> list[Inference]:
    """Join wheels and washers with the shaft on whose end they lie, over an empty hole along it for a screw.

    The shaft turns in something, or something on it: a screw that the wheel turned on would do so a second time, about
    the same axis.
    """
    body, result = known.body, []
    for pair in known.tapped:
        wide, narrow = sorted((pair.one, pair.other), key=lambda bore: -bore.radius)
        disc, shaft = wide.part, narrow.part
        if body[disc] == body[shaft] or not known.touches_only_across(disc, shaft, narrow.axis):
            continue
        turning = (
            each
            for each in known.axes
            if each.one.part == shaft and not each.virtual and disc not in each.parts and each.one.on_axis_of(narrow)
        )
        if is_round_about(known, disc, wide) and any(turning):
            text = f"{disc!r} lies on the end of {shaft!r}, with a hole of radius {wide.radius:.4g} over one of "
            text += f"{narrow.radius:.4g}, as for a screw that is not drawn"
            sizes = (("radius", wide.radius), ("clearance", wide.radius - narrow.radius))
            evidence = Evidence(EvidenceKind.FASTENER, sizes, text)
            result.append(Inference(known.in_order((disc, shaft)), evidence))
    return result


def screwed_flat(known: Known) -> list[Inference]:
    """Find bodies that lie flat on each other, one of them with two or more empty holes that end on the other's face.

    Nothing else holds them to each other, so that they would slide and turn on that face.
    """
    body = known.body
    between: dict[BodyPair, list[Contact]] = {}
    for contact in known.contacts:
        between.setdefault(frozenset(body[part] for part in contact.parts), []).append(contact)
    used = {id(bore) for pair in (*known.axes, *known.tapped) for bore in (pair.one, pair.other)}
    result = []
    for owners, contacts in between.items():
        planes = [each.surfaces[0] for each in contacts]
        flat = all(each.contact_state.is_flat for each in contacts) and all(isinstance(p, Plane) for p in planes)
        if len(owners) < 2 or owners in known.jointed or not flat:
            continue
        normals = [plane.normal for plane in planes if isinstance(plane, Plane)]
        if any(np.linalg.norm(np.cross(normal, normals[0])) > ACROSS for normal in normals):
            continue
        for part, other in dict.fromkeys(pair for each in contacts for pair in (each.parts, each.parts[::-1])):
            holes = [bore for bore in known.bores[part] if bore.hole and id(bore) not in used]
            ends = _covered(known, holes, other, normals[0])
            if len(ends) > 1:
                where = f"end on the face of {other!r} that it lies on"
                text = f"{len(ends)} empty holes of {part!r} {where}, as for screws that are not drawn"
                parts = known.in_order((part, other))
                evidence = Evidence(EvidenceKind.BOLT_PATTERN, (("axes", float(len(ends))),), text)
                result.append(Inference(parts, evidence))
    return result


def half_screwed(known: Known, every: Sequence[Stack]) -> list[Inference]:
    """Find bodies that lie flat on each other, one of them under the head of a screw that is tight in the other one,
    with an empty hole as wide and as deep beside that, which ends on the other's face: only one screw is drawn.

    The screw goes through with the clearance of a screw and not of a hinge. What has a pin of a third body in a hole
    along the screw, beside it, may be a lever that turns on the screw.
    """
    body, result = known.body, []
    screws = {part for stack in every for part in stack.fasteners}
    used = {id(bore) for pair in (*known.axes, *known.tapped) for bore in (pair.one, pair.other)}
    for pair in known.axes:
        (screw, part), hole = pair.parts, pair.other
        loose = not pair.virtual and pair.clearance >= THROUGH * hole.radius
        if not loose or screw not in screws or body[screw] == body[part] or _is_pinned(known, pair):
            continue
        if not known.touches_across(part, hole.axis, screw):
            continue
        alike = [bore for bore in known.bores[part] if bore.hole and id(bore) not in used and _are_alike(bore, hole)]
        for other in known.parts_flat_on(part, hole.axis):
            if other == screw or body[other] != body[screw] or not known.touches_only_across(part, other, hole.axis):
                continue
            if ends := [bore for bore in _covered(known, alike, other, hole.axis) if beside(bore, hole)]:
                text = f"{screw!r} is tight in the body of {other!r}, and its head lies on {part!r}, of which "
                text += f"{len(ends)} empty hole{'s' if len(ends) > 1 else ''} beside it as wide end on the face of "
                text += f"{other!r}, as for screws that are not drawn"
                sizes = (("axes", 1.0 + len(ends)), ("radius", hole.radius), ("clearance", pair.clearance))
                parts = known.in_order((part, other))
                result.append(Inference(parts, Evidence(EvidenceKind.BOLT_PATTERN, sizes, text)))
    return result


def _are_alike(one: Bore, other: Bore) -> bool:
    """Tell whether two holes are as wide and as deep."""
    slack = SAME_LENGTH * other.radius
    return abs(one.radius - other.radius) <= slack and abs(one.half - other.half) <= slack


def _is_pinned(known: Known, screwed: CommonAxis) -> bool:
    """Tell whether what a screw goes through has an axis along the screw, beside it, in common with a third body."""
    body = known.body
    owner, host = body[screwed.other.part], body[screwed.one.part]
    for pair in known.axes:
        owners = {body[part] for part in pair.parts}
        if owner in owners and len(owners) == 2 and host not in owners and beside(pair.one, screwed.one):
            return True
    return False


def lone_screws(known: Known) -> list[Inference]:
    """Infer that bodies turn on a screw that is not drawn: they lie flat on each other, and have one axis in common, a
    hole that the screw goes through over one that it is screwed into.

    Two screws would hold them; of one alone nothing keeps them from turning, where they are not tied to each other by
    third ones, as a rail is between two plates.
    """
    body, jointed = known.body, known.jointed
    ties = {frozenset(body[part] for part in pair) for pair in (*known.touching, *known.jointed)}
    ties |= {frozenset(body[part] for part in pair.parts) for pair in (*known.axes, *known.tapped)}
    common: dict[BodyPair, list[CommonAxis]] = {}
    for pair in (*known.axes, *known.tapped):
        common.setdefault(frozenset(body[part] for part in pair.parts), []).append(pair)
    result = []
    for owners, found in common.items():
        one, other = found[0].one, found[0].other
        touching = [each for each in known.contacts if {body[part] for part in each.parts} == owners]
        lie = [known.touches_only_across(*each.parts, one.axis) for each in touching]
        if len(found) == 1 and found[0].tapped and len(owners) == 2 and owners not in jointed and lie and all(lie):
            others = connected({*body.values()}, [(*tie,) for tie in ties if tie != owners and len(tie) == 2])
            if any(owners <= {*group} for group in others):
                continue
            wide, narrow = sorted((one, other), key=lambda bore: -bore.radius)
            parts = known.in_order(found[0].parts)
            joint = pairs.revolute("-".join(parts), *parts, point=narrow.point, axis=narrow.axis)
            text = f"a hole of radius {wide.radius:.4g} over one of {narrow.radius:.4g}, as for a screw to turn on"
            sizes = (("radius", wide.radius), ("clearance", wide.radius - narrow.radius))
            result.append(Inference.of(joint, Evidence(EvidenceKind.VIRTUAL_PIN, sizes, text)))
    return result


def _covered(known: Known, holes: list[Bore], other: str, normal: np.ndarray) -> list[Bore]:
    """Find holes across a face, on axes beside each other, that end on triangles of the other part."""
    found: list[Bore] = []
    triangles = known.solids[other].triangles
    for hole in holes:
        if np.linalg.norm(np.cross(hole.axis, normal)) > ACROSS or not all(beside(hole, each) for each in found):
            continue
        distances = np.abs(crossings(hole.point, hole.axis, triangles)) - hole.half
        if np.any(np.abs(distances) <= AT_FACE * hole.radius):
            found.append(hole)
    return found
