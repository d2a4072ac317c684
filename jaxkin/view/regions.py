"""What a contact looks like in space: the area that its faces share, its line, its circle, or its point."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.contact import Contact
from jaxkin.contacts.overlap import flat, shared_triangles
from jaxkin.contacts.region import contact_region
from jaxkin.contacts.touch import Touch
from jaxkin.contacts.unrolled import turned, unrolled
from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import perpendicular
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane


class DrawnRegion(NamedTuple):
    """In world coordinates of the assembled pose."""

    triangles: Float[np.ndarray, "triangles 3 3"]
    """Of an area; none for the others."""
    line: Float[np.ndarray, "points 3"]
    """Of a line or a circle; a single point is a point. None for an area."""


def region_of(contact: Contact, face1: Face, face2: Face, tolerance: float) -> DrawnRegion:
    """Find the region of a contact between two faces; `tolerance` is the length of the detection."""
    s1, s2 = contact.surfaces
    touch = contact.contact_state.touch(s1, s2, contact.centre)
    if touch is None:  # the detection found one here
        return DrawnRegion(np.zeros((0, 3, 3)), contact.centre[None])
    match contact.region:
        case "surface":
            return DrawnRegion(_area(touch, face1, face2, tolerance), np.zeros((0, 3)))
        case "circle":
            x = perpendicular(touch.direction)
            turn = np.linspace(0.0, 2 * np.pi, 97)[:, None]
            circle = np.cos(turn) * x + np.sin(turn) * np.cross(touch.direction, x)
            return DrawnRegion(np.zeros((0, 3, 3)), touch.point + touch.radius * circle)
        case "line":
            found = contact_region("line", touch, face1, face2, tolerance)
            half = 0.5 * (found.extent if found else 0.0)
            return DrawnRegion(np.zeros((0, 3, 3)), contact.centre + np.outer([-half, half], touch.direction))
    return DrawnRegion(np.zeros((0, 3, 3)), touch.point[None])


def _area(touch: Touch, face1: Face, face2: Face, tolerance: float) -> np.ndarray:
    a, b = face1.triangles, face2.triangles
    surface = face1.surface
    if isinstance(surface, Plane):
        x = perpendicular(touch.normal)
        y = np.cross(touch.normal, x)
        shared = shared_triangles(flat(a, touch.point, x, y), flat(b, touch.point, x, y), tolerance)
        return touch.point + shared[..., :1] * x + shared[..., 1:] * y
    if isinstance(surface, Cylinder | Cone):
        x = perpendicular(touch.direction)
        y = np.cross(touch.direction, x)
        charts = [unrolled(triangles, touch.point, touch.direction, 1.0) for triangles in (a, b)]
        scale = float(np.ptp(charts[0][..., 1])) or 1.0  # angles as lengths of the size of the face
        charts = [chart * [scale, 1.0] for chart in charts]
        shared = shared_triangles(charts[0], turned(charts[1], scale), tolerance)
        angle, height = shared[..., :1] / scale, shared[..., 1:]
        radius = surface.radius if isinstance(surface, Cylinder) else _cone_radius(surface, touch, height)
        round_ = np.cos(angle) * x + np.sin(angle) * y
        return touch.point + radius * round_ + height * touch.direction
    return min(a, b, key=len) if face1.area == face2.area else (a if face1.area < face2.area else b)


def _cone_radius(cone: Cone, touch: Touch, height: np.ndarray) -> np.ndarray:
    places = touch.point + height * touch.direction
    return np.abs((places - cone.apex) @ cone.axis)[..., None] * np.tan(cone.half_angle)
