"""Triangles of solids, by their corners: areas as vectors, and whether they enclose a volume."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

Triangles = Float[np.ndarray, "_ 3 3"]
"""Corners of triangles in space: [triangle, corner, coordinate]."""

OPEN = 1e-6
"""Vector sum of the areas of a closed surface over their sum, up to which it counts as closed: rounding."""


def double_areas(triangles: Triangles) -> Float[np.ndarray, "_ 3"]:
    """Compute twice the area of each triangle, as a vector along the normal that its winding gives it."""
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])


def total_area(triangles: Triangles) -> float:
    """Compute the sum of the areas of triangles."""
    return float(np.linalg.norm(double_areas(triangles), axis=-1).sum() / 2)


def is_closed(triangles: Triangles) -> bool:
    """Check whether the areas of triangles add up to zero as vectors, as those of a closed surface do."""
    areas = double_areas(triangles)
    return bool(np.linalg.norm(areas.sum(axis=0)) <= OPEN * np.linalg.norm(areas, axis=1).sum())
