"""Hidden surfaces by a depth buffer: which triangle is in front at every pixel of an orthographic view.

Exact for parts that reach through each other's layers (a pin through a bar), where sorting parts or triangles by depth
is not; and without a window, a graphics card or a compiled dependency.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.triangles import double_areas

BATCH = 1 << 20
"""Pixels that are filled at once: bounds the memory, some tens of bytes each."""
ON_EDGE = 1e-6
"""Sine of the angle to the line of sight below which a triangle is seen edge-on: rounding of float32 corners."""


@dataclass(frozen=True, eq=False)
class Raster:
    """What is in front at every pixel; row 0 is the top of the picture."""

    triangle: Int[np.ndarray, "height width"]
    """Index of the triangle, -1 where there is none."""
    depth: Float[np.ndarray, "height width"]
    """z of the front triangle at the centre of the pixel, pixels towards the viewer; -inf where there is none."""


def rasterise(triangles: Float[np.ndarray, "triangles 3 3"], height: int, width: int) -> Raster:
    """Fill triangles given in pixels: x to the right, y downwards, z towards the viewer; the largest z is seen.

    A pixel belongs to a triangle that holds its centre. Both sides of a triangle are seen; a triangle seen edge-on
    is not drawn.
    """
    depth = np.full(height * width, -np.inf, np.float32)
    index = np.full(height * width, -1, np.int32)
    normal = normals(triangles)
    faces = np.flatnonzero(normal[:, 2] > ON_EDGE)
    if not len(faces):
        return Raster(index.reshape(height, width), depth.reshape(height, width))
    span_of, row, start, stop = _spans(triangles[faces], height, width)
    face = faces[span_of]
    slope = -normal[face, :2] / normal[face, 2:]
    offset = np.stack([start, row], axis=1) + 0.5 - triangles[face, 0, :2]
    first = triangles[face, 0, 2] + (slope * offset).sum(axis=1)  # depth at the first pixel of every span
    ends = np.cumsum(stop - start)
    total = int(ends[-1]) if len(ends) else 0
    for chunk in np.split(np.arange(len(face)), np.searchsorted(ends, np.arange(BATCH, total, BATCH))):
        span, column = _expand(start[chunk], stop[chunk])
        span = chunk[span]
        z = (first[span] + slope[span, 0] * (column - start[span])).astype(np.float32)
        pixel = row[span] * width + column
        np.maximum.at(depth, pixel, z)
        seen = depth[pixel] == z
        index[pixel[seen]] = face[span[seen]]
    return Raster(index.reshape(height, width), depth.reshape(height, width))


def normals(triangles: Float[np.ndarray, "triangles 3 3"]) -> Float[np.ndarray, "triangles 3"]:
    """Compute unit normals, turned towards the viewer (z >= 0); zero for a triangle without area."""
    cross = double_areas(triangles)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    return cross * np.where(cross[:, 2:] < 0, -1, 1) / np.where(length > 0, length, 1)


def _spans(triangles: np.ndarray, height: int, width: int) -> tuple[np.ndarray, ...]:
    """List the pixels of all triangles, row by row: triangle, row, first column, column after the last."""
    order = np.argsort(triangles[..., 1], axis=1)
    corners = np.take_along_axis(triangles, order[..., None], axis=1)
    first, last = np.clip(np.ceil(corners[:, [0, 2], 1] - 0.5), 0, height).astype(np.int64).T
    face, row = _expand(first, last)
    (x0, x1, x2), (y0, y1, y2) = corners[face, :, 0].T, corners[face, :, 1].T
    y = row + 0.5
    with np.errstate(divide="ignore", invalid="ignore"):  # of the two short sides only the one that meets y is used
        long = x0 + (y - y0) * (x2 - x0) / (y2 - y0)
        short = np.where(y < y1, x0 + (y - y0) * (x1 - x0) / (y1 - y0), x1 + (y - y1) * (x2 - x1) / (y2 - y1))
    ends = np.ceil(np.stack([np.minimum(long, short), np.maximum(long, short)]) - 0.5)
    start, stop = np.clip(ends, 0, width).astype(np.int64)
    some = stop > start
    return face[some], row[some], start[some], stop[some]


def _expand(starts: np.ndarray, stops: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """List all integers of many ranges: which range each is from, and the integer."""
    counts = np.maximum(stops - starts, 0)
    which = np.repeat(np.arange(len(counts)), counts)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts - starts, counts)
