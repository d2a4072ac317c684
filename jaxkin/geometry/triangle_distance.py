"""Measure distances between triangles and points in space, many pairs at once, compiled, in float64.

All functions take arrays of numpy with the pairs as first axis. They are evaluated in batches of few sizes, so that
each is compiled a few times only. What is compiled has the coordinates as first axis and the pairs as last one: every
operation is then one of long rows.
"""

from __future__ import annotations

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry.triangles import Triangles

Points = Float[np.ndarray, "_ 3"]

_BATCHES = (1 << 11, 1 << 8)
"""Pairs that are evaluated at once, each size compiled once: intermediate results of the larger, some 300 numbers a
pair, stay near a core, and fewer than the smaller take no less time. The distance of 32768 pairs at once took twice as
long as that of 2048, each."""
_FEW = 1 << 9
"""Pairs of boxes that are measured at first where the least of many distances is looked for."""
_MANY = 1 << 15
"""The most of them at once."""
_PARALLEL = 1e-24
"""Square of the sine of an angle below which two segments count as parallel, far below any angle of a solid."""
_SHIFT = 1e-5
"""Share of the distance of two triangles by which one is shifted to tell the direction from the other."""
_DIRECTION = 1e-9
"""Sine of an angle below which two edges have no common normal: the rounding of its components is still 1e-7 of it."""


def triangle_distances(first: Triangles, second: Triangles) -> Float[np.ndarray, " _"]:
    """Measure the distance of each triangle of one list to the one at its place in the other; 0 where they cross."""
    return _in_batches(_triangle_distance, first, second)


def directions(first: Triangles, second: Triangles) -> Points:
    """Find the unit direction from each triangle of one list to the one at its place in the other; 0 if they touch.

    It is the gradient of their distance by a shift of the second one, by differences: nearly so.
    """
    apart = triangle_distances(first, second)
    step = _SHIFT * apart
    moved = [triangle_distances(first, second + axis * step[:, None, None]) for axis in np.eye(3)]
    found = np.stack(moved, axis=-1) - apart[:, None]
    length = np.linalg.norm(found, axis=1, keepdims=True)
    return np.where(length > 0, found / np.where(length > 0, length, 1.0), 0.0)


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


def _in_batches(function: Callable, *arrays: np.ndarray):
    """Evaluate a compiled function of arrays, piece by piece, in float64; the last piece is filled with zeros."""
    count, start, found = len(arrays[0]), 0, []
    with jax.enable_x64(True):
        while start < count or not found:
            size = next((size for size in _BATCHES if size <= count - start), _BATCHES[-1])
            length = min(size, count - start)
            pieces = [np.zeros((*array.shape[:0:-1], size)) for array in arrays]
            for piece, array in zip(pieces, arrays, strict=True):
                piece[..., :length] = array[start : start + length].T
            result = function(*pieces)
            found.append(jax.tree.map(lambda each, length=length: np.asarray(each)[..., :length], result))
            start += size
    return jax.tree.map(lambda *pieces: np.concatenate(pieces, axis=-1).T, *found)


# Vectors are (3, ..., pairs), triangles (3, corners, pairs).


def _dot(a: Array, b: Array) -> Array:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Array, b: Array) -> Array:
    return jnp.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _edges(triangle: Array) -> Array:
    """Compute the vectors from each corner to the next."""
    return jnp.roll(triangle, -1, axis=1) - triangle


def _point_segment(point: Array, start: Array, edge: Array) -> Array:
    """Compute the square of the distance of a point to a segment from `start` to `start + edge`."""
    square = _dot(edge, edge)
    along = jnp.clip(_dot(point - start, edge) / jnp.where(square > 0, square, 1.0), 0.0, 1.0)
    off = point - start - along * edge
    return _dot(off, off)


def _point_triangle(points: Array, triangle: Array) -> Array:
    """Compute the squares of the distances of points, (3, points, pairs), to a triangle: to its plane where the foot is
    inside, else to an edge."""
    edges = _edges(triangle)
    normal = _cross(edges[:, 0], edges[:, 1])
    square = _dot(normal, normal)
    off = points[:, :, None] - triangle[:, None]
    inside = jnp.all(_dot(_cross(normal[:, None], edges)[:, None], off) >= 0, axis=1) & (square > 0)
    height = _dot(off[:, :, 0], normal[:, None]) ** 2 / jnp.where(square > 0, square, 1.0)
    to_edges = jnp.min(_point_segment(points[:, :, None], triangle[:, None], edges[:, None]), axis=1)
    return jnp.where(inside, height, to_edges)


def _segments(p: Array, d: Array, q: Array, e: Array) -> Array:
    """Compute the square of the distance of the segments p + s d and q + t e, where the common perpendicular meets
    both.

    Infinite where it does not: then the nearest point of one of them is one of its ends.
    """
    a, b, c, off = _dot(d, d), _dot(d, e), _dot(e, e), q - p
    square = a * c - b * b
    skew = square > _PARALLEL * a * c
    over = jnp.where(skew, square, 1.0)
    s = (_dot(off, d) * c - _dot(off, e) * b) / over
    t = (_dot(off, d) * b - _dot(off, e) * a) / over
    inside = skew & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    gap = off + t * e - s * d
    return jnp.where(inside, _dot(gap, gap), jnp.inf)


@jax.jit
def _edge_places(one: Array, other: Array) -> Array:
    edges = _edges(other)
    normal = _cross(edges[:, 0], edges[:, 1])
    height = _dot(one - other[:, :1], normal[:, None])
    height2 = jnp.roll(height, -1, axis=0)
    opposite = height * height2 < 0
    place = height / jnp.where(opposite, height - height2, 1.0)
    off = (one + place * _edges(one))[:, :, None] - other[:, None]
    inside = jnp.all(_dot(_cross(normal[:, None], edges)[:, None], off) >= 0, axis=1)
    return jnp.where(opposite & inside, place, jnp.nan)


def _pierces(one: Array, other: Array) -> Array:
    """Tell whether an edge of one triangle goes through another triangle."""
    return jnp.any(~jnp.isnan(_edge_places(one, other)), axis=0)


@jax.jit
def _triangle_distance(one: Array, other: Array) -> Array:
    edges1, edges2 = _edges(one), _edges(other)
    corners = jnp.min(jnp.concatenate([_point_triangle(one, other), _point_triangle(other, one)]), axis=0)
    between = _segments(one[:, :, None], edges1[:, :, None], other[:, None], edges2[:, None])
    square = jnp.minimum(corners, jnp.min(between, axis=(0, 1)))
    return jnp.where(_pierces(one, other) | _pierces(other, one), 0.0, jnp.sqrt(square))


@jax.jit
def _triangle_depth(one: Array, other: Array) -> Array:
    edges1, edges2 = _edges(one), _edges(other)
    normal1, normal2 = (_cross(edges[:, 0], edges[:, 1])[:, None] for edges in (edges1, edges2))
    across = _cross(edges1[:, :, None], edges2[:, None])
    across = across.reshape(3, 9, across.shape[-1])
    sides = [_cross(normal1, edges1), _cross(normal2, edges2)]
    directions = jnp.concatenate([normal1, normal2, *sides, across], axis=1)
    length = jnp.sqrt(_dot(directions, directions))
    size1, size2 = (jnp.sqrt(jnp.max(_dot(edges, edges), axis=0)) for edges in (edges1, edges2))
    scales = [size1**2, size2**2, *[size1**3] * 3, *[size2**3] * 3, *[size1 * size2] * 9]
    exists = length > _DIRECTION * jnp.stack(scales)
    directions = directions / jnp.where(exists, length, 1.0)
    along1, along2 = (_dot(directions[:, :, None], (each - one[:, :1])[:, None]) for each in (one, other))
    overlap = jnp.minimum(along1.max(axis=1) - along2.min(axis=1), along2.max(axis=1) - along1.min(axis=1))
    return jnp.min(jnp.where(exists, overlap, jnp.inf), axis=0)


@jax.jit
def _point_distance(point: Array, triangle: Array) -> tuple[Array, Array]:
    edges = _edges(triangle)
    normal = _cross(edges[:, 0], edges[:, 1])
    length = jnp.sqrt(_dot(normal, normal))
    height = _dot(point - triangle[:, 0], normal) / jnp.where(length > 0, length, 1.0)
    return jnp.sqrt(_point_triangle(point[:, None], triangle)[0]), height
