"""Find the displacement that takes one list of points to another: two instances of a part are one mesh, moved."""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.pose import Transform, apply
from jaxkin.geometry.triangle_distance import Points


def displacement(points: Points, others: Points, length: float) -> Transform | None:
    """Find the displacement, (4, 4), that takes each point to the one at its place in another list, within a length.

    None where there is none: mirrored points are no displaced ones.
    """
    if len(points) != len(others):
        return None
    middle, other_middle = points.mean(axis=0), others.mean(axis=0)
    left, _, right = np.linalg.svd((points - middle).T @ (others - other_middle))
    sign = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    found = np.eye(4)
    found[:3, :3] = (left * sign @ right).T
    found[:3, 3] = other_middle - found[:3, :3] @ middle
    return found if np.abs(apply(found, points) - others).max() <= length else None
