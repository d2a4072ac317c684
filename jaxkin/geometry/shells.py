"""Make solids from welded triangles: find holes, closed surfaces, their cavities, and wrongly wound pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.components import components, grouped
from jaxkin.geometry.facets import TriangleIndices
from jaxkin.geometry.pose import Points
from jaxkin.geometry.triangles import Triangles, double_areas
from jaxkin.geometry.weld import Welded

_SIDE_SAMPLES = 200
"""Largest number of triangles at which `wrong_side` checks the two sides."""

_MAX_SOLID_ANGLES = 8_000_000
"""Largest number of solid angles, samples x triangles x 2 sides, that `wrong_side` computes: bounds the time."""

_SIDE_HEIGHT = 10
"""Height over a triangle of the points at which `wrong_side` checks a side, in units of the tolerance."""

_MAX_WINDING_ERROR = 0.25
"""Largest deviation of a winding number from 0 or 1 that counts as rounding; off the surface it is a whole number."""

_MAX_CRACK_RATIO = 0.02
"""Largest width of a crack over its extent. Sixteen chords leave their circle by 1 percent of its diameter."""

_MAX_RIMS = 200
"""Largest number of rims that are compared with each other: bounds the time; more are all holes."""


@dataclass(frozen=True, eq=False)
class Crack:
    """A narrow gap between two tessellations of one line that do not share their corners."""

    place: Points
    """The middle of its rim, (3,)."""
    width: float
    """A length."""


def open_loops(welded: Welded, tolerance: float) -> list[Points]:
    """Find the holes of a surface; returns for each the points of its rim (_, 3).

    A hole is a set of connected edges without a second triangle that enclose an area wider than `tolerance`, a length.
    Where two tessellations meet with different corners along a common line, such edges lie on each other, enclose no
    area, and are no hole.
    """
    return [rim[:, 0] for rim in _rims(welded) if _is_wide(rim, tolerance)]


def holes_and_cracks(welded: Welded, tolerance: float) -> tuple[list[Points], list[Crack]]:
    """Find the holes of a surface as `open_loops` does, and tell narrow cracks from them.

    A crack is a rim, or two rims beside each other, whose width is up to `_MAX_CRACK_RATIO` of its extent, as where two
    faces of one edge were tessellated apart. Returns the points of the rim of each hole (_, 3), and the cracks.
    """
    rims = [rim for rim in _rims(welded) if _is_wide(rim, tolerance)]
    holes: list[Points] = []
    cracks: list[Crack] = []
    left = list(range(len(rims)))
    while left:
        k = left.pop(0)
        extent = float(np.linalg.norm(np.ptp(rims[k].reshape(-1, 3), axis=0)))
        width = 2 * _area(rims[k]) / np.linalg.norm(rims[k][:, 1] - rims[k][:, 0], axis=-1).sum()
        beside = left if len(rims) <= _MAX_RIMS else []
        apart = {n: max(_distance(rims[k], rims[n]), _distance(rims[n], rims[k])) for n in beside}
        nearest = min(apart, key=lambda n: apart[n], default=None)
        if width <= _MAX_CRACK_RATIO * extent:
            cracks.append(Crack(rims[k][:, 0].mean(axis=0), float(width)))
        elif nearest is not None and apart[nearest] <= _MAX_CRACK_RATIO * extent:
            cracks.append(Crack(rims[k][:, 0].mean(axis=0), apart[nearest]))
            left.remove(nearest)
        else:
            holes.append(rims[k][:, 0])
    return holes, cracks


def _rims(welded: Welded) -> list[Float[np.ndarray, "_ 2 3"]]:
    """Collect the connected open edges: [edge, start or end, coordinate] of each rim."""
    edges = welded.open_edges
    if not len(edges):
        return []
    _, index = np.unique(edges, return_inverse=True)
    label = components(int(index.max()) + 1, index.reshape(-1, 2))[index.reshape(-1, 2)[:, 0]]
    return [welded.points[edges[label == k]] for k in range(int(label.max()) + 1)]


def _area(rim: Float[np.ndarray, "_ 2 3"]) -> float:
    """Compute the area that a rim encloses, the length of its vector area."""
    a, b = rim[:, 0], rim[:, 1]
    return float(np.linalg.norm(np.cross(a - a[0], b - a[0]).sum(axis=0)) / 2)


def _is_wide(rim: Float[np.ndarray, "_ 2 3"], tolerance: float) -> bool:
    """Check whether a rim encloses an area wider than `tolerance`, a length."""
    return bool(_area(rim) > 2 * tolerance * np.linalg.norm(rim[:, 1] - rim[:, 0], axis=-1).sum())


def _distance(rim: Float[np.ndarray, "_ 2 3"], other: Float[np.ndarray, "_ 2 3"]) -> float:
    """Compute the largest distance of the points of a rim from the edges of another rim."""
    start, along = other[:, 0], other[:, 1] - other[:, 0]
    square = np.maximum(np.sum(along**2, axis=-1), np.finfo(float).tiny)
    worst = 0.0
    for point in rim[:, 0]:
        share = np.clip(np.sum((point - start) * along, axis=-1) / square, 0, 1)
        worst = max(worst, float(np.linalg.norm(point - start - share[:, None] * along, axis=-1).min()))
    return worst


def shells(welded: Welded) -> list[TriangleIndices]:
    """Group the triangles that are connected through shared edges: returns the indices of each connected surface."""
    return grouped(components(len(welded.triangles), welded.pairs))


def bodies(corners: Triangles, surfaces: list[TriangleIndices]) -> list[TriangleIndices]:
    """Join closed surfaces to solids: each outer surface with its cavities.

    `corners` are those of all triangles, `surfaces` the indices of the triangles of each closed surface. A surface that
    is wound inwards (negative volume) is a cavity of the smallest outer surface around it. Returns the indices of the
    triangles of each solid, rising.
    """
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


def volume(corners: Triangles) -> float:
    """Compute the volume inside a closed surface, negative where it is wound inwards (divergence theorem)."""
    local = corners - corners.reshape(-1, 3).mean(axis=0)
    return float(np.sum(local[:, 0] * np.cross(local[:, 1], local[:, 2])) / 6)


def winding_numbers(points: Points, corners: Triangles) -> Float[np.ndarray, "points"]:
    """Compute how often a closed surface winds round each point: 1 inside, 0 outside.

    It is the sum of the signed solid angles of the triangles over 4 pi (Van Oosterom and Strackee 1983).
    """
    numbers = np.empty(len(points))
    first, second, third = (np.ascontiguousarray(corner.T) for corner in np.moveaxis(corners, 1, 0))
    for k, point in enumerate(points):
        a, b, c = (corner - point[:, None] for corner in (first, second, third))
        ab, bc, ca = (np.einsum("kn,kn->n", *pair) for pair in ((a, b), (b, c), (c, a)))
        la, lb, lc = (np.sqrt(np.einsum("kn,kn->n", v, v)) for v in (a, b, c))
        above = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
        above += a[2] * (b[0] * c[1] - b[1] * c[0])
        below = la * lb * lc + ab * lc + bc * la + ca * lb
        numbers[k] = np.arctan2(above, below).sum() / (2 * np.pi)
    return numbers


def wrong_side(corners: Triangles, tolerance: float, samples: int = _SIDE_SAMPLES) -> Points | None:
    """Find a point of a closed surface without the solid inside and empty space outside; None if none was found.

    Such points are on solids that overlap or touch within one surface, and on surfaces that intersect themselves or are
    wound inwards in part. The winding number is tested close to both sides (`_SIDE_HEIGHT` times `tolerance`, a length)
    of at most `samples` triangles: the largest ones, and others at random.
    """
    cross = double_areas(corners)
    double = np.linalg.norm(cross, axis=-1)
    count = max(2, min(samples, _MAX_SOLID_ANGLES // (2 * len(corners)), len(corners)))
    largest = np.argsort(-double, kind="stable")[: count // 2]
    chance = np.random.default_rng(0).choice(len(corners), count, p=double / double.sum())
    some = np.unique(np.concatenate([largest, chance[: count - len(largest)]]))
    middles, normals = corners[some].mean(axis=1), cross[some] / double[some][:, None]
    for side, wanted in ((1.0, 0.0), (-1.0, 1.0)):
        numbers = winding_numbers(middles + side * _SIDE_HEIGHT * tolerance * normals, corners)
        wrong = np.abs(numbers - wanted) > _MAX_WINDING_ERROR
        if wrong.any():
            return middles[np.argmax(wrong)]
    return None


def _in_box(point: np.ndarray, corners: Triangles) -> bool:
    """Check whether a point is in the bounding box of some triangles."""
    flat = corners.reshape(-1, 3)
    return bool(np.all((point >= flat.min(axis=0)) & (point <= flat.max(axis=0))))


def _winds(point: np.ndarray, corners: Triangles) -> bool:
    """Check whether a closed surface winds round a point, so that the point is inside."""
    return bool(winding_numbers(point[None], corners)[0] > 0.5)
