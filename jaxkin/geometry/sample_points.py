"""Choose points of a solid that tell whether it overlaps another one whose surface crosses its own nowhere.

Where two surfaces do not cross, a face of the one that is inside of the other is so as a whole, but for where it lies
on the other surface: a few points of each face tell. Where all faces lie on each other, points inside of the solid do.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.triangle_distance import Points
from jaxkin.geometry.triangles import Triangles, double_areas

_OF_FACE = 16
"""Triangles of a face of which points are taken, the largest ones: one would do but for faces that lie partly on the
other surface. Of 20,580 placements of solids of cubes, which share many planes, 4 missed 12 overlaps, 8 missed 3 and 16
none; for 361 poses of `benchmarks/clashes.py` without clearances 16 took 9 s in place of 8."""
_MAX_CORES = 8
"""Faces below which points inside are taken, the largest ones: each costs a ray through all triangles."""
_STARTS = 1e-7
"""Share of the size of a solid below which a ray is still where it starts: corners were moved by rounded
displacements."""


class SurfacePoints(NamedTuple):
    """Points of triangles: their middles, and middles of edges inside of a face."""

    points: Points
    triangle: Int[np.ndarray, " points"]
    """The triangle of each point."""


def surface_points(triangles: Triangles, labels: Int[np.ndarray, " triangles"]) -> SurfacePoints:
    """Take points of the largest triangles of each label."""
    area = np.linalg.norm(double_areas(triangles), axis=-1)
    order = np.lexsort((-area, labels))
    begin = np.flatnonzero(np.diff(labels[order], prepend=-1))
    rank = np.arange(len(order)) - np.repeat(begin, np.diff(begin, append=len(order)))
    chosen = order[rank < _OF_FACE]
    own, following = triangles[chosen], np.roll(triangles[chosen], -1, axis=1)
    longest = np.argmax(np.linalg.norm(following - own, axis=-1), axis=1)
    middles = ((own + following) / 2)[np.arange(len(chosen)), longest]
    # what two triangles of a face share is inside of it: half-way through a rectangle, and amid a disc
    _, first, shared = np.unique(
        np.column_stack([labels[chosen], middles]), axis=0, return_index=True, return_counts=True
    )
    first = first[shared > 1]
    return SurfacePoints(np.concatenate([own.mean(axis=1), middles[first]]), np.concatenate([chosen, chosen[first]]))


def core_points(triangles: Triangles, labels: Int[np.ndarray, " triangles"]) -> Points:
    """Take points inside of a solid, half-way through it below the largest triangle of each of the largest labels."""
    normals = double_areas(triangles)
    area = np.linalg.norm(normals, axis=-1)
    order = np.lexsort((-area, labels))
    largest = order[np.flatnonzero(np.diff(labels[order], prepend=-1))]
    largest = largest[np.argsort(-np.bincount(labels, area)[labels[largest]], kind="stable")][:_MAX_CORES]
    starts = triangles[largest].mean(axis=1)
    inwards = -normals[largest] / area[largest, None]
    nearest = _STARTS * float(np.ptp(triangles, axis=(0, 1)).max())
    found = []
    for start, direction in zip(starts, inwards, strict=True):
        through = _ray(triangles, start, direction)
        through = through[through > nearest]
        if len(through):
            found.append(start + direction * float(through.min()) / 2)
    return np.reshape(found, (-1, 3))


def _ray(triangles: Triangles, start: np.ndarray, direction: np.ndarray) -> Float[np.ndarray, " _"]:
    """Find where a ray goes through triangles: lengths along its unit direction."""
    edge1, edge2 = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    across = np.cross(direction, edge2)
    determinant = np.sum(edge1 * across, axis=-1)
    off = start - triangles[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):  # rays along a triangle go through it nowhere
        u = np.sum(off * across, axis=-1) / determinant
        turned = np.cross(off, edge1)
        v = (turned @ direction) / determinant
        place = np.sum(edge2 * turned, axis=-1) / determinant
    return np.compress((u >= 0) & (v >= 0) & (u <= 1 - v) & np.isfinite(place), place)
