"""Check whether two faces share a contact region, exactly, at one pose, and whether their extents alone tell it.

`separation` replaces a face by a hull or an interval, which is larger than a face with holes, notches or only a part of
a turn. The check here takes the triangles, by the function that found the contact in the assembled pose.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jaxkin.contacts.extent import interval, outline
from jaxkin.contacts.region import contact_region
from jaxkin.contacts.states import ContactState
from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import Transform, apply, perpendicular
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere

_FLAT_FILL = 1e-9
"""Share of the area of its hull that a flat face may lack and still be its hull: rounding of the corners leaves less,
and holes take more."""
_ROUND_FILL = 0.5
"""Share of the area of a whole turn that a curved face may lack and still be whole, over bulge / radius. Chords of n to
a turn lack (pi / n)^2 / 6, which is a third of that ratio; the rest leaves room for chords of unequal length."""


def share_region(state: ContactState, face1: Face, face2: Face, displacement: Transform, length: float) -> bool:
    """Check whether two faces share the region of their contact, when face 2 is moved by a displacement.

    The surfaces touch there in the given state; `length` is what counts as touching. A region at the rim of a face
    counts, so that a face ends where its triangles do.
    """
    surface, triangles = face2.surface.moved(displacement), apply(displacement, face2.triangles)
    moved = replace(face2, surface=surface, triangles=triangles)
    low, high = np.maximum(face1.box[0], moved.box[0]), np.minimum(face1.box[1], moved.box[1])
    reach = length + face1.bulge + face2.bulge
    if np.any(low - high > 2 * reach):
        return False
    touch = state.touch(face1.surface, surface, (low + high) / 2)
    return touch is not None and contact_region(state.region, touch, face1, moved, length) is not None


def is_whole(face: Face) -> bool:
    """Check whether a face is all of its extent: a convex plane, or a whole turn between two circles, or a whole ball.

    Then the gaps of `separation` are exact: the faces share a region where they are not positive.
    """
    surface = face.surface
    match surface:
        case Plane(point=point, normal=normal):
            return face.area >= (1 - _FLAT_FILL) * _hull_area(face, point, normal)
        case Sphere(radius=radius):
            full, mean = 4 * np.pi * radius**2, radius
        case Cylinder(radius=radius):
            of_face = interval(face)
            full, mean = 2 * np.pi * radius * (of_face.high - of_face.low), radius
        case Cone(half_angle=half_angle):
            of_face = interval(face)
            full = np.pi * np.sin(half_angle) * (of_face.high**2 - of_face.low**2)
            mean = of_face.high * np.sin(half_angle)
    return face.area >= (1 - _ROUND_FILL * face.bulge / mean) * full


def _hull_area(face: Face, point: np.ndarray, normal: np.ndarray) -> float:
    """Measure the area of the convex hull of a flat face; infinite where it has none, so that nothing is left out."""
    from scipy.spatial import ConvexHull, QhullError

    x = perpendicular(normal)
    try:
        return float(ConvexHull(outline(face, point, x, np.cross(normal, x))).volume)  # of a flat hull, its area
    except QhullError:
        return np.inf
