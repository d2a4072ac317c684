"""Compute the area that two faces on the same surface share.

The triangles of a curved face are only chords of it, so they are first mapped to a chart of the surface: coordinates in
the plane, an unrolled cylinder or cone, or directions from the centre of a sphere. In a chart, a circle about the axis
is a straight line, and the same line for both faces, however each of them is tessellated.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.boxes import boxes_of, crossing
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.triangles import Triangles

Flat = Float[np.ndarray, "_ 3 2"]
"""Corners of triangles in a chart."""

_MAX_PAIRS = 50_000
"""Number of pairs of triangles intersected at once: bounds the memory."""

_PARALLEL_SINE = 1e-9
"""Sine of the angle between two edges below which they count as parallel, and their crossing is not computed."""

_MIN_COSINE = 0.1
"""Least cosine of the angle at the centre of a sphere between a pole and a corner in its tangent chart.

The projection has no image from 90 deg on. Triangles that are so far from each other do not overlap."""


@dataclass(frozen=True, eq=False)
class Overlap:
    """What two sets of triangles share in one chart."""

    area: float
    """Area of what is shared; 0 where only edges or corners touch."""
    centre: Float[np.ndarray, "d"]
    """Centroid of what is shared, in coordinates of the chart (d = 2), or in space (d = 3) for a sphere."""
    box: Float[np.ndarray, "2 d"]
    """Lowest and highest coordinates of what is shared, touching edges included."""

    @property
    def extent(self) -> float:
        """Length of the diagonal of `box`."""
        return float(np.linalg.norm(self.box[1] - self.box[0]))


def flat(triangles: Triangles, origin: Vector, x: Vector, y: Vector) -> Flat:
    """Project triangles onto a plane: coordinates from `origin` along the unit vectors `x` and `y`."""
    return np.stack([(triangles - origin) @ x, (triangles - origin) @ y], axis=-1)


def overlap(first: Flat, second: Flat, tolerance: float) -> Overlap | None:
    """Compute what two sets of triangles in one chart share; None if they are farther apart than `tolerance`, a length.

    Triangles of one set must not overlap each other.
    """
    pairs = crossing(boxes_of(first), boxes_of(second), tolerance)
    return _sum(*_intersections(first[pairs[:, 0]], second[pairs[:, 1]], tolerance))


def overlap_on_sphere(
    first: Triangles, second: Triangles, centre: Vector, radius: float, tolerance: float
) -> Overlap | None:
    """Compute what two sets of triangles on a sphere share; None if they are farther apart than `tolerance`, a length.

    Each pair of triangles is projected from the centre of the sphere onto the tangent plane at the middle of the first
    one (gnomonic projection), where great circles are straight lines.
    """
    a, b = _directions(first, centre), _directions(second, centre)
    pairs = crossing(_bulging_boxes(a), _bulging_boxes(b), tolerance / radius)
    a, b = a[pairs[:, 0]], b[pairs[:, 1]]
    pole = _directions(a.mean(axis=1), 0.0)
    x = _directions(np.cross(pole, np.eye(3)[np.argmin(np.abs(pole), axis=-1)]), 0.0)
    axes = np.stack([x, np.cross(pole, x), pole], axis=-1)
    a, b = a @ axes, b @ axes
    ahead = (a[..., 2] > _MIN_COSINE).all(axis=1) & (b[..., 2] > _MIN_COSINE).all(axis=1)
    a, b, axes = a[ahead], b[ahead], axes[ahead]
    charts = radius * a[..., :2] / a[..., 2:], radius * b[..., :2] / b[..., 2:]
    areas, middles, corners, shared = _intersections(*charts, tolerance)
    # area on the sphere = cos^3(angle) x area in the tangent plane, with tan(angle) = distance from the pole / radius
    areas = areas * (1 + np.sum(middles**2, axis=-1) / radius**2) ** -1.5

    def lifted(points: np.ndarray) -> np.ndarray:
        """Project points (pairs, _, 2) of the tangent planes back to the sphere, in world coordinates."""
        points = np.concatenate([points, np.full((*points.shape[:-1], 1), radius)], axis=-1)
        return radius * _directions(points, 0.0) @ np.swapaxes(axes, 1, 2) + centre

    return _sum(areas, lifted(middles[:, None])[:, 0], lifted(corners), shared)


def _bulging_boxes(triangles: Triangles) -> Float[np.ndarray, "triangles 2 3"]:
    """Compute boxes around the parts of the unit sphere over triangles with corners on it.

    A triangle lies in a circle of its longest edge over sqrt(3) (Jung 1901), over which the sphere bulges by its
    sagitta. One long triangle so widens its own box, and not those of thousands of others.
    """
    longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=-1).max(axis=1)
    bulge = 1 - np.sqrt(np.maximum(1 - longest**2 / 3, 0.0))
    return boxes_of(triangles) + bulge[:, None, None] * np.array([[-1.0], [1.0]])


class _Shared(NamedTuple):
    """The convex polygon that the two triangles of each pair share.

    Its corners are the corners of either triangle that lie in the other (6 candidates), and the points where two edges
    cross (9 candidates).
    """

    areas: np.ndarray
    """(pairs,): areas of the polygons."""
    middles: np.ndarray
    """(pairs, 2): centroids of the polygons."""
    corners: np.ndarray
    """(pairs, 15, 2): the candidates for corners."""
    chosen: np.ndarray
    """(pairs, 15): which candidates are corners."""


def _intersections(a: Flat, b: Flat, tolerance: float) -> _Shared:
    """Intersect triangle k of `a` with triangle k of `b`, for all k."""
    if len(a) > _MAX_PAIRS:
        halves = zip(np.array_split(a, 2), np.array_split(b, 2), strict=True)
        results = [_intersections(half_a, half_b, tolerance) for half_a, half_b in halves]
        return _Shared(*(np.concatenate(parts) for parts in zip(*results, strict=True)))
    a, b = _anticlockwise(a), _anticlockwise(b)
    edges_a, edges_b = np.roll(a, -1, axis=1) - a, np.roll(b, -1, axis=1) - b
    start = b[:, None] - a[:, :, None]  # pair, edge of a, edge of b
    turn = _cross(edges_a[:, :, None], edges_b[:, None])
    # parallel edges have no crossing; where they overlap, the end points are corners of one triangle in the other
    length = np.linalg.norm(edges_a, axis=-1)[:, :, None] * np.linalg.norm(edges_b, axis=-1)[:, None]
    parallel = np.abs(turn) <= _PARALLEL_SINE * length
    turn = np.where(parallel, 1.0, turn)
    s, t = _cross(start, edges_b[:, None]) / turn, _cross(start, edges_a[:, :, None]) / turn
    meet = ~parallel & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    crossings = a[:, :, None] + np.where(meet, s, 0.0)[..., None] * edges_a[:, :, None]
    corners = np.concatenate([a, b, crossings.reshape(-1, 9, 2)], axis=1)
    shared = np.concatenate(
        [_inside(a, b, edges_b, tolerance), _inside(b, a, edges_a, tolerance), meet.reshape(-1, 9)], 1
    )

    middle, rim = _rims(corners, shared)
    following = np.roll(rim, -1, axis=1)
    sectors = _cross(rim, following) / 2
    areas = sectors.sum(axis=1)
    moments = np.einsum("nk,nki->ni", sectors, rim + following) / 3
    safe = np.where(areas > 0, areas, 1.0)[:, None]
    return _Shared(areas, middle + np.where(areas[:, None] > 0, moments / safe, 0.0), corners, shared)


def _rims(corners: np.ndarray, shared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sort the corners of convex polygons anticlockwise.

    `corners` (pairs, 15, 2) are candidates, of which `shared` (pairs, 15) marks the corners. Returns their means
    (pairs, 2), and the corners relative to these (pairs, 15, 2), the first one repeated in place of the other
    candidates, which adds no area.
    """
    count = np.maximum(shared.sum(axis=1), 1)
    middle = np.einsum("nk,nki->ni", shared, corners) / count[:, None]
    spokes = np.where(shared[..., None], corners - middle[:, None], 0.0)
    order = np.argsort(np.where(shared, np.arctan2(spokes[..., 1], spokes[..., 0]), np.inf), axis=1)
    rim = np.take_along_axis(spokes, order[..., None], axis=1)
    last = np.arange(15) >= count[:, None]
    return middle, np.where(last[..., None], rim[:, :1], rim)


def shared_triangles(first: Flat, second: Flat, tolerance: float) -> Flat:
    """Divide what two sets of triangles in one chart share into triangles, for drawing."""
    pairs = crossing(boxes_of(first), boxes_of(second), tolerance)
    _, _, corners, shared = _intersections(first[pairs[:, 0]], second[pairs[:, 1]], tolerance)
    middle, rim = _rims(corners, shared)
    fans = np.stack([np.zeros_like(rim), rim, np.roll(rim, -1, axis=1)], axis=2) + middle[:, None, None]
    fans = fans.reshape(-1, 3, 2)
    return fans[np.abs(_cross(fans[:, 1] - fans[:, 0], fans[:, 2] - fans[:, 0])) > tolerance**2]


def _inside(points: Flat, triangles: Flat, edges: Flat, tolerance: float) -> np.ndarray:
    """Mark the corners of `points` that lie in the triangle of the same number, or beyond its edges by `tolerance`.

    The triangles are anticlockwise, `edges` are the vectors along their sides; returns a mask (pairs, 3).
    """
    left = _cross(edges[:, None], points[:, :, None] - triangles[:, None])
    return np.all(left >= -tolerance * np.linalg.norm(edges, axis=-1)[:, None], axis=-1)


def _sum(areas: np.ndarray, middles: np.ndarray, corners: np.ndarray, shared: np.ndarray) -> Overlap | None:
    """Add up the polygons of all pairs; None where there is none."""
    if not shared.any():
        return None
    points, total = corners[shared], float(areas.sum())
    centre = areas @ middles / total if total > 0 else points.mean(axis=0)
    return Overlap(total, centre, np.stack([points.min(axis=0), points.max(axis=0)]))


def _anticlockwise(triangles: Flat) -> Flat:
    """Reverse the triangles whose corners run clockwise."""
    clockwise = _cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) < 0
    return np.where(clockwise[:, None, None], triangles[:, ::-1], triangles)


def _cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Compute the cross product of plane vectors (..., 2), a number each."""
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _directions(points: np.ndarray, centre: Vector | float) -> np.ndarray:
    """Compute the unit vectors from a centre to points (..., 3)."""
    offset = points - centre
    return offset / np.linalg.norm(offset, axis=-1, keepdims=True)
