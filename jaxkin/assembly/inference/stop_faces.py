"""Stop faces, which stand across an axis: how far two bodies can slide on each other along it until such faces meet."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.bores import Bore
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector, frame
from jaxkin.geometry.surfaces import Plane, Surface
from jaxkin.geometry.triangles import double_areas

ACROSS = 1e-3
"""Radians between an axis and the normal of a face that stands across it."""
REACH = 3.0
"""Faces that stop a hinge come nearer to its axis than this, over the radius of its hole: shoulders, washers."""
MAX_AXIAL_PLAY = 3.0
"""Play of a hinge along its axis, over the radius, in all: a link between two lugs, with washers that are not drawn.
What slides on purpose has a stroke of more."""
MAX_LIFT = 0.5
"""Distance from a face, over the radius, at which a screw or a pin with a head holds a part to it."""
MAX_OVERLAP = 0.2
"""Faces that overlap by no more, over the radius, are drawn a little too thick."""
MIN_MET = 0.02
"""Width, over the radius, of the ring about the axis in which two faces meet, at least: a piston passes a shoulder that
begins where the piston ends."""

MIN_SLOPE = 0.1
"""Cosine of the angle between an axis and the normal of a slanted face, at least: steeper ones slide past others."""
RINGS, RING_POINTS = 5, 24
"""Rings about an axis, and points on each, at which slanted faces are measured."""

WIDER = 1.05
"""Distance from the axis over the radius of a pin from which on it is shoulders that are met, not the pin itself."""


def stands_across(surface: Surface, axis: Vector) -> bool:
    """Tell whether a surface is a plane across an axis."""
    return isinstance(surface, Plane) and bool(np.linalg.norm(np.cross(surface.normal, axis)) < ACROSS)


class StopFace(NamedTuple):
    """A plane face across an axis, near to it."""

    height: float
    """Where it stands along the axis."""
    forwards: bool
    """Whether its outward normal is along the axis, not against it."""
    inner: float
    """Least distance of the face from the axis."""
    outer: float
    """Greatest one: what turns about the axis meets faces that are as far from it."""


def stops(part: Part, axis: Bore) -> list[StopFace]:
    """Find the plane faces of a part that stand across an axis, near to it."""
    planes = [(face.surface, face.triangles) for face in part.faces if isinstance(face.surface, Plane)]
    if not planes:
        return []
    tilts = np.linalg.norm(np.cross([plane.normal for plane, _ in planes], axis.axis), axis=1)
    found = []
    for (plane, triangles), tilt in zip(planes, tilts, strict=True):
        if tilt <= ACROSS and (inner := _distance(triangles, axis.point, axis.axis)) <= REACH * axis.radius:
            corners = triangles.reshape(-1, 3) - axis.point
            outer = np.linalg.norm(corners - np.outer(corners @ axis.axis, axis.axis), axis=1).max()
            forwards = bool(plane.normal @ axis.axis > 0)
            found.append(StopFace(float(plane.point @ axis.axis), forwards, inner, float(outer)))
    return found


def slanted_stops(part: Part, axis: Bore) -> list[StopFace]:
    """Find where faces of a part that stand askew to an axis reach farthest along it, either way, beside the bore and
    near to it: slanted ends, cones, balls and points of plates meet faces across the axis as plane faces do.

    Each is a narrow ring about the axis, at the farthest point of the face among its corners and some points on rings.
    """
    low, high = part.box - axis.point
    middle, reach = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    if np.linalg.norm(np.cross(middle, axis.axis)) - reach > REACH * axis.radius:
        return []
    found = []
    for face in part.faces:
        if stands_across(face.surface, axis.axis):
            continue
        triangles = face.triangles - axis.point
        slopes = double_areas(triangles)
        slopes = (slopes @ axis.axis) / np.maximum(np.linalg.norm(slopes, axis=1), np.finfo(float).tiny)
        for way in (1.0, -1.0):
            points = _beside(triangles[way * slopes > MIN_SLOPE], axis)
            if len(points):
                height, distance = points[np.argmax(way * points[:, 0])]
                width = MIN_MET * axis.radius
                place = float(axis.point @ axis.axis + height)
                found.append(StopFace(place, way > 0, float(distance - width), float(distance + width)))
    return found


def _beside(triangles: Float[np.ndarray, "triangles 3 3"], axis: Bore) -> Float[np.ndarray, "points 2"]:
    """List points of triangles, relative to the axis, that lie beside its bore: heights, and distances from it."""
    heights = triangles @ axis.axis
    flat = triangles @ frame(axis.point, axis.axis, _towards_farthest(triangles, axis.axis))[:3, :2]
    away = np.linalg.norm(flat, axis=-1)
    low, high = WIDER * axis.radius, REACH * axis.radius
    near = np.all(flat.min(axis=1) <= high, axis=-1) & np.all(flat.max(axis=1) >= -high, axis=-1)
    near &= away.max(axis=1) > low
    corners = (away > low) & (away <= high)
    found = [np.column_stack([heights[corners], away[corners]])]
    angle, radius = np.meshgrid(np.linspace(0, 2 * np.pi, RING_POINTS, endpoint=False), np.linspace(low, high, RINGS))
    points = np.column_stack([(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel()])
    for corner, height in zip(flat[near], heights[near], strict=True):
        edges = np.column_stack([corner[1] - corner[0], corner[2] - corner[0]])
        if abs(np.linalg.det(edges)) > np.finfo(float).tiny:
            share = np.linalg.solve(edges, (points - corner[0]).T)
            inside = (share.min(axis=0) >= 0) & (share.sum(axis=0) <= 1)
            on_it = height[0] + (height[1:] - height[0]) @ share[:, inside]
            found.append(np.column_stack([on_it, radius.ravel()[inside]]))
    return np.concatenate(found)


def _towards_farthest(triangles: Float[np.ndarray, "triangles 3 3"], axis: Vector) -> Vector | None:
    """Find the direction across an axis through the origin to the corner that is farthest from it, so that what is
    measured in this direction turns with the triangles; None where there is no such corner."""
    corners = triangles.reshape(-1, 3)
    corners = corners - np.outer(corners @ axis, axis)
    away = np.linalg.norm(corners, axis=1)
    farthest = int(np.argmax(away)) if len(away) else 0
    return corners[farthest] if len(away) and away[farthest] > 0 else None


def _distance(triangles: Float[np.ndarray, "triangles 3 3"], point: Vector, axis: Vector) -> float:
    """Measure the distance from an axis of triangles that stand across it; 0 where it goes through one of them."""
    corners = triangles - point
    corners = corners - (corners @ axis)[..., None] * axis
    edges = np.roll(corners, -1, axis=1) - corners
    turns = np.einsum("tki,i->tk", np.cross(corners, edges), axis)
    if np.any(np.all(turns > 0, axis=1) | np.all(turns < 0, axis=1)):
        return 0.0
    squares = np.maximum(np.sum(edges**2, axis=-1), np.finfo(float).tiny)
    along = np.clip(-np.sum(corners * edges, axis=-1) / squares, 0.0, 1.0)
    return float(np.linalg.norm(corners + along[..., None] * edges, axis=-1).min())


def play(one: Sequence[StopFace], other: Sequence[StopFace], radius: float) -> float | None:
    """Return how far one body can slide in the other in all, forwards and backwards; None where nothing stops it."""
    ahead, behind = gap(one, other, radius), gap(other, one, radius)
    return None if ahead is None or behind is None else ahead + behind


def nearest(one: Sequence[StopFace], other: Sequence[StopFace], radius: float) -> float | None:
    """Return how far one body is from being stopped by the other, on the side where that is less; None without
    stops."""
    found = (gap(one, other, radius), gap(other, one, radius))
    return min((each for each in found if each is not None), default=None)


def gap(one: Sequence[StopFace], other: Sequence[StopFace], radius: float) -> float | None:
    """Measure the least gap from faces of one that look forwards to faces of the other that look backwards, as far from
    the axis."""
    facing = [(a, b) for a in one if a.forwards for b in other if not b.forwards]
    gaps = [b.height - a.height for a, b in facing if min(a.outer, b.outer) - max(a.inner, b.inner) > MIN_MET * radius]
    return min((max(gap, 0.0) for gap in gaps if gap >= -MAX_OVERLAP * radius), default=None)


def between_bores(parts: Sequence[Part], pin: Bore, spans: Sequence[tuple[float, float]]) -> float | None:
    """Return how far a body with a pin in two bores, at spans along the axis of the pin, can slide until what it has
    between them meets them; None where it has nothing wider there."""
    corners = np.concatenate([part.triangles.reshape(-1, 3) for part in parts]) - pin.point
    along = corners @ pin.axis
    away = np.linalg.norm(corners - np.outer(along, pin.axis), axis=1)
    along = along[(away > WIDER * pin.radius) & (away <= REACH * pin.radius)] + pin.point @ pin.axis
    slack = MAX_OVERLAP * pin.radius
    for (_, low), (high, _) in pairwise(spans):
        inside = along[(along >= low - slack) & (along <= high + slack)]
        if len(inside):
            return float(max(inside.min() - low, 0.0) + max(high - inside.max(), 0.0))
    return None
