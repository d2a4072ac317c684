"""Measure distances between triangles and points in space, many pairs at once, in float64.

All functions take arrays with the pairs as first axis. What evaluates them, in pieces, has the coordinates as first
axis and the pairs as last one: every operation is then one of long rows.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.triangles import Triangles

Points = Float[np.ndarray, "_ 3"]
Gaps = list[tuple[np.ndarray, np.ndarray | np.bool_]]
"""Vectors (3, ..., pairs) that may join the nearest points of two figures, and which of them do join such points."""

_AT_ONCE = 1 << 10
"""Pairs that are evaluated at once: intermediate results, some 100 numbers a pair, stay near a core. To compile these
functions took 5 s of a processor; compiled they were three times as fast, and few searches measure enough for that."""
_FEW = 1 << 9
"""Pairs of boxes that are measured at first where the least of many distances is looked for."""
_MANY = 1 << 15
"""The most of them at once."""
_PARALLEL = 1e-24
"""Square of the sine of an angle below which two segments count as parallel, far below any angle of a solid."""
_DIRECTION = 1e-9
"""Sine of an angle below which two edges have no common normal: the rounding of its components is still 1e-7 of it."""


def triangle_distances(first: Triangles, second: Triangles) -> Float[np.ndarray, " _"]:
    """Measure the distance of each triangle of one list to the one at its place in the other; 0 where they cross."""
    return _in_batches(_triangle_distance, first, second)


def directions(first: Triangles, second: Triangles) -> Points:
    """Find the unit direction from each triangle of one list to the one at its place in the other; 0 if they touch."""
    return _in_batches(_direction, first, second)


def set_distance(first: Triangles, second: Triangles) -> float:
    """Measure the least distance of two sets of triangles; 0 where they cross.

    Pairs are tried by the distance of their bounding boxes, nearest first, until no box is nearer than a triangle.
    """
    low1, high1, low2, high2 = (ends(axis=1) for each in (first, second) for ends in (each.min, each.max))
    apart = np.maximum(low1[:, None] - high2[None], low2[None] - high1[:, None])
    bounds = np.linalg.norm(np.maximum(apart, 0.0), axis=-1).ravel()
    order = np.argsort(bounds, kind="stable")
    least, start, count = np.inf, 0, _FEW
    while start < len(order) and bounds[order[start]] < least:
        one, other = np.divmod(order[start : start + count], len(second))
        least = min(least, float(triangle_distances(first[one], second[other]).min()))
        start, count = start + count, min(4 * count, _MANY)
    return least


def point_distances(points: Points, triangles: Triangles) -> tuple[np.ndarray, np.ndarray]:
    """Measure for each point the distance to the triangle at its place, and the height over the plane of that triangle.

    Both are lengths (points,); the height is positive on the side from which the triangle is wound anticlockwise.
    """
    return _in_batches(_point_distance, points, triangles)


def triangle_depths(first: Triangles, second: Triangles) -> Float[np.ndarray, " _"]:
    """Measure how far each triangle of one list must move to be off the one at its place in the other; negative if off.

    The least overlap along the directions that can separate two triangles: their normals, the normals of their edges in
    their planes, and those that are perpendicular to an edge of each.
    """
    return _in_batches(_triangle_depth, first, second)


def edge_places(first: Triangles, second: Triangles) -> Float[np.ndarray, "_ 3"]:
    """Find where the edges of each triangle of one list go through the one at its place in the other.

    For the edge from corner k to the next, the place is its share of the edge, 0 to 1; NaN where it does not.
    """
    return _in_batches(_edge_places, first, second)


def _in_batches(function: Callable, *arrays: np.ndarray) -> Any:
    """Evaluate a function of arrays with the pairs last, piece by piece; its results have the pairs first."""
    found = []
    for start in range(0, max(1, len(arrays[0])), _AT_ONCE):
        pieces = [each[start : start + _AT_ONCE] for each in arrays]
        found.append(function(*(np.ascontiguousarray(np.transpose(each), float) for each in pieces)))
    if isinstance(found[0], tuple):
        return tuple(np.concatenate(each, axis=-1).T for each in zip(*found, strict=True))
    return np.concatenate(found, axis=-1).T


# Vectors are (3, ..., pairs), triangles (3, corners, pairs).


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _edges(triangle: np.ndarray) -> np.ndarray:
    """Compute the vectors from each corner to the next."""
    return np.roll(triangle, -1, axis=1) - triangle


def _from_segment(point: np.ndarray, start: np.ndarray, edge: np.ndarray) -> np.ndarray:
    """Compute the vector to a point from the nearest point of a segment from `start` to `start + edge`."""
    square = _dot(edge, edge)
    off = point - start
    along = np.clip(_dot(off, edge) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return off - along * edge


def _from_triangle(points: np.ndarray, triangle: np.ndarray) -> Gaps:
    """Compute the vectors to points, (3, points, pairs), from their feet in the plane of a triangle, which are near
    where they are inside, and from the nearest points of its edges."""
    edges = _edges(triangle)
    normal = _cross(edges[:, 0], edges[:, 1])
    square = _dot(normal, normal)
    off = points[:, :, None] - triangle[:, None]
    inside = np.all(_dot(_cross(normal[:, None], edges)[:, None], off) >= 0, axis=1) & (square > 0)
    height = _dot(off[:, :, 0], normal[:, None]) / np.where(square > 0, square, 1.0)
    to_edges = _from_segment(points[:, :, None], triangle[:, None], edges[:, None])
    return [(height * normal[:, None], inside), (to_edges, np.True_)]


def _between_segments(p: np.ndarray, d: np.ndarray, q: np.ndarray, e: np.ndarray) -> Gaps:
    """Compute the common perpendiculars of the segments p + s d and q + t e, which are near where they meet both.

    Where they do not, the nearest point of one of them is one of its ends.
    """
    a, b, c, off = _dot(d, d), _dot(d, e), _dot(e, e), q - p
    square = a * c - b * b
    skew = square > _PARALLEL * a * c
    over = np.where(skew, square, 1.0)
    along_d, along_e = _dot(off, d), _dot(off, e)
    s = (along_d * c - along_e * b) / over
    t = (along_d * b - along_e * a) / over
    inside = skew & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    return [(off + t * e - s * d, inside)]


def _gaps(one: np.ndarray, other: np.ndarray) -> Gaps:
    """Compute the vectors from a triangle to another one, of which the shortest joins their nearest points."""
    between = _between_segments(one[:, :, None], _edges(one)[:, :, None], other[:, None], _edges(other)[:, None])
    back = [(-gap, exists) for gap, exists in _from_triangle(one, other)]
    return [*back, *_from_triangle(other, one), *between]


def _edge_places(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    edges = _edges(other)
    normal = _cross(edges[:, 0], edges[:, 1])
    height = _dot(one - other[:, :1], normal[:, None])
    height2 = np.roll(height, -1, axis=0)
    opposite = height * height2 < 0
    place = height / np.where(opposite, height - height2, 1.0)
    off = (one + place * _edges(one))[:, :, None] - other[:, None]
    inside = np.all(_dot(_cross(normal[:, None], edges)[:, None], off) >= 0, axis=1)
    return np.where(opposite & inside, place, np.nan)


def _pierces(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Tell whether an edge of one triangle goes through another triangle."""
    edges = _edges(other)
    height = _dot(one - other[:, :1], _cross(edges[:, 0], edges[:, 1])[:, None])
    found = (height.min(axis=0) < 0) & (height.max(axis=0) > 0)
    (some,) = np.nonzero(found)
    found[some] = np.any(~np.isnan(_edge_places(one[..., some], other[..., some])), axis=0)
    return found


def _triangle_distance(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    square = np.full(one.shape[-1], np.inf)
    for gap, exists in _gaps(one, other):
        own = np.where(exists, _dot(gap, gap), np.inf)
        square = np.minimum(square, own.min(axis=tuple(range(own.ndim - 1))))
    return np.where(_pierces(one, other) | _pierces(other, one), 0.0, np.sqrt(square))


def _direction(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    gap, square = np.zeros((3, one.shape[-1])), np.full(one.shape[-1], np.inf)
    for gaps, exists in _gaps(one, other):
        for place in np.ndindex(gaps.shape[1:-1]):
            own = gaps[:, *place]
            length = np.where(np.broadcast_to(exists, gaps.shape[1:])[place], _dot(own, own), np.inf)
            gap, square = np.where(length < square, own, gap), np.minimum(length, square)
    length = np.sqrt(_dot(gap, gap))
    apart = (length > 0) & ~_pierces(one, other) & ~_pierces(other, one)
    return np.where(apart, gap / np.where(apart, length, 1.0), 0.0)


def _triangle_depth(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    edges1, edges2 = _edges(one), _edges(other)
    normal1, normal2 = (_cross(edges[:, 0], edges[:, 1])[:, None] for edges in (edges1, edges2))
    across = _cross(edges1[:, :, None], edges2[:, None])
    across = across.reshape(3, 9, across.shape[-1])
    sides = [_cross(normal1, edges1), _cross(normal2, edges2)]
    directions = np.concatenate([normal1, normal2, *sides, across], axis=1)
    length = np.sqrt(_dot(directions, directions))
    size1, size2 = (np.sqrt(np.max(_dot(edges, edges), axis=0)) for edges in (edges1, edges2))
    scales = [size1**2, size2**2, *[size1**3] * 3, *[size2**3] * 3, *[size1 * size2] * 9]
    exists = length > _DIRECTION * np.stack(scales)
    directions = directions / np.where(exists, length, 1.0)
    along1, along2 = (_dot(directions[:, :, None], (each - one[:, :1])[:, None]) for each in (one, other))
    overlap = np.minimum(along1.max(axis=1) - along2.min(axis=1), along2.max(axis=1) - along1.min(axis=1))
    return np.min(np.where(exists, overlap, np.inf), axis=0)


def _point_distance(point: np.ndarray, triangle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    edges = _edges(triangle)
    normal = _cross(edges[:, 0], edges[:, 1])
    length = np.sqrt(_dot(normal, normal))
    height = _dot(point - triangle[:, 0], normal) / np.where(length > 0, length, 1.0)
    (plane, inside), (to_edges, _) = _from_triangle(point[:, None], triangle)
    square = np.where(inside, _dot(plane, plane), _dot(to_edges, to_edges).min(axis=1))
    return np.sqrt(square[0]), height
