"""The area that two faces share, where they lie on one surface.

The triangles of a curved face are chords, so they are compared in the parameters of the surface: in the plane, unrolled
about an axis, or as directions from a centre. There two circles about the axis that are the same are the same lines,
whatever their tessellation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.boxes import boxes_of, crossing
from jaxkin.geometry.pose import Vector

Flat = Float[np.ndarray, "_ 3 2"]
Solid = Float[np.ndarray, "_ 3 3"]


@dataclass(frozen=True, eq=False)
class Overlap:
    """What two sets of triangles share in one chart."""

    area: float
    centre: Float[np.ndarray, "d"]
    """Centroid of the shared area, in coordinates of the chart."""
    box: Float[np.ndarray, "2 d"]
    """Lowest and highest coordinates of what is shared, touching edges included."""

    @property
    def extent(self) -> float:
        return float(np.linalg.norm(self.box[1] - self.box[0]))


def flat(triangles: Solid, origin: Vector, x: Vector, y: Vector) -> Flat:
    """Coordinates in a plane."""
    return np.stack([(triangles - origin) @ x, (triangles - origin) @ y], axis=-1)


def overlap(first: Flat, second: Flat, tolerance: float) -> Overlap | None:
    """What two sets of triangles in one chart share; None if they are farther apart than the tolerance."""
    pairs = crossing(boxes_of(first), boxes_of(second), tolerance)
    return _sum(*_intersections(first[pairs[:, 0]], second[pairs[:, 1]], tolerance))


def overlap_on_sphere(first: Solid, second: Solid, centre: Vector, radius: float, tolerance: float) -> Overlap | None:
    """What two sets of triangles share as seen from the centre of a sphere, in space.

    Each pair is compared in the tangent plane at the middle of its first triangle, where great circles are straight.
    """
    a, b = _directions(first, centre), _directions(second, centre)
    edge = max(float(np.linalg.norm(t - np.roll(t, 1, axis=1), axis=-1).max(initial=0.0)) for t in (a, b))
    pairs = crossing(boxes_of(a), boxes_of(b), tolerance / radius + edge**2 / 4)  # the sphere bulges over its chords
    a, b = a[pairs[:, 0]], b[pairs[:, 1]]
    pole = _directions(a.mean(axis=1), 0.0)
    x = _directions(np.cross(pole, np.eye(3)[np.argmin(np.abs(pole), axis=-1)]), 0.0)
    axes = np.stack([x, np.cross(pole, x), pole], axis=-1)
    a, b = a @ axes, b @ axes
    ahead = (a[..., 2] > 0.1).all(axis=1) & (b[..., 2] > 0.1).all(axis=1)  # the others lie half a sphere apart
    a, b, axes = a[ahead], b[ahead], axes[ahead]
    charts = radius * a[..., :2] / a[..., 2:], radius * b[..., :2] / b[..., 2:]
    areas, middles, corners, shared = _intersections(*charts, tolerance)
    areas = areas * (1 + np.sum(middles**2, axis=-1) / radius**2) ** -1.5  # the tangent plane shows too much

    def lifted(points: np.ndarray) -> np.ndarray:
        points = np.concatenate([points, np.full((*points.shape[:-1], 1), radius)], axis=-1)
        return radius * _directions(points, 0.0) @ np.swapaxes(axes, 1, 2) + centre

    return _sum(areas, lifted(middles[:, None])[:, 0], lifted(corners), shared)


class _Shared(NamedTuple):
    """What pairs of triangles share. The corners of it are those of either triangle that lie in the other, and the
    points where edges cross."""

    areas: np.ndarray
    middles: np.ndarray
    """Centroids."""
    corners: np.ndarray
    """15 candidates for its corners."""
    chosen: np.ndarray
    """Which of them are corners."""


def _intersections(a: Flat, b: Flat, tolerance: float) -> _Shared:
    """What pairs of triangles share, pair by pair."""
    if len(a) > 50_000:  # bounds the memory
        halves = zip(np.array_split(a, 2), np.array_split(b, 2), strict=True)
        results = [_intersections(half_a, half_b, tolerance) for half_a, half_b in halves]
        return _Shared(*(np.concatenate(parts) for parts in zip(*results, strict=True)))
    a, b = _anticlockwise(a), _anticlockwise(b)
    edges_a, edges_b = np.roll(a, -1, axis=1) - a, np.roll(b, -1, axis=1) - b
    start = b[:, None] - a[:, :, None]  # pair, edge of a, edge of b
    turn = _cross(edges_a[:, :, None], edges_b[:, None])
    # edges on one line do not cross: the corners of one triangle in the other say all about them
    length = np.linalg.norm(edges_a, axis=-1)[:, :, None] * np.linalg.norm(edges_b, axis=-1)[:, None]
    parallel = np.abs(turn) <= 1e-9 * length
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
    """The mean of the corners of each polygon, and from there its corners anticlockwise; what is none repeats one."""
    count = np.maximum(shared.sum(axis=1), 1)
    middle = np.einsum("nk,nki->ni", shared, corners) / count[:, None]
    spokes = np.where(shared[..., None], corners - middle[:, None], 0.0)
    order = np.argsort(np.where(shared, np.arctan2(spokes[..., 1], spokes[..., 0]), np.inf), axis=1)
    rim = np.take_along_axis(spokes, order[..., None], axis=1)
    last = np.arange(15) >= count[:, None]
    return middle, np.where(last[..., None], rim[:, :1], rim)  # what is no corner repeats the first and adds no area


def shared_triangles(first: Flat, second: Flat, tolerance: float) -> Flat:
    """What two sets of triangles in one chart share, as triangles: for drawing."""
    pairs = crossing(boxes_of(first), boxes_of(second), tolerance)
    _, _, corners, shared = _intersections(first[pairs[:, 0]], second[pairs[:, 1]], tolerance)
    middle, rim = _rims(corners, shared)
    fans = np.stack([np.zeros_like(rim), rim, np.roll(rim, -1, axis=1)], axis=2) + middle[:, None, None]
    fans = fans.reshape(-1, 3, 2)
    return fans[np.abs(_cross(fans[:, 1] - fans[:, 0], fans[:, 2] - fans[:, 0])) > tolerance**2]


def _inside(points: Flat, triangles: Flat, edges: Flat, tolerance: float) -> np.ndarray:
    """Which corners of one triangle lie in the other, anticlockwise one, or within the tolerance of an edge of it."""
    left = _cross(edges[:, None], points[:, :, None] - triangles[:, None])
    return np.all(left >= -tolerance * np.linalg.norm(edges, axis=-1)[:, None], axis=-1)


def _sum(areas: np.ndarray, middles: np.ndarray, corners: np.ndarray, shared: np.ndarray) -> Overlap | None:
    if not shared.any():
        return None
    points, total = corners[shared], float(areas.sum())
    centre = areas @ middles / total if total > 0 else points.mean(axis=0)
    return Overlap(total, centre, np.stack([points.min(axis=0), points.max(axis=0)]))


def _anticlockwise(triangles: Flat) -> Flat:
    clockwise = _cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) < 0
    return np.where(clockwise[:, None, None], triangles[:, ::-1], triangles)


def _cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _directions(points: np.ndarray, centre: Vector | float) -> np.ndarray:
    offset = points - centre
    return offset / np.linalg.norm(offset, axis=-1, keepdims=True)
