"""Parts that stand in the material of others: a pin that ends in a lug that has no hole for it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.part import Part

SAMPLES = 60
"""Points of a part that are tried, evenly among its corners: a pin in a lug has a fifth of them inside."""
MIN_INSIDE = 0.02
"""Share of them in the material of another part from which on it is embedded; less is rounding where faces touch."""
SHRUNK = 0.02
"""Points are moved inwards by so much of the part's size, so that those on touching faces are outside of the other."""


def share_inside(part: Part, other: Part) -> float:
    """Return the share of a part's corners, moved a little inwards, that lie in the material of another part."""
    low, high = other.box
    corners = np.unique(part.triangles.reshape(-1, 3), axis=0)
    corners = corners[np.linspace(0, len(corners) - 1, min(SAMPLES, len(corners))).astype(int)]
    corners = corners + SHRUNK * (part.box.mean(axis=0) - corners)
    near = corners[np.all((corners > low) & (corners < high), axis=1)]
    if not len(near):
        return 0.0
    return float(np.sum(np.abs(_winding(near, other.triangles)) > 0.5) / len(corners))


def _winding(
    points: Float[np.ndarray, "points 3"], triangles: Float[np.ndarray, "triangles 3 3"]
) -> Float[np.ndarray, " points"]:
    """How often a closed surface goes round each point: 1 inside, 0 outside (solid angle of all triangles / 4 pi)."""
    total = np.empty(len(points))
    for index, point in enumerate(points):
        a, b, c = np.moveaxis(triangles - point, 1, 0)
        la, lb, lc = (np.linalg.norm(each, axis=1) for each in (a, b, c))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c))
        ab, bc, ca = (np.einsum("ij,ij->i", *pair) for pair in ((a, b), (b, c), (c, a)))
        total[index] = 2 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb).sum()
    return total / (4 * np.pi)


def boxes_meet(one: Part, other: Part, margin: float = 0.0) -> bool:
    """Whether the boxes of two parts overlap, or are nearer to each other than a margin."""
    return bool(np.all(one.box[0] <= other.box[1] + margin) and np.all(other.box[0] <= one.box[1] + margin))


def embedded(part: Part, others: Sequence[Part]) -> list[tuple[float, str]]:
    """Find the parts in whose material a part stands, with the share of its corners there; the deepest first."""
    found = [(share_inside(part, other), other.name) for other in others if boxes_meet(part, other)]
    return sorted(((share, name) for share, name in found if share >= MIN_INSIDE), reverse=True)
