"""Stop faces, which stand across an axis: how far two bodies can slide on each other along it until such faces meet."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.bores import Bore
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane, Surface

ACROSS = 1e-3
"""Radians between an axis and the normal of a face that stands across it."""
REACH = 3.0
"""Faces that stop a hinge come nearer to its axis than this, over the radius of its hole: shoulders, washers."""
MAX_PLAY = 3.0
"""Play of a hinge along its axis, over the radius, in all: a link between two lugs, with washers that are not drawn.
What slides on purpose has a stroke of more."""
MAX_LIFT = 0.5
"""Distance from a face, over the radius, at which a screw or a pin with a head holds a part to it."""
MAX_OVERLAP = 0.2
"""Faces that overlap by no more, over the radius, are drawn a little too thick."""
MIN_MET = 0.02
"""Width, over the radius, of the ring about the axis in which two faces meet, at least: a piston passes a shoulder that
begins where the piston ends."""

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
