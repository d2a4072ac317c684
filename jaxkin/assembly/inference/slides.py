"""Slides with clearance: a part between faces of another one on both sides, in two directions."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.slide_stops import Stop
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.assembly.inference.walls import MAX_SIDE_PLAY, Looking, between_faces, facing, walls
from jaxkin.geometry.outline import widest_gap
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind

MIN_SLANT = 0.1
"""Sine of the angle between two faces that are not parallel, at least: slanting faces of rails have 45 degrees."""
SAME_DIRECTION = 9
"""Decimals of unit normals that are one direction: far below the rounding of files."""


def loose_slides(known: Known) -> list[Inference]:
    """Infer prismatic joints of parts that are between faces of another body, with play, and have no contact with
    it."""
    body, result = known.body, []
    tied = {*known.jointed, *(frozenset(body[part] for part in pair) for pair in known.touching)}
    for part in known.parts:
        for owner, others in known.around(part, body).items():
            owners = frozenset((body[part.name], owner))
            if owners in tied:
                continue
            found = slide_between(part, others) or _dovetail(part, others)
            if found is not None:
                axis, play = found
                parts = known.in_order((part.name, others[0].name))
                text = f"faces on both sides in two directions, with a play of {play:.2g}"
                evidence = Evidence(EvidenceKind.CLEARANCE, (("play", play),), text)
                joint = pairs.prismatic("-".join(parts), *parts, point=part.box.mean(axis=0), axis=axis)
                result.append(Inference.of(joint, evidence))
                tied.add(owners)
    return result


def guided_on_faces(known: Known) -> list[StoppedJoint]:
    """Infer prismatic joints of bodies that lie flat on each other, with walls of one on both sides of the other, which
    leave it a play: a jaw on its ways. Exact contacts let it slide both ways and turn; the walls stop that where it is
    of use, and wherever a pin drives the body, whose links may keep it in line as well.

    Bodies that have an axis in common are left to that: a plate that turns on a pin is also between its cheeks.
    """
    body, result = known.body, []
    flat: dict[BodyPair, list[Vector]] = {}
    about = {frozenset(body[part] for part in each.parts) for each in known.axes}
    others = {*about, *known.jointed, *(frozenset(body[part] for part in each.parts) for each in known.tapped)}
    for contact in known.contacts:
        owners, surface = frozenset(body[part] for part in contact.parts), contact.surfaces[0]
        if isinstance(surface, Plane) and contact.contact_state.is_flat:
            flat.setdefault(owners, []).append(surface.normal)
        else:
            others.add(owners)
    for owners, normals in flat.items():
        if len(owners) < 2 or owners in others or any(_are_across(normal, normals[0]) for normal in normals):
            continue
        one, other = ([part for part in known.parts if body[part.name] == owner] for owner in known.in_order(owners))
        walls = [
            (part, *wall)
            for first, second in ((one, other), (other, one))
            for part in first
            for wall in between_faces(part, *second)
            if abs(float(wall[0] @ normals[0])) < ACROSS
        ]
        found, beside = None, "flanks of a dovetail" if not walls else "walls beside them"
        if walls and not any(_are_across(wall, walls[0][1]) for _, wall, _ in walls):
            part, wall, play = min(walls, key=lambda each: each[2])
            found = part, np.cross(wall, normals[0]), play
        elif not walls:
            found = _in_dovetail(one, other, normals[0])
        if found is not None:
            part, axis, play = found
            parts = known.in_order(owners)
            text = f"faces that {parts[0]!r} and {parts[1]!r} lie on, and {beside} with a play of {play:.2g}"
            evidence = Evidence(EvidenceKind.CLEARANCE, (("play", play),), text)
            joint = pairs.prismatic("-".join(parts), *parts, point=part.box.mean(axis=0), axis=axis)
            loose = owners - {body[part] for part in known.fixed}  # a pin drives what has an axis with a third body
            driven = all(any(owner in pair and not pair <= owners for pair in about) for owner in loose)
            result.append(StoppedJoint(Inference.of(joint, evidence), Stop.FACES, not driven))
    return result


def _in_dovetail(ones: Sequence[Part], others: Sequence[Part], normal: Vector) -> tuple[Part, Vector, float] | None:
    """Find a part of a body that lies on the floor of a dovetail of another one, with its slide and the play."""
    for part, around in [*((part, others) for part in ones), *((part, ones) for part in others)]:
        found = _dovetail(part, around)
        if found is not None and abs(float(found[0] @ normal)) < ACROSS:
            return part, *found
    return None


def _are_across(one: Vector, other: Vector) -> bool:
    """Tell whether two normals are not parallel."""
    return bool(np.linalg.norm(np.cross(one, other)) > ACROSS)


def slide_between(one: Part, others: Sequence[Part]) -> tuple[Vector, float] | None:
    """Find the direction in which a part slides between faces of others, which are one body, and its largest play.

    It is between two walls, and kept from the third direction by other walls or by slanting faces, as a carriage is in
    the grooves of its rail.
    """
    looking = facing(one, others)
    held = walls(looking)
    for normal, play, width in held:
        for across in _directions(looking):
            axis = _axis_across(normal, across, [each for each, *_ in held])
            if axis is None:
                continue
            beside = np.cross(axis, normal)
            gaps = [(float(each @ beside), gap) for each, gap, _ in looking if abs(each @ axis) < ACROSS]
            ahead, behind = (
                min((gap / abs(along) for along, gap in gaps if side * along > MIN_SLANT), default=np.inf)
                for side in (1, -1)
            )
            if ahead + behind <= MAX_SIDE_PLAY * width:
                return axis, max(play, ahead + behind)
    return None


def _axis_across(first: Vector, second: Vector, walls: Sequence[Vector]) -> Vector | None:
    """Find the direction along two faces, by their normals; None where these are parallel, or walls stop a slide."""
    axis = np.cross(first, second)
    if np.linalg.norm(axis) <= MIN_SLANT:
        return None
    axis /= np.linalg.norm(axis)
    return None if any(abs(each @ axis) > np.sqrt(1 - ACROSS**2) for each in walls) else axis


def _directions(looking: Sequence[Looking]) -> list[Vector]:
    """List the normals of faces, each direction once."""
    found: dict[bytes, Vector] = {}
    for normal, _, _ in looking:
        found.setdefault((np.round(normal, SAME_DIRECTION) + 0.0).tobytes(), normal)
    return [*found.values()]


def _dovetail(one: Part, others: Sequence[Part]) -> tuple[Vector, float] | None:
    """Find the direction in which a part slides between faces of others that slant, and its largest play across.

    The faces along that direction look outwards all round, as two flanks of a dovetail and its top do, and leave
    little room for what is between them.
    """
    looking = facing(one, others)
    held, middle, directions = walls(looking), one.box.mean(axis=0), _directions(looking)
    for k, first in enumerate(directions):
        for second in directions[:k]:
            axis = _axis_across(first, second, [each for each, *_ in held])
            if axis is None:
                continue
            across = np.column_stack([first, np.cross(axis, first)])
            along = [each for each in looking if abs(each[0] @ axis) < ACROSS]
            room = _room([(normal @ across, gap) for normal, gap, _ in along])
            places = [(normal @ across, place - normal @ middle) for normal, _, place in along]
            width = _room(places) if room is not None else None
            if room is not None and width is None:  # other faces of the part lie beside its tail
                near = [place for (_, gap, _), place in zip(along, places, strict=True) if gap <= room.max()]
                width = _within_flanks(first @ across, second @ across, near)
            if room is not None and width is not None and np.all(room <= MAX_SIDE_PLAY * width):
                return axis, float(room.max())
    return None


def _within_flanks(
    first: Float[np.ndarray, "2"],
    second: Float[np.ndarray, "2"],
    places: Sequence[tuple[Float[np.ndarray, "2"], float]],
) -> Float[np.ndarray, "2"] | None:
    """Measure the largest triangle that faces with two normals make with a third face, as the flanks of a dovetail do
    with its top, along two directions; None where no face closes one."""
    flanks = [[each for each in places if np.linalg.norm(each[0] - normal) < ACROSS] for normal in (first, second)]
    triangles = (_room(corner) for corner in product(*flanks, places))
    return max((each for each in triangles if each is not None), key=lambda width: float(width.max()), default=None)


def _room(faces: Sequence[tuple[Float[np.ndarray, "2"], float]]) -> Float[np.ndarray, "2"] | None:
    """Measure how far a part can move to and fro along two directions between faces in their plane, by normals and
    gaps; None where some way is open.

    The part can be where normal @ shift <= gap for each face: a polygon, whose corners are shifts that meet two faces.
    """
    normals, gaps = np.array([normal for normal, _ in faces]), np.array([gap for _, gap in faces])
    if widest_gap(np.arctan2(normals[:, 1], normals[:, 0])) >= np.pi - MIN_SLANT:
        return None
    one, other = np.tril_indices(len(faces), -1)
    turned = normals[one, 0] * normals[other, 1] - normals[one, 1] * normals[other, 0]
    one, other, turned = (each[np.abs(turned) > MIN_SLANT] for each in (one, other, turned))
    first, second = gaps[one, None] * normals[other], gaps[other, None] * normals[one]
    met = np.column_stack([first[:, 1] - second[:, 1], second[:, 0] - first[:, 0]]) / turned[:, None]
    slack = ACROSS * float(np.abs(gaps).max())
    corners = met[np.all(met @ normals.T <= gaps + slack, axis=1)]
    return np.ptp(corners, axis=0) if len(corners) else None
