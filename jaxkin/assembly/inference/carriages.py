"""Carriages on wheels: bodies whose wheels run on faces of a rail, on both sides of it, so that they slide along it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.outline import widest_gap
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Vector, cross
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind

MAX_CARRIAGE_PLAY = 0.05
"""Gap or overlap of a wheel and the face that it runs on, over the radius of the wheel, at most."""
MIN_SLANT = 0.1
"""Sine of the angle between the axis of a wheel and the normal of the face that it runs on, at least."""


class _Wheel(NamedTuple):
    """A body that turns on a carriage."""

    part: Part
    """The one that is widest about the axis."""
    faces: tuple[Face, ...]
    """Its round faces about the axis, those of its outside."""
    point: Vector
    axis: Vector
    radius: float


class _Run(NamedTuple):
    """A wheel near a face that it can run on."""

    wheel: _Wheel
    normal: Vector
    gap: float


def carriages(known: Known) -> list[Inference]:
    """Infer prismatic joints of bodies with the rails that wheels of theirs run on, with a little play or overlap.

    The wheels are at two places along the rail, at least, and meet faces on both sides of it. Wheels that fit their
    rail exactly are left to the contacts that they have there.
    """
    body, result = known.body, []
    tied = {*known.jointed, *(frozenset(body[part] for part in pair) for pair in known.touching)}
    runs: dict[tuple[str, str], list[_Run]] = {}
    for owners, point, axis in _hinges(known):
        for turning, carrier in (owners, owners[::-1]):
            wheel = _wheel([part for part in known.parts if body[part.name] == turning], point, axis)
            for rail in known.measured.beside(wheel.part) if wheel else ():
                owner = body[rail.name]
                if wheel and owner not in owners and frozenset((owner, turning)) not in tied:
                    runs.setdefault((carrier, owner), []).extend(_runs(wheel, rail))
    for (carrier, rail), found in runs.items():
        pair: BodyPair = frozenset((carrier, rail))
        axis = None if pair in tied else _way(found)
        if axis is not None:
            wheels = known.in_order({run.wheel.part.name for run in found})
            gap = max((run.gap for run in found), key=abs)
            how = "gaps" if gap >= 0 else "overlaps"
            largest = [
                _largest([part for part in known.parts if body[part.name] == owner]) for owner in (carrier, rail)
            ]
            parts = known.in_order(largest)
            text = f"{len(wheels)} wheels of {largest[0]!r}, such as {wheels[0]!r}, run on faces of {largest[1]!r}"
            text += f", with {how} of up to {abs(gap):.2g}"
            evidence = Evidence(EvidenceKind.CLEARANCE, (("play", gap),), text)
            middle = np.mean([run.wheel.point for run in found], axis=0)
            joint = pairs.prismatic("-".join(parts), *parts, point=middle, axis=axis)
            result.append(Inference.of(joint, evidence))
            tied.add(pair)
    return result


def _hinges(known: Known) -> list[tuple[list[str], Vector, Vector]]:
    """Find the axes about which bodies turn on each other: of inferred hinges, and of pins that fit exactly."""
    body, found = known.body, []
    for each in known.found:
        if each.joint and each.joint.kind is JointKind.REVOLUTE:
            pose = np.asarray(each.joint.frames_1, float)[0]
            found.append(([body[part] for part in each.parts], pose[:3, 3], pose[:3, 2]))
    seen = set()
    for contact in known.contacts:
        owners, pin = [body[part] for part in contact.parts], contact.surfaces[0]
        if contact.contact_state.is_pin and isinstance(pin, Cylinder) and frozenset(owners) not in seen:
            seen.add(frozenset(owners))
            found.append((owners, pin.point, pin.axis))
    return [each for each in found if each[0][0] != each[0][1]]


def _wheel(parts: Sequence[Part], point: Vector, axis: Vector) -> _Wheel | None:
    """Find the wheel among the parts of a body that turns on a hinge: None where none has round faces about it."""
    found = []
    for part in parts:
        faces = tuple(face for face in part.faces if _is_tread(face, point, axis))
        if faces:
            corners = np.concatenate([face.triangles.reshape(-1, 3) for face in faces]) - point
            along = corners @ axis
            radius = float(np.linalg.norm(corners - np.outer(along, axis), axis=1).max())
            found.append(_Wheel(part, faces, point + (along.min() + along.max()) / 2 * axis, axis, radius))
    return max(found, key=lambda wheel: wheel.radius, default=None)


def _largest(parts: Sequence[Part]) -> str:
    """Name the largest of some parts, by its bounding box."""
    return max(parts, key=lambda part: part.extent).name


def _is_tread(face: Face, point: Vector, axis: Vector) -> bool:
    """Tell whether a face is one of the outside of a part that is round about an axis."""
    surface = face.surface
    if not isinstance(surface, Cylinder | Cone) or surface.side < 0:
        return False
    offset = (surface.point if isinstance(surface, Cylinder) else surface.apex) - point
    apart = np.linalg.norm(offset - (offset @ axis) * axis)
    return bool(np.linalg.norm(np.cross(surface.axis, axis)) < ACROSS and apart < ACROSS * _size(face))


def _size(face: Face) -> float:
    return float(np.ptp(face.triangles.reshape(-1, 3), axis=0).max())


def _runs(wheel: _Wheel, rail: Part) -> list[_Run]:
    """Find the plane faces of a part that a wheel runs on, with their normals and gaps."""
    found = []
    treads = np.concatenate([face.triangles.reshape(-1, 3) for face in wheel.faces])
    for face in rail.faces:
        plane = face.surface
        if not isinstance(plane, Plane):
            continue
        way = cross(wheel.axis, plane.normal)
        if np.linalg.norm(way) < MIN_SLANT:
            continue
        heights = (treads - plane.point) @ plane.normal
        gap = float(heights.min())
        if abs(gap) > MAX_CARRIAGE_PLAY * wheel.radius:
            continue
        way /= np.linalg.norm(way)
        across = np.column_stack([way, np.cross(plane.normal, way)])
        lowest = treads[heights <= gap + MAX_CARRIAGE_PLAY * wheel.radius] @ across
        places = face.triangles @ across  # a face may be in two channels, a triangle is not
        beyond = (places.min(axis=1) >= lowest.max(axis=0)) | (places.max(axis=1) <= lowest.min(axis=0))
        if not np.all(np.any(beyond, axis=1)):
            found.append(_Run(wheel, plane.normal, gap))
    return found


def _way(runs: Sequence[_Run]) -> Vector | None:
    """Find the direction along which wheels run, where they hold what they carry on both sides of it; None otherwise.

    Along their axes, wheels hold it by rolling: they do not slip.
    """
    if not runs:
        return None
    way = np.cross(runs[0].wheel.axis, runs[0].normal)
    way /= np.linalg.norm(way)
    if any(abs(float(each @ way)) > ACROSS for run in runs for each in (run.normal, run.wheel.axis)):
        return None
    places = np.array([run.wheel.point @ way for run in runs])
    if np.ptp(places) < max(run.wheel.radius for run in runs):
        return None
    x = runs[0].wheel.axis
    normals = np.array([run.normal for run in runs]) @ np.column_stack([x, np.cross(way, x)])
    return way if widest_gap(np.arctan2(normals[:, 1], normals[:, 0])) < np.pi + ACROSS else None
