"""Measure distances between triangles and points in space, many pairs at once, compiled, in float64.

All functions take arrays of numpy with the pairs as first axis. They are evaluated in batches of few sizes, so that
each is compiled a few times only.
"""

from __future__ import annotations

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

Triangles = Float[np.ndarray, "_ 3 3"]
"""Corners of triangles: [triangle, corner, coordinate]."""
Points = Float[np.ndarray, "_ 3"]

_BATCH = 1 << 15
"""Pairs that are evaluated at once: their intermediate results, some 300 numbers a pair, stay below 100 MB."""
_LEAST_BATCH = 1 << 9
"""Pairs of the smallest batch: fewer take no less time, and each size of batch is compiled once."""
_PARALLEL = 1e-24
"""Square of the sine of an angle below which two segments count as parallel, far below any angle of a solid."""


def triangle_distances(first: Triangles, second: Triangles) -> Float[np.ndarray, " _"]:
    """Measure the distance of each triangle of one list to the one at its place in the other; 0 where they cross."""
    return _in_batches(_triangle_distance, first, second)


def set_distance(first: Triangles, second: Triangles) -> float:
    """Measure the least distance of two sets of triangles; 0 where they cross.

    Pairs are tried by the distance of their bounding boxes, nearest first, until no box is nearer than a triangle.
    """
    low1, high1, low2, high2 = (ends(axis=1) for each in (first, second) for ends in (each.min, each.max))
    apart = np.maximum(low1[:, None] - high2[None], low2[None] - high1[:, None])
    bounds = np.linalg.norm(np.maximum(apart, 0.0), axis=-1).ravel()
    order = np.argsort(bounds, kind="stable")
    least, start, count = np.inf, 0, _LEAST_BATCH
    while start < len(order) and bounds[order[start]] < least:
        one, other = np.divmod(order[start : start + count], len(second))
        least = min(least, float(triangle_distances(first[one], second[other]).min()))
        start, count = start + count, min(4 * count, _BATCH)
    return least


def signed_distances(points: Points, triangles: Triangles) -> tuple[np.ndarray, np.ndarray]:
    """Measure how far points are from the surface of a solid, and find the nearest triangle of its surface.

    Returns lengths (points,), negative inside of the solid, and indices into `triangles`, which bound the solid and are
    wound outwards. A point is inside where the surface winds around it more than half: sum of solid angles > 2 pi,
    which small openings of the surface do not change.
    """
    if not len(points):
        return np.zeros(0), np.zeros(0, int)
    # copies of the last triangle make few sizes of array; they are never nearest before it, and wind around nothing
    count = max(16, 1 << (len(triangles) - 1).bit_length())
    flat = np.repeat(triangles[-1:, :1], 3, axis=1)
    padded = np.concatenate([triangles, np.broadcast_to(flat, (count - len(triangles), 3, 3))])
    squares, nearest, turns = _in_batches(
        _surface_at, points, fixed=(padded,), least=16, most=max(16, (1 << 19) // count)
    )
    return np.where(turns > 0.5, -1.0, 1.0) * np.sqrt(squares), np.minimum(nearest, len(triangles) - 1)


def triangles_cross(first: Triangles, second: Triangles, depths: Float[np.ndarray, " _"]) -> np.ndarray:
    """Check which triangles cross those at their place in the other list, by more than a depth (a length) each.

    Two triangles cross where an edge of one goes through the other. They do so by more than a depth where neither lies
    on one side of the plane of the other, up to that depth.
    """
    return _in_batches(_cross_deeper, first, second, depths)


def _in_batches(
    function: Callable, *arrays: np.ndarray, fixed: tuple = (), least: int = _LEAST_BATCH, most: int = _BATCH
):
    """Evaluate a compiled function of arrays, piece by piece, in float64; the last piece is filled with copies."""
    count, found = len(arrays[0]), []
    with jax.enable_x64(True):
        for start in range(0, max(count, 1), most):
            pieces = [np.asarray(array[start : start + most], float) for array in arrays]
            length = len(pieces[0])
            if not length:
                pieces, length = [np.zeros((1, *array.shape[1:])) for array in arrays], 0
            size = least
            while size < length:
                size *= 4
            size = min(size, most)
            filled = [piece[np.minimum(np.arange(size), len(piece) - 1)] for piece in pieces]
            result = function(*filled, *fixed)
            found.append(jax.tree.map(lambda each, length=length: np.asarray(each)[:length], result))
    return jax.tree.map(lambda *pieces: np.concatenate(pieces), *found)


def _dot(a: Array, b: Array) -> Array:
    return jnp.sum(a * b, axis=-1)


def _point_segment(point: Array, start: Array, edge: Array) -> Array:
    """Square of the distance of a point to a segment from `start` to `start + edge`."""
    square = _dot(edge, edge)
    along = jnp.clip(_dot(point - start, edge) / jnp.where(square > 0, square, 1.0), 0.0, 1.0)
    off = point - start - along[..., None] * edge
    return _dot(off, off)


def _point_triangle(point: Array, triangle: Array) -> Array:
    """Square of the distance of a point to a triangle: to its plane where the foot is inside, else to an edge."""
    edges = jnp.roll(triangle, -1, axis=-2) - triangle
    normal = jnp.cross(edges[..., 0, :], edges[..., 1, :])
    square = _dot(normal, normal)
    off = point[..., None, :] - triangle
    inside = jnp.all(_dot(jnp.cross(normal[..., None, :], edges), off) >= 0, axis=-1) & (square > 0)
    height = _dot(off[..., 0, :], normal) ** 2 / jnp.where(square > 0, square, 1.0)
    return jnp.where(inside, height, jnp.min(_point_segment(point[..., None, :], triangle, edges), axis=-1))


def _segments(p: Array, d: Array, q: Array, e: Array) -> Array:
    """Square of the distance of the segments p + s d and q + t e, where the common perpendicular meets both.

    Infinite where it does not: then the nearest point of one of them is one of its ends.
    """
    a, b, c, off = _dot(d, d), _dot(d, e), _dot(e, e), q - p
    square = a * c - b * b
    skew = square > _PARALLEL * a * c
    over = jnp.where(skew, square, 1.0)
    s = (_dot(off, d) * c - _dot(off, e) * b) / over
    t = (_dot(off, d) * b - _dot(off, e) * a) / over
    inside = skew & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    gap = off + t[..., None] * e - s[..., None] * d
    return jnp.where(inside, _dot(gap, gap), jnp.inf)


def _pierces(one: Array, other: Array) -> Array:
    """Whether an edge of one triangle goes through another triangle."""
    edges = jnp.roll(other, -1, axis=-2) - other
    normal = jnp.cross(edges[..., 0, :], edges[..., 1, :])
    height = _dot(one - other[..., :1, :], normal[..., None, :])
    height2 = jnp.roll(height, -1, axis=-1)
    opposite = height * height2 < 0
    part = height / jnp.where(opposite, height - height2, 1.0)
    points = one + part[..., None] * (jnp.roll(one, -1, axis=-2) - one)
    sides = jnp.cross(normal[..., None, :], edges)
    off = points[..., :, None, :] - other[..., None, :, :]
    inside = jnp.all(_dot(sides[..., None, :, :], off) >= 0, axis=-1)
    return jnp.any(opposite & inside, axis=-1)


@jax.jit
def _triangle_distance(one: Array, other: Array) -> Array:
    edges1, edges2 = jnp.roll(one, -1, axis=-2) - one, jnp.roll(other, -1, axis=-2) - other
    corners = jnp.minimum(
        jnp.min(_point_triangle(one, other[..., None, :, :]), axis=-1),
        jnp.min(_point_triangle(other, one[..., None, :, :]), axis=-1),
    )
    between = _segments(one[..., :, None, :], edges1[..., :, None, :], other[..., None, :, :], edges2[..., None, :, :])
    square = jnp.minimum(corners, jnp.min(between, axis=(-2, -1)))
    return jnp.where(_pierces(one, other) | _pierces(other, one), 0.0, jnp.sqrt(square))


def _straddles(one: Array, other: Array, depth: Array) -> Array:
    """Whether corners of one triangle are farther than a depth from the plane of the other, on both of its sides."""
    normal = jnp.cross(other[..., 1, :] - other[..., 0, :], other[..., 2, :] - other[..., 0, :])
    length = jnp.sqrt(_dot(normal, normal))
    height = _dot(one - other[..., :1, :], normal[..., None, :]) / jnp.where(length > 0, length, 1.0)[..., None]
    return (jnp.max(height, axis=-1) > depth) & (jnp.min(height, axis=-1) < -depth)


@jax.jit
def _cross_deeper(one: Array, other: Array, depth: Array) -> Array:
    deep = _straddles(one, other, depth) & _straddles(other, one, depth)
    return deep & (_pierces(one, other) | _pierces(other, one))


@jax.jit
def _surface_at(points: Array, triangles: Array) -> tuple[Array, Array, Array]:
    """Square of the distance to the nearest triangle, its index, and how often the triangles wind around each point."""
    squares = _point_triangle(points[:, None], triangles[None])
    a, b, c = jnp.moveaxis(triangles[None] - points[:, None, None], 2, 0)
    la, lb, lc = (jnp.sqrt(_dot(each, each)) for each in (a, b, c))
    # solid angle of a triangle: tan(omega / 2) = a . (b x c) / (|a||b||c| + (a . b)|c| + (b . c)|a| + (c . a)|b|)
    below = la * lb * lc + _dot(a, b) * lc + _dot(b, c) * la + _dot(c, a) * lb
    turns = jnp.sum(jnp.arctan2(_dot(a, jnp.cross(b, c)), below), axis=-1) / (2 * jnp.pi)
    return jnp.min(squares, axis=-1), jnp.argmin(squares, axis=-1), turns
