"""Triangles of solids, by their corners: areas as vectors, whether they enclose a volume, and cuts by a plane."""

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


def plane_cut(triangles: Triangles, heights: Float[np.ndarray, "_ 3"]) -> Float[np.ndarray, "_ 2 3"]:
    """Compute the segments in which a plane cuts triangles: [triangle, end, coordinate].

    `heights` are those of the corners over the plane, which goes through all of the triangles.
    """
    above = heights > 0
    alone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)  # the corner alone on its side
    order = (alone[:, None] + np.arange(3)) % 3
    triangles = np.take_along_axis(triangles, order[..., None], axis=1)
    heights = np.take_along_axis(heights, order, axis=1)
    share = heights[:, :1] / (heights[:, :1] - heights[:, 1:])
    return triangles[:, :1] + share[..., None] * (triangles[:, 1:] - triangles[:, :1])
