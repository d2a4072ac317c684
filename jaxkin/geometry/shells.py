"""Welded triangles as solids: closed, wound outwards, and each connected body by itself."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.components import components, grouped
from jaxkin.geometry.pose import Points
from jaxkin.geometry.weld import Corners, Welded

Rows = Int[np.ndarray, "_"]

_SIDE_SAMPLES = 200
"""Triangles at whose middles the sides are checked."""

_MAX_SOLID_ANGLES = 8_000_000
"""Bounds the time of that check."""


def open_loops(welded: Welded, tolerance: float) -> list[Points]:
    """The points of the holes of a surface: loops of edges without a partner that go round some area.

    Where two tessellations meet with corners in between, edges without a partner lie on each other and leave no hole.
    """
    edges = welded.open_edges
    if not len(edges):
        return []
    _, index = np.unique(edges, return_inverse=True)
    label = components(int(index.max()) + 1, index.reshape(-1, 2))[index.reshape(-1, 2)[:, 0]]
    start, end = welded.points[edges[:, 0]], welded.points[edges[:, 1]]
    found = []
    for k in range(int(label.max()) + 1):
        a, b = start[label == k], end[label == k]
        area = np.linalg.norm(np.cross(a - a[0], b - a[0]).sum(axis=0)) / 2
        if area > 2 * tolerance * np.linalg.norm(b - a, axis=-1).sum():
            found.append(a)
    return found


def shells(welded: Welded) -> list[Rows]:
    """The triangles of each closed surface, by their pairs."""
    return grouped(components(len(welded.triangles), welded.pairs))


def bodies(corners: Corners, surfaces: list[Rows]) -> list[Rows]:
    """Closed surfaces joined to bodies: each one that is wound inwards is a cavity of the smallest around it."""
    volumes = np.array([volume(corners[rows]) for rows in surfaces])
    outer = [k for k in np.argsort(volumes) if volumes[k] > 0]
    members = {int(k): [surfaces[k]] for k in outer}
    for k in np.flatnonzero(volumes <= 0).tolist():
        point = corners[surfaces[k][0], 0]
        around = next(
            (o for o in outer if _in_box(point, corners[surfaces[o]]) and _winds(point, corners[surfaces[o]])), k
        )
        members.setdefault(int(around), []).append(surfaces[k])
    return sorted((np.sort(np.concatenate(rows)) for rows in members.values()), key=lambda rows: rows[0])


def volume(corners: Corners) -> float:
    """What a closed surface holds; negative where it is wound inwards."""
    local = corners - corners.reshape(-1, 3).mean(axis=0)
    return float(np.sum(local[:, 0] * np.cross(local[:, 1], local[:, 2])) / 6)


def winding_numbers(points: Points, corners: Corners) -> Float[np.ndarray, "points"]:
    """How often a closed surface goes round each point: 1 inside, 0 outside (Van Oosterom and Strackee)."""
    numbers = np.empty(len(points))
    for k, point in enumerate(points):
        a, b, c = np.moveaxis(corners - point, 1, 0)
        la, lb, lc = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
        above = np.sum(a * np.cross(b, c), axis=-1)
        below = la * lb * lc + np.sum(a * b, -1) * lc + np.sum(b * c, -1) * la + np.sum(c * a, -1) * lb
        numbers[k] = np.arctan2(above, below).sum() / (2 * np.pi)
    return numbers


def wrong_side(corners: Corners, tolerance: float, samples: int = _SIDE_SAMPLES) -> Points | None:
    """A place where a solid is not on the inner side of its surface, or also on the outer one; None if none was found.

    Looked for at the largest triangles and at some at random: solids that overlap or touch in one surface, surfaces
    that cut themselves or are wound inwards in part.
    """
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double = np.linalg.norm(cross, axis=-1)
    count = max(2, min(samples, _MAX_SOLID_ANGLES // (2 * len(corners)), len(corners)))
    largest = np.argsort(-double, kind="stable")[: count // 2]
    chance = np.random.default_rng(0).choice(len(corners), count, p=double / double.sum())
    some = np.unique(np.concatenate([largest, chance[: count - len(largest)]]))
    middles, normals = corners[some].mean(axis=1), cross[some] / double[some][:, None]
    for side, wanted in ((1.0, 0.0), (-1.0, 1.0)):
        wrong = np.abs(winding_numbers(middles + side * 10 * tolerance * normals, corners) - wanted) > 0.25
        if wrong.any():
            return middles[np.argmax(wrong)]
    return None


def _in_box(point: np.ndarray, corners: Corners) -> bool:
    flat = corners.reshape(-1, 3)
    return bool(np.all((point >= flat.min(axis=0)) & (point <= flat.max(axis=0))))


def _winds(point: np.ndarray, corners: Corners) -> bool:
    return bool(winding_numbers(point[None], corners)[0] > 0.5)
