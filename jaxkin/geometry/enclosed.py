"""Tell which points lie outside of a closed surface by rays: a search for the nearest triangles takes longer."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.geometry.triangle_distance import Points
from jaxkin.geometry.triangle_tree import TriangleTree
from jaxkin.geometry.triangles import is_closed

_DOUBT = 1e-9
"""Share of the size of a solid by which a ray must miss edges, and triangles their point, to tell on which side they
are."""
_AT_ONCE = 1 << 14
"""Points whose rays are followed at once."""


def may_be_inside(tree: TriangleTree, points: Points) -> Bool[np.ndarray, " _"]:
    """Tell which points are inside of a solid, or so near its surface, or below an edge, that rays do not tell.

    From each point a ray goes along the third axis. The number of triangles through which it leaves the solid, less
    those through which it enters, is 0 for a point outside. Of a surface that is not closed rays tell nothing.
    """
    if not is_closed(tree.triangles):
        return np.ones(len(points), bool)
    found = [_by_rays(tree, points[start : start + _AT_ONCE]) for start in range(0, len(points), _AT_ONCE)]
    return np.concatenate([np.zeros(0, bool), *found])


def _by_rays(tree: TriangleTree, points: Points) -> np.ndarray:
    """Compute what `may_be_inside` returns, for points at once: boxes that rays reach are split level by level."""
    level = _DOUBT * float((tree.high[0] - tree.low[0]).max())
    x, y, z = np.ascontiguousarray(points.T)
    low, high = tree.low.T - level, tree.high.T + level
    which, node = np.arange(len(points)), np.zeros(len(points), int)
    while True:
        for place, least, most in ((x, low[0], high[0]), (y, low[1], high[1])):
            over = (place[which] <= most[node]) & (place[which] >= least[node])
            which, node = which[over], node[over]
        over = z[which] <= high[2, node]
        which, node = which[over], node[over]
        if np.all(tree.is_leaf[node]):
            break
        both = tree.children[node]
        twice = both[:, 0] != both[:, 1]
        which, node = np.concatenate([which, which[twice]]), np.concatenate([both[:, 0], both[twice, 1]])
    through, doubtful = _through(tree.triangles[tree.triangle[node]] - points[which, None], level)
    outwards, unknown = (np.bincount(which, each, len(points)) for each in (through, doubtful))
    return (outwards > 0) | (unknown > 0)


def _through(
    triangles: Float[np.ndarray, "_ 3 3"], level: float
) -> tuple[Float[np.ndarray, " _"], Bool[np.ndarray, " _"]]:
    """Tell which triangles the ray from the origin goes through, 1 out of the solid and -1 into it, and what is in
    doubt by a length."""
    flat = triangles[:, :, :2]
    following = np.roll(flat, -1, axis=1)
    # twice the area of the triangle of each edge and the ray, positive where the ray is to its left
    areas = flat[:, :, 0] * following[:, :, 1] - flat[:, :, 1] * following[:, :, 0]
    total = areas.sum(axis=1)
    outwards = np.where(total < 0, -1.0, 1.0)
    side = areas * outwards[:, None]
    beside = level * np.linalg.norm(following - flat, axis=2)
    near = np.all(side >= -beside, axis=1)
    # the third coordinate over the ray, times the area
    height = np.sum(areas * np.roll(triangles[:, :, 2], 1, axis=1), axis=1) * outwards
    above, below = height > level * np.abs(total), height < -level * np.abs(total)
    doubtful = near & ~below & (np.any(side <= beside, axis=1) | ~above)
    return np.where(near & above, outwards, 0.0), doubtful
