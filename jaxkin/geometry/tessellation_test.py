"""Test whether triangles are a tessellation of a surface, or have their corners on it only by chance.

A few corners lie on many surfaces: the corners of two facets on some cylinder, those of two bands about an axis on some
torus. The triangles of a tessellation are nearly tangent to the surface, span about equal arcs, and have more corners
than the fit needs.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.geometry.facets import Facets, TriangleIndices
from jaxkin.geometry.fit import fit_surface, fit_torus
from jaxkin.geometry.surfaces import Cone, Plane, Sphere, Surface
from jaxkin.geometry.torus import Torus

CHORD_ANGLE = 0.36
"""Largest angle, radians, between a facet and its surface at the corners of the facet.

A little above pi / 9, the angle in a regular prism of nine sides: a prism with fewer sides is not taken for round."""

MAX_WIDTH_RATIO = 3.0
"""Largest ratio of the arcs that a facet and its neighbours on the same face span."""

_SHALLOW_DEPTH = 20.0
"""Largest depth under a surface, in units of `Facets.tolerance`, of a facet whose triangles differ in direction by no
more than rounding, and so were taken for one facet."""

MAX_FACET_CORNERS = 8
"""Largest number of corners of a facet on a ball or a torus; a facet with more is a flat face with a round rim."""

_MAX_FITTED_POINTS = 600
"""Largest number of points that a surface is fitted to, chosen at random; all points are then compared with it."""

_MIN_TANGENT = 0.9
"""Smallest share of the triangles that must be nearly tangent to the surface: some triangles at a rim are not."""

_APEX_DISTANCE = 20
"""Distance from the apex of a cone, in units of `Facets.tolerance`, up to which a corner has no normal to compare."""


def surface_of(
    mesh: Facets,
    rows: TriangleIndices,
    tolerance: float,
    *,
    one_facet: bool = False,
    torus: bool = False,
    thorough: bool = False,
) -> Surface | Torus | None:
    """Find the surface that the triangles `rows` are a tessellation of; None if there is none.

    `tolerance`, a length, is the largest distance of a corner from the surface. `one_facet` says that all triangles are
    of one facet; with `torus` a torus is tried too, after the other kinds; `thorough` is that of `fit_surface`.
    """
    corners = mesh.points[mesh.triangles[rows]].reshape(-1, 3)
    normals = mesh.normals[rows][:, None].repeat(3, 1) if one_facet else mesh.corner_normals(rows)
    _, first = np.unique(mesh.triangles[rows], return_index=True)
    some = (
        first
        if len(first) <= _MAX_FITTED_POINTS
        else np.random.default_rng(0).choice(first, _MAX_FITTED_POINTS, replace=False)
    )
    points, directions = corners[some], normals.reshape(-1, 3)[some]
    surface = fit_surface(points, directions, tolerance, CHORD_ANGLE, thorough=thorough)
    if surface is None and torus:
        surface = fit_torus(points, directions, tolerance)
    if surface is None or np.abs(surface.distance(corners)).max() > tolerance:
        return None
    if isinstance(surface, Plane):
        return surface if one_facet or np.all(tangent(mesh, surface, rows, CHORD_ANGLE)) else None
    sizes = _corner_counts(mesh, rows)
    # four rulings, or five points: any three rulings lie on some cylinder, any four points on some sphere
    if len(first) < 8 or len(sizes) < 3 or np.mean(tangent(mesh, surface, rows, CHORD_ANGLE)) <= _MIN_TANGENT:
        return None
    if isinstance(surface, Sphere | Torus) and sizes.max() > MAX_FACET_CORNERS and _cut(mesh, surface, rows, sizes):
        return None
    return None if isinstance(surface, Torus) and _rings(surface, corners[first], 4 * tolerance) < 4 else surface


def on(
    mesh: Facets, surface: Surface | Torus, rows: TriangleIndices, tolerance: float, angle: float
) -> Bool[np.ndarray, "_"]:
    """Mark the triangles `rows` that lie on a surface and are tangent to it.

    Their corners are within `tolerance` (a length) of the surface, and the angles there within `angle` (radians).
    """
    near = np.all(np.abs(surface.distance(mesh.points[mesh.triangles[rows]])) <= tolerance, axis=1)
    return near & tangent(mesh, surface, rows, angle)


def tangent(mesh: Facets, surface: Surface | Torus, rows: TriangleIndices, angle: float) -> Bool[np.ndarray, "_"]:
    """Mark the triangles `rows` that are tangent to a surface at all their corners, within `angle` (radians)."""
    return arcs(mesh, surface, rows) < angle


def arcs(mesh: Facets, surface: Surface | Torus, rows: TriangleIndices) -> Float[np.ndarray, "_"]:
    """Measure half the arc that each triangle spans: its largest angle (radians) to the surface at its corners."""
    corners = mesh.points[mesh.triangles[rows]]
    along = np.sum(surface.normals(corners) * mesh.normals[rows][:, None], axis=-1)
    if isinstance(surface, Torus):  # a torus does not say on which side of it the material is
        along = np.abs(along)
    if isinstance(surface, Cone):
        along[np.linalg.norm(corners - surface.apex, axis=-1) <= _APEX_DISTANCE * mesh.tolerance] = 1.0
    return np.arccos(np.clip(along.min(axis=1), -1.0, 1.0))


def _corner_counts(mesh: Facets, rows: TriangleIndices) -> np.ndarray:
    """Count the corners of each facet of the triangles `rows`, in the order of the facets."""
    facet = np.repeat(mesh.facet_of[rows], 3)
    _, count = np.unique(np.unique(np.stack([facet, mesh.triangles[rows].ravel()]), axis=1)[0], return_counts=True)
    return count


def _cut(mesh: Facets, surface: Sphere | Torus, rows: TriangleIndices, corners: np.ndarray) -> bool:
    """Check whether a facet with many corners is a flat that is cut into the surface, since it lies too deep under it.

    `corners` holds the number of corners of each facet. Facets of triangles merged by rounding are less deep.
    """
    facet = np.unique(mesh.facet_of[rows], return_inverse=True)[1]
    middles = mesh.points[mesh.triangles[rows]].mean(axis=1)
    return bool(
        np.any(np.abs(surface.distance(middles[corners[facet] > MAX_FACET_CORNERS])) > _SHALLOW_DEPTH * mesh.tolerance)
    )


def _rings(surface: Torus, points: np.ndarray, tolerance: float) -> int:
    """Count the circles about the axis of a torus on which points (_, 3) lie, up to four.

    Points on three circles or fewer prove nothing: any three circles about one axis lie on some torus. `tolerance`, a
    length, is the width of a circle.
    """
    offset = points - surface.centre
    height = offset @ surface.axis
    section = np.stack([np.linalg.norm(offset - height[:, None] * surface.axis, axis=-1), height], axis=-1)
    count = 0
    while len(section) and count < 4:
        section = section[np.linalg.norm(section - section[0], axis=-1) > tolerance]
        count += 1
    return count
