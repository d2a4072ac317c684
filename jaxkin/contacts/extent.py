"""Measure how far a face extends along its surface: along an axis, along the rulings of a cone, or in a plane.

The triangles of a face follow a curved rim in chords and end short of it, so an interval is made a little longer than
the corners of the triangles show.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.rim import numbered
from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import Points, Vector
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere


class Interval(NamedTuple):
    """The points origin + s direction of a line with low <= s <= high; for a cone such an interval on every ruling."""

    origin: Vector
    """The point where s = 0; the apex of a cone."""
    direction: Vector
    """Unit vector along the line; for a cone its axis, though s is measured along the rulings."""
    low: float
    """Lowest s, a length."""
    high: float
    """Highest s, a length."""


def interval(face: Face) -> Interval:
    """Measure the interval of a face: heights along the axis of a cylinder, distances from the apex of a cone.

    That of a ball is its centre, with direction zero. Raises TypeError for a plane.
    """
    surface, corners = face.surface, face.triangles.reshape(-1, 3)
    match surface:
        case Cylinder():
            return Interval(surface.point, surface.axis, *_ends(corners, (corners - surface.point) @ surface.axis))
        case Cone():
            low, high = _ends(corners, np.linalg.norm(corners - surface.apex, axis=-1))
            return Interval(surface.apex, surface.axis, max(low, 0.0), high)
        case Sphere():
            return Interval(surface.centre, np.zeros(3), 0.0, 0.0)
        case Plane():
            raise TypeError("a plane has no line of its own that it extends along")


def outline(face: Face, origin: Vector, x: Vector, y: Vector) -> Float[np.ndarray, "corners 2"]:
    """Project the corners of a face onto a plane: coordinates from `origin` along the unit vectors `x` and `y`."""
    offset = face.triangles.reshape(-1, 3) - origin
    return np.stack([offset @ x, offset @ y], axis=-1)


def _ends(corners: Points, values: Float[np.ndarray, " corners"]) -> tuple[float, float]:
    """Bound the lowest and highest value along a smooth rim, from its values at the corners.

    Near an extremum of the rim the value is quadratic in the arc length. Corners at equal spacing then miss the
    extremum by at most an eighth of the difference of the first and the third smallest (or largest) value, and by
    nothing where the rim is at constant height.
    """
    _, first = np.unique(numbered(corners), return_index=True)
    values = np.sort(values[first])
    third = min(2, len(values) - 1)
    return float(values[0] - (values[third] - values[0]) / 8), float(values[-1] + (values[-1] - values[-1 - third]) / 8)
