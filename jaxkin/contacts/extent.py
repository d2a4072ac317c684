"""The extent of a trimmed face along its surface: heights along an axis, distances along rulings, corners in a plane.

Triangles follow a curved rim in chords and end before it does, so an interval is longer than its corners are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import Points, Vector
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere


class Interval(NamedTuple):
    """A piece of a line."""

    origin: Vector
    direction: Vector
    """Unit vector; of the rulings of a cone, all of which have one interval, its axis."""
    low: float
    high: float


def interval(face: Face) -> Interval:
    """Heights of a cylinder along its axis, distances from the apex of a cone, the centre of a ball."""
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
    """The corners of a face in a plane."""
    offset = face.triangles.reshape(-1, 3) - origin
    return np.stack([offset @ x, offset @ y], axis=-1)


def _ends(corners: Points, values: Float[np.ndarray, " corners"]) -> tuple[float, float]:
    """Lowest and highest value on the rim, of which corners are a sample.

    About an extremum of a smooth rim that is sampled evenly, the extremum is missed by at most an eighth of the
    difference of the first and the third sample: by nothing where the rim is at one height.
    """
    scale = 1e-7 * float(np.ptp(corners, axis=0).max()) or 1.0  # most readers keep corners in single precision
    _, first = np.unique(np.round((corners - corners[0]) / scale), axis=0, return_index=True)
    values = np.sort(values[first])
    third = min(2, len(values) - 1)
    return float(values[0] - (values[third] - values[0]) / 8), float(values[-1] + (values[-1] - values[-1 - third]) / 8)
