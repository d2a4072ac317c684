"""On which side of a face the material is, from the triangles of the whole solid by the even-odd rule.

The orientation of faces in a file can be wrong, and a tessellation can be wound inwards or cover a hole (a ball trimmed
across the seam of its sphere comes out so). A ray that leaves the solid crosses an even number of faces all the same.
"""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.pose import Points
from jaxkin.geometry.surfaces import Surface
from jaxkin.geometry.triangles import Triangles, double_areas

_ROUNDING = 1e-9
"""Of a squared distance: far above the rounding of float64 (1e-16), far below the size of any triangle."""


def winding(surface: Surface, triangles: Triangles) -> float:
    """Tell how the triangles of a face are wound: +1 all out of the material of `surface`, -1 all into it."""
    along = np.sum(double_areas(triangles) * surface.normals(triangles.mean(axis=1)), axis=-1)
    return float(along.sum() / max(np.abs(along).sum(), np.finfo(float).tiny))


def points_outwards(surface: Surface, triangles: Triangles, solid: Triangles) -> bool:
    """Tell whether the normals of the surface point out of the solid: most of nine rays that leave a face."""
    largest = np.argsort(-np.linalg.norm(double_areas(triangles), axis=-1))[:3]
    votes = []
    centres = solid.mean(axis=1)
    radii = np.max(np.sum((solid - centres[:, None]) ** 2, axis=-1), axis=-1)
    tilts = np.random.default_rng(0).normal(size=(3, 3))
    for corners in triangles[largest]:
        start = corners.mean(axis=0)
        normal = surface.normals(start)
        for direction in normal + 0.3 * tilts:
            near = solid[_near(start, direction, centres, radii)]
            others = near[~np.all(near == corners, axis=(1, 2))]
            votes.append(_crossings(start, direction, others) % 2 == 0)
    return sum(votes) > len(votes) / 2


def _near(start: Points, direction: Points, centres: Points, squared_radii: np.ndarray) -> np.ndarray:
    """Tell which balls around triangles a line comes near to: few of a solid, so that only these are intersected."""
    offset = centres - start
    squared = np.einsum("ij,ij->i", offset, offset)
    distance = squared - (offset @ direction) ** 2 / (direction @ direction)
    return distance <= squared_radii + _ROUNDING * squared


def _crossings(start: Points, direction: Points, triangles: Triangles) -> int:
    """Count how many triangles a ray goes through (Moeller and Trumbore)."""
    edge1, edge2 = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    across = np.cross(direction, edge2)
    det = np.sum(across * edge1, axis=-1)
    hit = det != 0
    edge1, edge2, across, det = edge1[hit], edge2[hit], across[hit], det[hit]
    offset = start - triangles[hit, 0]
    u = np.sum(across * offset, axis=-1) / det
    turned = np.cross(offset, edge1)
    v = turned @ direction / det
    ahead = np.sum(turned * edge2, axis=-1) / det
    return int(np.sum((u >= 0) & (v >= 0) & (u + v <= 1) & (ahead > 0)))
