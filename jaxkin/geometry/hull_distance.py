"""Find the nearest points of the convex hulls of two solids, at many displacements at once.

The algorithm of Gilbert, Johnson and Keerthi: the difference of two hulls holds a simplex near the origin, which is
replaced by one nearer to it, with the corner that lies farthest towards the origin, until there is none.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations

import numpy as np
from jaxtyping import Float, Int

_MAX_STEPS = 64
"""Corners that are tried at most: some ten are for hulls of hundreds of corners."""
_NEARER = 1e-10
"""Share of the square of a distance by which a corner must be nearer to the origin to be worth it."""
_FLAT = 1e-12
"""Share of the product of its edges' squares below which a simplex is flat."""
_SUBSETS = [list(subset) for count in (1, 2, 3) for subset in combinations(range(4), count)]
"""One to three corners of a simplex, by their numbers: its corners, edges and faces."""

Support = Callable[[Int[np.ndarray, " _"], Float[np.ndarray, "_ 3"]], Float[np.ndarray, "_ 2 3"]]
"""Finds at some places, along a direction each, the corners by which the second of two hulls is least ahead of the
first: one of the first, and one of the second."""


def nearest_of_hulls(first: Float[np.ndarray, "places 2 3"], support: Support) -> Float[np.ndarray, "places 2 3"]:
    """Find the nearest points of two hulls at each place, one of each hull: the same one where the hulls overlap.

    `first` are a corner of each hull to begin with.
    """
    simplex = np.repeat(first[:, None], 4, axis=1)
    held = np.zeros((len(first), 4), bool)
    held[:, 0] = True
    gap = first[:, 1] - first[:, 0]
    active = np.flatnonzero(np.any(gap, axis=1))
    for _ in range(_MAX_STEPS):
        if not len(active):
            break
        corners = support(active, gap[active])
        square = np.sum(gap[active] ** 2, axis=1)
        nearer = square - np.sum(gap[active] * (corners[:, 1] - corners[:, 0]), axis=1) > _NEARER * square
        active, corners, square = active[nearer], corners[nearer], square[nearer]
        free = np.argmin(held[active], axis=1)
        simplex[active, free] = corners
        held[active, free] = True
        found, kept = _nearest(simplex[active, :, 1] - simplex[active, :, 0], held[active])
        gap[active], held[active] = found, kept
        active = active[(np.sum(found**2, axis=1) < square) & ~kept.all(axis=1)]
    points = np.zeros_like(first)
    for subset in _SUBSETS:
        (some,) = np.nonzero(np.all(held == np.isin(np.arange(4), subset), axis=1))
        corners = simplex[some][:, subset]
        points[some] = np.einsum("pk,pksi->psi", _shares(corners[:, :, 1] - corners[:, :, 0]), corners)
    points[held.all(axis=1), 1] = points[held.all(axis=1), 0]
    return points


def _nearest(simplex: Float[np.ndarray, "places 4 3"], held: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the point of each simplex that is nearest to the origin, and which of its corners hold that point."""
    count = len(simplex)
    least, point = np.full(count, np.inf), np.zeros((count, 3))
    kept = np.zeros((count, 4), bool)
    for subset in _SUBSETS:
        (some,) = np.nonzero(held[:, subset].all(axis=1))
        corners = simplex[some][:, subset]
        share = _shares(corners)
        inside = np.all(share >= 0, axis=1)
        some, own = some[inside], np.einsum("pk,pki->pi", share[inside], corners[inside])
        square = np.sum(own**2, axis=1)
        nearer = square < least[some]
        some = some[nearer]
        least[some], point[some] = square[nearer], own[nearer]
        kept[some] = np.isin(np.arange(4), subset)
    (some,) = np.nonzero(held.all(axis=1))
    around = _holds_origin(simplex[some])
    point[some[around]], kept[some[around]] = 0.0, True
    return point, kept


def _shares(corners: Float[np.ndarray, "places corners 3"]) -> Float[np.ndarray, "places corners"]:
    """Compute the shares of one to three corners in the point of their span that is nearest to the origin; -1 where
    they are flat."""
    count = corners.shape[1]
    first, edges = corners[:, 0], corners[:, 1:] - corners[:, :1]
    if count == 1:
        return np.ones((len(corners), 1))
    products, ahead = edges @ edges.swapaxes(1, 2), -np.einsum("pki,pi->pk", edges, first)
    if count == 2:
        size, share = products[:, 0, 0], ahead
        exists = size > 0
    else:
        size = products[:, 0, 0] * products[:, 1, 1] - products[:, 0, 1] ** 2
        exists = size > _FLAT * products[:, 0, 0] * products[:, 1, 1]
        share = np.stack(
            [
                products[:, 1, 1] * ahead[:, 0] - products[:, 0, 1] * ahead[:, 1],
                products[:, 0, 0] * ahead[:, 1] - products[:, 0, 1] * ahead[:, 0],
            ],
            axis=-1,
        )
    share = share / np.where(exists, size, 1.0)[:, None]
    share = np.column_stack([1 - share.sum(axis=1), share])
    return np.where(exists[:, None], share, -1.0)


def _holds_origin(simplex: Float[np.ndarray, "places 4 3"]) -> np.ndarray:
    """Tell which tetrahedra hold the origin."""
    edges = simplex[:, 1:] - simplex[:, :1]
    size = np.linalg.det(edges)
    scale = np.linalg.norm(edges, axis=2).prod(axis=1)
    exists = np.abs(size) > _FLAT * scale
    solved = np.linalg.solve(np.where(exists[:, None, None], edges.swapaxes(1, 2), np.eye(3)), -simplex[:, 0, :, None])[
        :, :, 0
    ]
    return exists & np.all(solved >= 0, axis=1) & (solved.sum(axis=1) <= 1)
