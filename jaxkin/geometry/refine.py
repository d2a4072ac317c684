"""Fit cylinders, cones and tori to points by Gauss-Newton steps, from a first guess that is near.

The derivatives of the distance from a surface by its position, direction and size are closed formulas, which makes a
fit some hundred times as fast as one with finite differences: the faces of a mesh are found by thousands of small fits.

For each kind of surface, one function returns the derivatives (points, parameters) at points (points, 3), and a
function that changes the surface by a step (parameters,). The first two parameters tilt the axis towards x and y.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from jaxkin.geometry.pose import Points, Vector, perpendicular, unit
from jaxkin.geometry.surfaces import Cone, Cylinder
from jaxkin.geometry.torus import Torus

Round = TypeVar("Round", Cylinder, Cone, Torus)

_MAX_REFINEMENTS = 30
"""Largest number of Gauss-Newton steps; the loop ends before if the largest distance no longer falls."""

_MIN_PROGRESS = 0.9
"""Largest ratio of the largest distances after and before a step that counts as progress."""

_MAX_TILT = 0.5
"""Largest change of direction of an axis in one step, radians, about: a guess is not off by more."""


def refined(surface: Round, points: Points) -> Round:
    """Fit a surface to points: move, tilt and resize it to the least sum of squared distances.

    `points` (points, 3) have mean zero and extent about one. The steps end when two in a row do not lessen the largest
    distance by a tenth (`_MIN_PROGRESS`): at the rounding of the points, or early where the points lie on no such
    surface. A single such step is allowed, since the first step may go too far from a poor guess, as for a small piece
    of a torus. Of the surfaces on the way, the one with the least largest distance is returned.
    """
    best, least, before, stuck = surface, np.inf, np.inf, 0
    for _ in range(_MAX_REFINEMENTS):
        distance = np.asarray(surface.distance(points))
        largest = float(np.abs(distance).max())
        stuck = 0 if largest < _MIN_PROGRESS * before else stuck + 1
        before = largest
        if largest < least:
            best, least = surface, largest
        if stuck == 2:
            break
        columns, moved = _CHANGES[type(surface)](surface, points)
        step = np.linalg.lstsq(columns, -distance, rcond=1e-13)[0]
        # limited by the tilt alone: the apex of a cone that is nearly a cylinder may have to move far
        step = step * min(1.0, _MAX_TILT / max(float(np.abs(step[:2]).max()), 1e-300))
        surface = moved(step)
    return best


def _axes(axis: Vector, direction: Points) -> tuple[np.ndarray, Vector, Vector]:
    """Choose unit vectors x, y perpendicular to an axis, towards which it may tilt.

    Returns the components of the vectors `direction` (points, 3) along x and y (points, 2), then x and y.
    """
    x = perpendicular(axis)
    y = np.cross(axis, x)
    return np.stack([direction @ x, direction @ y], axis=-1), x, y


def _split(points: Points, origin: Vector, axis: Vector) -> tuple[np.ndarray, np.ndarray, Points]:
    """Return the cylindrical coordinates of points about an axis through `origin`.

    These are the heights along the axis (points,), the distances from it (points,), and the unit vectors away from it
    (points, 3).
    """
    offset = points - origin
    height = offset @ axis
    radial = offset - height[:, None] * axis
    distance = np.linalg.norm(radial, axis=-1)
    return height, distance, radial / np.where(distance > 0, distance, 1.0)[:, None]


def _cylinder(s: Cylinder, points: Points) -> tuple[np.ndarray, Callable[[np.ndarray], Cylinder]]:
    """Differentiate the distance by (tilt x, tilt y, shift x, shift y, radius)."""
    height, _, away = _split(points, s.point, s.axis)
    across, x, y = _axes(s.axis, away)
    columns = np.column_stack([-height[:, None] * across, -across, -np.ones(len(points))])
    return columns, lambda p: Cylinder(
        s.point + p[2] * x + p[3] * y, unit(s.axis + p[0] * x + p[1] * y), float(s.radius + p[4]), 1
    )


def _cone(s: Cone, points: Points) -> tuple[np.ndarray, Callable[[np.ndarray], Cone]]:
    """Differentiate the distance by (tilt x, tilt y, shift of the apex in space, half-angle)."""
    sin, cos = np.sin(s.half_angle), np.cos(s.half_angle)
    height, distance, away = _split(points, s.apex, s.axis)
    across, x, y = _axes(s.axis, away)
    slant = height * cos + distance * sin
    columns = np.column_stack([-slant[:, None] * across, sin * s.axis - cos * away, -slant])
    return columns, lambda p: Cone(s.apex + p[2:5], unit(s.axis + p[0] * x + p[1] * y), float(s.half_angle + p[5]), 1)


def _torus(s: Torus, points: Points) -> tuple[np.ndarray, Callable[[np.ndarray], Torus]]:
    """Differentiate the distance by (tilt x, tilt y, shift of the centre in space, ring radius, tube radius)."""
    height, distance, away = _split(points, s.centre, s.axis)
    across, x, y = _axes(s.axis, away)
    from_tube = np.maximum(np.hypot(distance - s.ring, height), np.finfo(float).tiny)
    out, up = (distance - s.ring) / from_tube, height / from_tube
    columns = np.column_stack(
        [(up * s.ring)[:, None] * across, -out[:, None] * away - up[:, None] * s.axis, -out, -np.ones(len(points))]
    )
    return columns, lambda p: Torus(
        s.centre + p[2:5], unit(s.axis + p[0] * x + p[1] * y), float(s.ring + p[5]), float(s.radius + p[6])
    )


_CHANGES = {Cylinder: _cylinder, Cone: _cone, Torus: _torus}
"""The function of each kind of surface that gives its derivatives and its change by a step."""
