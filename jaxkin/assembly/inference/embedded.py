"""Parts that stand in the material of others: a pin that ends in a lug that has no hole for it."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Points

SAMPLES = 60
"""Points of a part that are tried, evenly among its corners: a pin in a lug has a fifth of them inside."""
MIN_INSIDE = 0.02
"""Share of them in the material of another part from which on it is embedded; less is rounding where faces touch."""
SHRUNK = 0.02
"""Points are moved inwards by so much of the part's size, so that those on touching faces are outside of the other."""
_RAYS = ((0.5773, 0.2113, 0.7887), (-0.7071, 0.6533, 0.2706), (0.1951, -0.9239, 0.3289))
"""Directions that are askew to the faces and edges of what people draw, so that few rays meet an edge."""


def samples(part: Part) -> Points:
    """Return points of a part, evenly among its corners, moved a little inwards."""
    corners = np.unique(part.triangles.reshape(-1, 3), axis=0)
    corners = corners[np.linspace(0, len(corners) - 1, min(SAMPLES, len(corners))).astype(int)]
    return corners + SHRUNK * (part.box.mean(axis=0) - corners)


def share_inside(points: Points, other: Part) -> float:
    """Return the share of some points that lie in the material of a part."""
    low, high = other.box
    near = points[np.all((points > low) & (points < high), axis=1)]
    if not len(near):
        return 0.0
    return float(np.sum(inside(near, other.triangles)) / len(points))


def inside(
    points: Float[np.ndarray, "points 3"], triangles: Float[np.ndarray, "triangles 3 3"]
) -> Bool[np.ndarray, " points"]:
    """Tell whether points lie in a closed surface: most of three rays from each go through it an odd number of
    times."""
    votes = np.zeros(len(points), int)
    for ray in _RAYS:
        turn = np.linalg.qr(np.column_stack([ray, np.eye(3)[:, :2]]))[0]
        seen, corners = points @ turn, triangles @ turn  # the first coordinate is along the ray
        flat, at = corners[:, :, 1:], seen[:, 1:]
        met = np.all((flat.max(axis=1) >= at.min(axis=0)) & (flat.min(axis=1) <= at.max(axis=0)), axis=1)
        votes += _crossed(seen, corners[met]) % 2
    return votes >= 2


def _crossed(
    points: Float[np.ndarray, "points 3"], triangles: Float[np.ndarray, "triangles 3 3"]
) -> Int[np.ndarray, " points"]:
    """Count how many triangles lie ahead of each point along the first coordinate."""
    start, edges = triangles[None, :, :, 1:], np.roll(triangles, -1, axis=1)[None, :, :, 1:] - triangles[None, :, :, 1:]
    offset = points[:, None, None, 1:] - start
    turns = edges[..., 0] * offset[..., 1] - edges[..., 1] * offset[..., 0]
    over = np.all(turns > 0, axis=-1) | np.all(turns < 0, axis=-1)
    total = turns.sum(axis=-1)
    weights = np.roll(turns, -1, axis=-1) / np.where(total == 0, 1.0, total)[..., None]
    height = np.sum(weights * triangles[None, :, :, 0], axis=-1)
    return np.sum(over & (height > points[:, None, 0]), axis=1)
