"""Weld triangles into a surface: find which corners are the same point, and which triangles share an edge.

Files hold each triangle with its own corners, or split the surface where colours or shading change. Equal corners
become one point. Corners at edges that belong to one triangle only become one point if they are equal within the
rounding of the file, and those in the middle of another edge are stitched to it (`stitch`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.components import components
from jaxkin.geometry.stitch import Triples, stitched
from jaxkin.geometry.triangles import Triangles

_MIN_WEDGE = 1e-2
"""Smallest angle, radians, of a wedge of material between two triangles at an edge.

At a smaller angle the triangles coincide but for rounding, and do not bound a wedge with each other."""


@dataclass(frozen=True, eq=False)
class Welded:
    """Triangles by the indices of their corners, and the pairs of triangles that share an edge."""

    points: Float[np.ndarray, "points 3"]
    """The corners, each point once."""
    triangles: Triples
    """The triangles, by indices into `points`."""
    pairs: Int[np.ndarray, "pairs 2"]
    """The two triangles at each edge that two triangles share."""
    open_edges: Int[np.ndarray, "edges 2"]
    """Start and end point of each edge of one triangle only."""


def weld(corners: Triangles, tolerance: float) -> Welded:
    """Weld triangles; those that become a line or a point are left out.

    `tolerance`, a length, is the rounding of the file.
    """
    points, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = _proper(index.reshape(-1, 3))
    pairs, lone = pair_edges(points, triangles)
    if len(lone):
        at = np.unique(lone)
        triangles = _proper(_merged(points, at, tolerance)[triangles])
        pairs, lone = pair_edges(points, triangles)
    if len(lone):
        triangles = stitched(points, triangles, lone, tolerance)
        pairs, lone = pair_edges(points, triangles)
    return Welded(points, triangles, pairs, lone)


def pair_edges(points: np.ndarray, triangles: Triples) -> tuple[np.ndarray, np.ndarray]:
    """Find the pairs of triangles that share an edge, which they run along in opposite directions.

    Where more than two triangles meet at an edge, as where two solids touch, two triangles are a pair if they bound one
    wedge of material. Returns the pairs (pairs, 2) of triangles, and the edges without a pair (edges, 2), by their
    start and end points.
    """
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(triangles)), 3)
    low, high, forward = np.minimum(start, end), np.maximum(start, end), start < end
    order = np.lexsort((~forward, high, low))
    new = np.ones(len(order), bool)
    new[1:] = (low[order][1:] != low[order][:-1]) | (high[order][1:] != high[order][:-1])
    first = np.flatnonzero(new)
    count = np.diff(np.append(first, len(order)))
    ahead = np.add.reduceat(forward[order].astype(int), first) if len(first) else first
    simple = (count == 2) & (ahead == 1)
    pairs = [np.stack([owner[order[first[simple]]], owner[order[first[simple] + 1]]], axis=-1)]
    lone = [order[np.repeat(count == 1, count)]]
    body = components(len(triangles), pairs[0])
    for begin, number in zip(first[~simple & (count > 1)], count[~simple & (count > 1)], strict=True):
        here = order[begin : begin + number]
        matched = _wedges(points, triangles, owner[here], here % 3, forward[here], body[owner[here]])
        pairs.append(owner[here][matched])
        lone.append(np.delete(here, matched.ravel()))
    rest = np.concatenate(lone)
    return np.concatenate(pairs), np.stack([start[rest], end[rest]], axis=-1)


def _wedges(
    points: np.ndarray, triangles: Triples, owner: np.ndarray, side: np.ndarray, forward: np.ndarray, body: np.ndarray
):
    """Pair the triangles around one edge that bound one wedge of material.

    For each triangle at the edge, `owner` is its index, `side` the number (0, 1, 2) of the edge within it, `forward`
    whether it runs along the edge from the point of lower index to that of higher index, and `body` the number of the
    surface to which edges of two triangles connect it. Returns pairs (_, 2) of positions in these arrays.
    """
    rows = triangles[owner]
    place = np.arange(len(owner))
    low = np.where(forward, rows[place, side], rows[place, (side + 1) % 3])[0]
    high = np.where(forward, rows[place, (side + 1) % 3], rows[place, side])[0]
    axis = points[high] - points[low]
    axis = axis / np.linalg.norm(axis)
    away = points[rows[place, (side + 2) % 3]] - points[low]
    away = away - (away @ axis)[:, None] * axis
    x = away[0] / (np.linalg.norm(away[0]) or 1.0)
    angle = np.arctan2(away @ np.cross(axis, x), away @ x)
    # seen with the edge pointing to the viewer, the material of a forward triangle is on its clockwise side
    found, taken = [], np.zeros(len(owner), bool)
    for one in np.flatnonzero(forward):
        wedge = np.mod(angle[one] - angle, 2 * np.pi)
        wedge = np.where(wedge < _MIN_WEDGE, 2 * np.pi, wedge)
        wedge[forward | taken] = np.inf
        # a triangle of the same surface comes first: facets of a ball and of its socket intersect, so angles mislead
        akin = (body == body[one]) & np.isfinite(wedge)
        wedge[akin.any() & ~akin] = np.inf
        other = int(np.argmin(wedge))
        if np.isfinite(wedge[other]):
            taken[other] = True
            found.append((one, other))
    return np.array(found, int).reshape(-1, 2)


def _proper(triangles: Triples) -> Triples:
    """Leave out triangles two of whose corners are the same point."""
    return triangles[np.all(triangles != np.roll(triangles, 1, axis=1), axis=1)]


def _merged(points: np.ndarray, at: np.ndarray, tolerance: float) -> np.ndarray:
    """Return for each point the index of the point that replaces it (points,).

    Points of the list `at` that are connected by distances up to `tolerance` are replaced by the first of them, all
    other points by themselves.
    """
    from scipy.spatial import KDTree

    index = np.arange(len(points))
    near = KDTree(points[at]).query_pairs(tolerance, output_type="ndarray")
    if len(near):
        label = components(len(at), near)
        index[at] = at[np.unique(label, return_index=True)[1]][label]
    return index
