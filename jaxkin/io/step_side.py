"""On which side of a face the material is, from the triangles of the whole solid by the even-odd rule.

The orientation of faces in a file can be wrong, and a tessellation can be wound inwards or cover a hole (a ball trimmed
across the seam of its sphere comes out so). A ray that leaves the solid crosses an even number of faces all the same.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Points
from jaxkin.geometry.surfaces import Surface

Triangles = Float[np.ndarray, "_ 3 3"]


def winding(surface: Surface, triangles: Triangles) -> float:
    """How the triangles of a face are wound: +1 all out of the material of `surface`, -1 all into it."""
    along = np.sum(areas(triangles) * surface.normals(triangles.mean(axis=1)), axis=-1)
    return float(along.sum() / max(np.abs(along).sum(), np.finfo(float).tiny))


def points_outwards(surface: Surface, triangles: Triangles, solid: Triangles) -> bool:
    """Whether the normals of the surface point out of the solid: most of nine rays that leave a face."""
    largest = np.argsort(-np.linalg.norm(areas(triangles), axis=-1))[:3]
    votes = []
    tilts = np.random.default_rng(0).normal(size=(3, 3))
    for corners in triangles[largest]:
        start = corners.mean(axis=0)
        normal = surface.normals(start)
        others = solid[~np.all(solid == corners, axis=(1, 2))]
        votes += [_crossings(start, normal + 0.3 * tilt, others) % 2 == 0 for tilt in tilts]
    return sum(votes) > len(votes) / 2


def _crossings(start: Points, direction: Points, triangles: Triangles) -> int:
    """How many triangles a ray goes through (Moeller and Trumbore)."""
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


def areas(triangles: Triangles) -> Points:
    """Twice the area of each triangle, as a vector along the normal that its winding gives it."""
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
