"""Fit a plane, cylinder, cone, sphere or torus to points with normals.

It serves faces that a file holds only as splines or triangles. The corners of a tessellation lie on the true surface,
so the fitted surface must pass through all of them within their rounding. The normals decide only between the kinds of
surface, and give the first guess.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Points, Vector, perpendicular
from jaxkin.geometry.refine import refined
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere, Surface
from jaxkin.geometry.torus import Torus

_AXIS_ALLOWANCE = 0.1
"""Largest angle, radians, by which a few wrong normals are taken to tilt the axis that is guessed from all normals."""

_MIN_ALIGNED = 0.9
"""Smallest share of points at which the normal of the surface must agree with that given, since the apex of a cone and
the pole of a spline have no normal of their own."""

_APEX_DISTANCES = (1.5, 4.0)
"""Distances of the apex of a cone from the middle of its points, in units of their half extent, that are guessed.

From one of these, the fit finds cones with 0.5 to 20 in the chamfers of nuts."""


def rounding(points: Points) -> float:
    """Estimate how far points that went through float32 lie from their surface: a length.

    Rounding is relative to the extent of the points and to their distance from the origin.
    """
    points = points.reshape(-1, 3)
    return max(1e-6 * float(np.linalg.norm(np.ptp(points, axis=0))), 3e-7 * float(np.abs(points).max()))


def flipped(surface: Surface) -> Surface:
    """Return a surface with the material on its other side."""
    if isinstance(surface, Plane):
        return replace(surface, normal=-surface.normal)
    return replace(surface, side=-surface.side)


def fit_surface(
    points: Float[np.ndarray, "n 3"],
    normals: Float[np.ndarray, "n 3"],
    tolerance: float,
    angle: float,
    *,
    thorough: bool = False,
) -> Surface | None:
    """Find the simplest of plane, cylinder, cone, sphere that all points lie on within `tolerance` (a length).

    `normals` are unit vectors out of the material at the points. A surface whose own normals deviate from them by more
    than `angle` (radians) is rejected: it passes through the points by chance. With `thorough`, cones are also fitted
    from guesses that do not need the normals, which are wrong on a narrow strip. Returns None where no surface fits, or
    where there are too few points to tell.
    """
    points, first = np.unique(points, axis=0, return_index=True)
    normals = normals[first]
    centre = points.mean(axis=0)
    scale = float(np.abs(points - centre).max()) or 1.0
    for candidate in _candidates((points - centre) / scale, normals, angle, thorough):
        surface = _scaled(candidate, centre, scale)
        surface = surface if np.sum(surface.normals(points) * normals) >= 0 else flipped(surface)
        if np.abs(surface.distance(points)).max() <= tolerance:
            aligned = np.sum(surface.normals(points) * normals, axis=-1) >= np.cos(angle)
            if np.mean(aligned) > _MIN_ALIGNED:
                return surface
    return None


def _candidates(points: Points, normals: Points, angle: float, thorough: bool) -> Iterator[Surface]:
    """Fit each kind of surface that the normals allow, the simplest first, to points with mean 0 and largest entry 1.

    A kind is tried only with enough points: for curved surfaces at least one more than the surface has parameters.
    """
    for min_points, fit in ((3, _plane), (6, _cylinder), (7, _cone), (5, _sphere)):
        if len(points) >= min_points:
            surface = fit(points, normals, angle)
            if surface is not None:
                yield surface
        if fit is _cone and thorough and len(points) >= min_points:
            yield from _cones(points, normals)


def _plane(points: Points, normals: Points, angle: float) -> Plane:
    """Fit a plane through the origin: its normal is the direction of least spread of the points."""
    normal = np.linalg.svd(points, full_matrices=False)[2][2]
    return Plane(np.zeros(3), normal)


def _cylinder(points: Points, normals: Points, angle: float) -> Cylinder | None:
    """Fit a cylinder; None where the normals, up to `angle` (radians), are not perpendicular to one axis."""
    axis = np.linalg.eigh(normals.T @ normals)[1][:, 0]
    if np.median(np.abs(normals @ axis)) > angle + _AXIS_ALLOWANCE:
        return None
    x = perpendicular(axis)
    y = np.cross(axis, x)
    flat = points @ np.stack([x, y], axis=-1)
    middle, radius = _ball(flat)
    return refined(Cylinder(middle[0] * x + middle[1] * y, axis, radius, 1), points)


def _cone(points: Points, normals: Points, angle: float) -> Cone | None:
    """Fit a cone; None where the normals, up to `angle` (radians), are not at one angle to one axis."""
    spread = normals - normals.mean(axis=0)
    axis = np.linalg.eigh(spread.T @ spread)[1][:, 0]
    if np.median(np.abs(spread @ axis)) > angle + _AXIS_ALLOWANCE:
        return None
    # all tangent planes go through the apex: n . apex = n . p
    apex, _, rank, _ = np.linalg.lstsq(normals, np.sum(normals * points, axis=-1), rcond=1e-6)
    if rank < 3:
        return None
    axis = axis if float((points.mean(axis=0) - apex) @ axis) > 0 else -axis
    half_angle = np.arcsin(np.clip(abs(float(normals.mean(axis=0) @ axis)), 0.0, 1.0))
    found = refined(Cone(apex, axis, float(half_angle), 1), points)
    return found if 0 < found.half_angle < np.pi / 2 else None


def _cones(points: Points, normals: Points) -> Iterator[Cone]:
    """Fit cones whose rulings are first taken along the axis of the cylinder that fits best.

    The apex may be at either end of the rulings, and at any distance: `_APEX_DISTANCES` are tried.
    """
    along = np.linalg.eigh(normals.T @ normals)[1][:, 0]
    x = perpendicular(along)
    flat = np.stack([x, np.cross(along, x)], axis=-1)
    middle, radius = _ball(points @ flat)
    cylinder = refined(Cylinder(flat @ middle, along, radius, 1), points)
    foot = cylinder.point - (cylinder.point @ cylinder.axis) * cylinder.axis
    distance = float(np.linalg.norm(foot))
    if not 0 < distance < np.inf or not 0 < cylinder.radius < np.inf:
        return
    away = -foot / distance  # from the axis of the cylinder to the points, whose mean is the origin
    for height, end in product(_APEX_DISTANCES, (1, -1)):
        ruling = end * cylinder.axis
        half_angle = float(np.arctan2(cylinder.radius, height))
        apex = foot + cylinder.radius * away - height * ruling
        found = refined(Cone(apex, np.cos(half_angle) * ruling - np.sin(half_angle) * away, half_angle, 1), points)
        if 0 < found.half_angle < np.pi / 2 and np.mean((points - found.apex) @ found.axis > 0) > _MIN_ALIGNED:
            yield found


def _sphere(points: Points, normals: Points, angle: float) -> Sphere:
    """Fit a sphere; `normals` and `angle` are not needed."""
    centre, radius = _ball(points)
    return Sphere(centre, radius, 1)


def _ball(points: Float[np.ndarray, "n d"]) -> tuple[Float[np.ndarray, "d"], float]:
    """Fit a circle (d = 2) or sphere (d = 3): 2 p . c + (r^2 - c . c) = p . p is linear in c and r^2 - c . c."""
    columns = np.column_stack([2 * points, np.ones(len(points))])
    *centre, rest = np.linalg.lstsq(columns, np.sum(points**2, axis=-1), rcond=None)[0]
    return np.array(centre), float(np.sqrt(max(rest + np.dot(centre, centre), 0.0)))


def _scaled(surface: Surface, centre: Vector, scale: float) -> Surface:
    """Scale a surface about the origin, then translate it by `centre`; the material is inside of the result."""
    match surface:
        case Plane():
            return Plane(centre + scale * surface.point, surface.normal)
        case Cylinder():
            return Cylinder(centre + scale * surface.point, surface.axis, scale * surface.radius, 1)
        case Cone():
            return Cone(centre + scale * surface.apex, surface.axis, surface.half_angle, 1)
        case Sphere():
            return Sphere(centre + scale * surface.centre, scale * surface.radius, 1)


def fit_torus(points: Float[np.ndarray, "n 3"], normals: Float[np.ndarray, "n 3"], tolerance: float) -> Torus | None:
    """Find the torus that all points lie on within `tolerance` (a length); None if there is none.

    `normals` are unit vectors at the points. All normals of a surface of revolution meet its axis, which is a linear
    condition on the Pluecker coordinates (direction a, moment m) of the axis: (p x n) . a + n . m = 0.
    """
    if len(points) < 10:
        return None
    middle = points.mean(axis=0)
    scale = float(np.abs(points - middle).max()) or 1.0
    local = (points - middle) / scale
    line = np.linalg.svd(np.concatenate([np.cross(local, normals), normals], axis=-1), full_matrices=False)[2][5]
    if np.linalg.norm(line[:3]) < 1e-3 * np.linalg.norm(line[3:]):
        return None  # the axis is at infinity, as for a cylinder
    line = line / np.linalg.norm(line[:3])
    axis, moment = line[:3], line[3:]
    foot = np.cross(axis, moment)
    offset = local - foot
    height = offset @ axis
    distance = np.linalg.norm(offset - height[:, None] * axis, axis=-1)
    # the section is a circle: 2 u a + 2 v b + c = u^2 + v^2
    columns = np.stack([2 * distance, 2 * height, np.ones(len(points))], axis=-1)
    (ring, along, rest), _, rank, _ = np.linalg.lstsq(columns, distance**2 + height**2, rcond=None)
    square = rest + ring**2 + along**2
    if rank < 3 or square <= 0 or ring <= 0:
        return None
    found = refined(Torus(foot + along * axis, axis, float(ring), float(np.sqrt(square))), local)
    if np.abs(found.distance(local)).max() > tolerance / scale or found.ring <= 0 or found.radius > 50:
        return None
    return Torus(middle + scale * found.centre, found.axis, scale * found.ring, scale * found.radius)
