"""Measure how far two faces are apart along their surfaces, which stay in contact, over many displacements.

While a mechanism moves, its joints keep the unbounded surfaces in contact; they do not keep the faces, which are
bounded pieces of the surfaces, from sliding apart. There is one function for each kind of contact, from face 1, face 2
and the displacements of face 2 to gaps. A face is replaced by a convex hull or an interval along the freedoms of the
contact, which contains it. So a positive gap is certain; a negative gap does not exclude that the faces are apart, at
holes, notches and half bores.
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

FaceDisplacements = Float[np.ndarray, "3 4 poses"]
"""Displacements of face 2 relative to face 1 from the assembled pose, in world coordinates: the first three rows of
4x4 matrices, with the pose as last axis."""
Gaps = Float[np.ndarray, " poses"]
"""For each pose the length by which the faces are at least apart along the surface; negative where they may overlap."""


def along_axis(face1: Face, face2: Face, displacements: FaceDisplacements) -> Gaps:
    """Measure the gap along the axis of cylinder 1, between its heights and those of cylinder, cone or ball 2.

    A cone that touches along a ruling has its ruling parallel to the axis; a ball counts by its centre.
    """
    one, other = interval(face1), interval(face2)
    place = _moved(one.direction, displacements, other.origin) - one.direction @ one.origin
    return _between(one, other, place, 1.0 if one.direction @ other.direction >= 0 else -1.0)


def on_ruling(face1: Face, face2: Face, displacements: FaceDisplacements) -> Gaps:
    """Measure the gap along the rulings of cone 1, between face 1 and the point where ball 2 touches its ruling."""
    one, cone, centre = interval(face1), cast(Cone, face1.surface), interval(face2).origin
    offset = _points(displacements, centre) - cone.apex[:, None]
    height = cone.axis @ offset
    radius = np.linalg.norm(offset - cone.axis[:, None] * height, axis=0)
    place = height * np.cos(cone.half_angle) + radius * np.sin(cone.half_angle)
    return _between(one, Interval(centre, one.direction, 0.0, 0.0), place, 1.0)


def across(face1: Face, face2: Face, displacements: FaceDisplacements) -> Gaps:
    """Measure the gap of two crossed cylinders along either axis, between the face and the common normal of the axes.

    Of the two gaps, the larger one is returned.
    """
    one, other = interval(face1), interval(face2)
    direction = np.einsum("ijn,j->in", displacements[:, :3], other.direction)
    between = _points(displacements, other.origin) - one.origin[:, None]
    cosine = one.direction @ direction
    along1, along2 = one.direction @ between, np.sum(direction * between, axis=0)
    square = np.maximum(1.0 - cosine**2, 1e-12)  # parallel axes have no common normal: any large gap will do
    place1, place2 = (along1 - cosine * along2) / square, (cosine * along1 - along2) / square
    point = Interval(one.origin, one.direction, 0.0, 0.0)
    return np.maximum(_between(one, point, place1, 1.0), _between(other, point, place2, 1.0))


def on_plane(face1: Face, face2: Face, displacements: FaceDisplacements) -> Gaps:
    """Measure the gap in plane 1 between the hull of face 1 and that of what lies on it.

    This is the outline of a plane, the contact line of a cylinder or a cone, or the contact point of a ball. -inf where
    an outline has no hull, since all its corners are on one line.
    """
    plane = cast(Plane, face1.surface)
    x = perpendicular(plane.normal)
    axes = np.stack([x, np.cross(plane.normal, x)])
    one = hull(outline(face1, plane.point, *axes), of_triangles=True)
    origin, along, other = _lying(face2, plane.normal)
    if one is None or other is None:
        return np.full(displacements.shape[2], -np.inf)
    shift = axes @ (_points(displacements, origin) - plane.point[:, None])
    turn = axes @ np.einsum("ijn,j->in", displacements[:, :3], along)
    size = np.linalg.norm(turn, axis=0)
    # a ball, whose hull is a point, may be turned by a quarter, so that its direction stands on the plane
    turn = np.where(size > 0, turn, [[1.0], [0.0]]) / np.where(size > 0, size, 1.0)
    return gaps_between_hulls(one, other, PlaneMotion(turn, shift))


def _lying(face: Face, normal: Vector) -> tuple[Vector, Vector, Hull | None]:
    """Make the hull of what of a face lies on a plane with a unit `normal`.

    Returns the origin and the x axis of a chart of the plane, and the hull in its coordinates; y = normal x x.
    """
    match face.surface:
        case Plane(point=point, normal=direction):
            x = perpendicular(direction)
            return point, x, hull(outline(face, point, x, np.cross(normal, x)), of_triangles=True)
        case Sphere(centre=centre):
            return centre, perpendicular(normal), hull(np.zeros((1, 2)))
        case _:
            line = interval(face)
            return line.origin, line.direction, hull(np.array([[line.low, 0.0], [line.high, 0.0]]))


def _between(one: Interval, other: Interval, place: Gaps, sign: float) -> Gaps:
    """Measure the gap between two intervals on one line: a length, negative where they overlap.

    The origin of the second is at `place` (poses,) on the line, and its direction is reversed for a sign of -1.
    """
    low, high = sorted((sign * other.low, sign * other.high))
    return np.maximum(place + (low - one.high), (one.low - high) - place)


def _points(displacements: FaceDisplacements, point: Vector) -> Float[np.ndarray, "3 poses"]:
    """Displace a point."""
    return np.einsum("ijn,j->in", displacements, np.append(point, 1.0))


def _moved(direction: Vector, displacements: FaceDisplacements, point: Vector) -> Gaps:
    """Compute the coordinate of a displaced point along a direction, from the origin of the world."""
    return np.einsum("i,ijn,j->n", direction, displacements, np.append(point, 1.0))
