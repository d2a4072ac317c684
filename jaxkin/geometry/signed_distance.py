"""The signed distance from a closed surface of triangles, sampled on a grid in a band about it."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.triangles import is_closed

BAND = 2.0
"""Steps of the grid from the surface up to which distances are found; beyond, and inside, they count as this many. The
corners of a cell through which the surface goes are at most sqrt(3) steps from it."""
LARGEST_EDGE = 6.0
"""Steps of the grid to which edges of triangles are cut before their boxes are filled: boxes of long slanted triangles
are mostly far from them."""
BLOCK = 2_000_000
"""Pairs of points and triangles that are held at once: some hundred megabytes."""
OFF_GRID = (0.5 - np.sqrt(2) / 7, 0.5 - np.sqrt(3) / 11)
"""Part of a step by which columns of points are beside what designers draw: a ray through an edge has no side."""


class Open(ValueError):
    """The surface is not closed."""


def signed_distance(
    triangles: Float[np.ndarray, "triangles 3 3"], step: float
) -> tuple[Float[np.ndarray, "x y z"], Float[np.ndarray, "3"]]:
    """Sample the distance from a surface, negative inside, on a grid of a step; returns it with the first point.

    Distances are exact within `BAND` steps and cut off beyond, so that those on the border are `BAND` steps. A point is
    inside where surfaces wind around it, so that solids that overlap count as one. Raises Open for an open surface.
    """
    from trimesh.remesh import subdivide_to_size

    if not is_closed(triangles):
        raise Open("the surface is not closed")
    low, high = triangles.reshape(-1, 3).min(axis=0), triangles.reshape(-1, 3).max(axis=0)
    first = low - (BAND + 1.0) * step + step * np.array([*OFF_GRID, 0.5])
    shape = tuple(np.ceil((high - first) / step + BAND + 2.0).astype(int).tolist())
    corners = (triangles - first) / step
    found = np.full(shape, BAND)
    cut = subdivide_to_size(corners.reshape(-1, 3), np.arange(len(corners) * 3).reshape(-1, 3), LARGEST_EDGE)
    small = np.asarray(cut[0])[np.asarray(cut[1])]
    lows = np.maximum(np.floor(small.min(axis=1) - BAND).astype(int), 0)
    counts = np.minimum(np.ceil(small.max(axis=1) + BAND).astype(int) + 1, shape) - lows
    sizes = counts.prod(axis=1)
    for chosen in _blocks(sizes, BLOCK):
        owners = np.repeat(chosen, sizes[chosen])
        within = np.arange(len(owners)) - np.repeat(np.cumsum(sizes[chosen]) - sizes[chosen], sizes[chosen])
        place = lows[owners] + _unravel(within, counts[owners])
        distances = _to_triangles(place.astype(float), small[owners])
        np.minimum.at(found, tuple(place.T), distances)
    return step * np.where(_inside(corners, shape), -found, found), first


def _blocks(sizes: np.ndarray, largest: int):
    """Yield indices in groups of about `largest` in all."""
    total = np.cumsum(sizes)
    start = 0
    while start < len(sizes):
        stop = max(start + 1, int(np.searchsorted(total, (total[start - 1] if start else 0) + largest)))
        yield np.arange(start, stop)
        start = stop


def _unravel(index: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """Split each index by a shape of its own."""
    rest, z = np.divmod(index, shape[:, 2])
    x, y = np.divmod(rest, shape[:, 1])
    return np.stack([x, y, z], axis=1)


def _to_triangles(points: Float[np.ndarray, "n 3"], triangles: Float[np.ndarray, "n 3 3"]) -> Float[np.ndarray, " n"]:
    """Measure how far each point is from its triangle: from the plane above it, else from the nearest edge."""
    nearest = np.full(len(points), np.inf)
    edges = np.roll(triangles, -1, axis=1) - triangles
    normals = np.cross(edges[:, 0], edges[:, 1])
    length = np.linalg.norm(normals, axis=1)
    above = length > 0
    for k in range(3):
        off, edge = points - triangles[:, k], edges[:, k]
        square = np.sum(edge**2, axis=1)
        along = np.clip(np.sum(off * edge, axis=1) / np.where(square > 0, square, 1.0), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(off - along[:, None] * edge, axis=1))
        above &= np.sum(np.cross(edge, off) * normals, axis=1) >= 0
    height = np.abs(np.sum((points - triangles[:, 0]) * normals, axis=1)) / np.where(length > 0, length, 1.0)
    return np.where(above, np.minimum(height, nearest), nearest)


def _inside(corners: Float[np.ndarray, "triangles 3 3"], shape: tuple[int, ...]) -> np.ndarray:
    """Count how often surfaces wind around each point, by the triangles above and below it; whether they do."""
    winding = np.zeros(shape, np.int32)
    flat = corners[:, :, :2]
    areas = _cross(flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0])
    kept = np.flatnonzero(areas != 0)
    lows = np.maximum(np.ceil(flat[kept].min(axis=1)).astype(int), 0)
    counts = np.maximum(np.floor(flat[kept].max(axis=1)).astype(int) + 1 - lows, 0)
    sizes = counts.prod(axis=1)
    for chosen in _blocks(sizes, BLOCK):
        owners = np.repeat(chosen, sizes[chosen])
        within = np.arange(len(owners)) - np.repeat(np.cumsum(sizes[chosen]) - sizes[chosen], sizes[chosen])
        column = lows[owners] + np.stack(np.divmod(within, counts[owners, 1]), axis=1)
        triangle, area = corners[kept[owners]], areas[kept[owners]]
        weights = []
        for k in range(3):
            one, other = triangle[:, (k + 1) % 3, :2] - column, triangle[:, (k + 2) % 3, :2] - column
            weights.append(_cross(one, other) / area)
        hit = np.all(np.stack(weights) > 0, axis=0)
        height = np.sum(np.stack(weights, axis=1) * triangle[:, :, 2], axis=1)[hit]
        # the points above a triangle that faces up are outside of it
        above = np.clip(np.ceil(height).astype(int), 0, shape[2] - 1)
        np.add.at(winding, (*column[hit].T, above), np.where(area[hit] > 0, -1, 1))
    winding = np.cumsum(winding, axis=2)
    if np.any(winding[:, :, -1]):
        raise Open("the surface is not closed")
    return winding > 0


def _cross(one: Float[np.ndarray, "n 2"], other: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, " n"]:
    """Compute the cross product of vectors in a plane."""
    return one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
