"""How far two trimmed faces are from each other along the surfaces that stay in contact, over many displacements.

While a mechanism moves, its joints keep the infinite surfaces in contact; whether the faces are still where they touch,
nothing keeps. One function a kind of contact, `(face 1, face 2, displacements of face 2) -> gaps`: extents of the faces
along the freedoms of the contact, by convex hulls and intervals. They are larger than the faces, so that a positive gap
is one for sure, and a negative one says nothing about holes, notches and half bores.
"""

from __future__ import annotations

from typing import cast

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.extent import Interval, interval, outline
from jaxkin.contacts.hulls import Hull, PlaneMotion, gaps_between_hulls, hull
from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import Vector, perpendicular
from jaxkin.geometry.surfaces import Cone, Plane, Sphere

Displacements = Float[np.ndarray, "3 4 poses"]
"""Of face 2 relative to face 1 from the assembled pose, in world coordinates: the upper rows of 4x4 matrices."""
Gaps = Float[np.ndarray, " poses"]
"""Length by which faces are surely apart; negative where they may overlap."""


def along_axis(face1: Face, face2: Face, displacements: Displacements) -> Gaps:
    """Cylinder 1 and what slides along its axis: heights of a cylinder, a ruling of a cone, the centre of a ball."""
    one, other = interval(face1), interval(face2)
    place = _moved(one.direction, displacements, other.origin) - one.direction @ one.origin
    return _between(one, other, place, 1.0 if one.direction @ other.direction >= 0 else -1.0)


def on_ruling(face1: Face, face2: Face, displacements: Displacements) -> Gaps:
    """A ball on a cone: the foot of its centre on the ruling that it touches, and the rulings of the face."""
    one, cone, centre = interval(face1), cast(Cone, face1.surface), interval(face2).origin
    offset = _points(displacements, centre) - cone.apex[:, None]
    height = cone.axis @ offset
    radius = np.linalg.norm(offset - cone.axis[:, None] * height, axis=0)
    place = height * np.cos(cone.half_angle) + radius * np.sin(cone.half_angle)
    return _between(one, Interval(centre, one.direction, 0.0, 0.0), place, 1.0)


def across(face1: Face, face2: Face, displacements: Displacements) -> Gaps:
    """Crossed cylinders: where the common normal of their axes meets each of them, and the heights of both."""
    one, other = interval(face1), interval(face2)
    direction = np.einsum("ijn,j->in", displacements[:, :3], other.direction)
    between = _points(displacements, other.origin) - one.origin[:, None]
    cosine = one.direction @ direction
    along1, along2 = one.direction @ between, np.sum(direction * between, axis=0)
    square = np.maximum(1.0 - cosine**2, 1e-12)  # parallel axes are no crossed ones: any large number will do
    place1, place2 = (along1 - cosine * along2) / square, (cosine * along1 - along2) / square
    point = Interval(one.origin, one.direction, 0.0, 0.0)
    return np.maximum(_between(one, point, place1, 1.0), _between(other, point, place2, 1.0))


def on_plane(face1: Face, face2: Face, displacements: Displacements) -> Gaps:
    """Plane 1 and what lies on it: the outline of a plane, the line of a cylinder or a cone, the foot of a ball."""
    plane = cast(Plane, face1.surface)
    x = perpendicular(plane.normal)
    axes = np.stack([x, np.cross(plane.normal, x)])
    one = hull(outline(face1, plane.point, *axes))
    origin, along, other = _lying(face2, plane.normal)
    if one is None or other is None:
        return np.full(displacements.shape[2], -np.inf)
    shift = axes @ (_points(displacements, origin) - plane.point[:, None])
    turn = axes @ np.einsum("ijn,j->in", displacements[:, :3], along)
    return gaps_between_hulls(one, other, PlaneMotion(turn / np.linalg.norm(turn, axis=0), shift))


def _lying(face: Face, normal: Vector) -> tuple[Vector, Vector, Hull | None]:
    """What of a face lies on a plane: origin and x axis of its chart (y is normal x x), and its hull there."""
    match face.surface:
        case Plane(point=point, normal=direction):
            x = perpendicular(direction)
            return point, x, hull(outline(face, point, x, np.cross(normal, x)))
        case Sphere(centre=centre):
            return centre, perpendicular(normal), hull(np.zeros((1, 2)))
        case _:
            line = interval(face)
            return line.origin, line.direction, hull(np.array([[line.low, 0.0], [line.high, 0.0]]))


def _between(one: Interval, other: Interval, place: Gaps, sign: float) -> Gaps:
    """The gap between two intervals on one line, the second one moved to `place` and reversed by a sign of -1."""
    low, high = sorted((sign * other.low, sign * other.high))
    return np.maximum(place + (low - one.high), (one.low - high) - place)


def _points(displacements: Displacements, point: Vector) -> Float[np.ndarray, "3 poses"]:
    return np.einsum("ijn,j->in", displacements, np.append(point, 1.0))


def _moved(direction: Vector, displacements: Displacements, point: Vector) -> Gaps:
    """The coordinate of a displaced point along a direction."""
    return np.einsum("i,ijn,j->n", direction, displacements, np.append(point, 1.0))
