"""The outline of a part, seen along an axis."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.trig import TURN


def widest_gap(angles: Float[np.ndarray, " angles"]) -> float:
    """Measure the widest angle between neighbouring directions all round, radians; 2 pi for a single one."""
    angles = np.sort(angles)
    return float(np.diff(angles, append=angles[0] + TURN).max())


def roundness(outline: Float[np.ndarray, "corners 2"], centre: Float[np.ndarray, " 2"] | None = None) -> float:
    """Return the ratio of the least to the greatest half width of an outline about its centre: 1 for a circle.

    The centre is by default the middle of the box of the outline. The outline is that of the convex hull; of points on
    one line the roundness is 0.
    """
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(outline)
    except QhullError:  # a sheet seen from its edge
        return 0.0
    corners = outline[hull.vertices]
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2 if centre is None else centre
    inner = -(hull.equations[:, :2] @ middle + hull.equations[:, 2])
    return float(inner.min() / np.linalg.norm(corners - middle, axis=1).max())
