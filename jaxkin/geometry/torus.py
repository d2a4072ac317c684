"""Tori: recognised in order to be reported to the user, since no contact state of the paper has one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Points, Vector


@dataclass(frozen=True, eq=False)
class Torus:
    """A torus: the surface at a distance `radius` from a circle."""

    centre: Vector
    axis: Vector
    """Unit vector along the axis of revolution."""
    ring: float
    """Radius of the circle in the middle of the tube."""
    radius: float
    """Radius of the tube."""
    kind: ClassVar[str] = "torus"

    def distance(self, points: Points) -> Float[np.ndarray, "*batch"]:
        """Measure the distance from the surface, positive outside the tube."""
        return np.linalg.norm(self._from_tube(points), axis=-1) - self.radius

    def normals(self, points: Points) -> Points:
        """Find the unit normals that point out of the tube."""
        offset = self._from_tube(points)
        length = np.linalg.norm(offset, axis=-1, keepdims=True)
        return offset / np.where(length > 0, length, 1.0)

    def _from_tube(self, points: Points) -> Points:
        """Compute the vectors to points from the nearest point of the circle in the middle of the tube."""
        offset = points - self.centre
        height = (offset @ self.axis)[..., None]
        radial = offset - height * self.axis
        length = np.linalg.norm(radial, axis=-1, keepdims=True)
        out = radial / np.where(length > 0, length, 1.0)
        return (length - self.ring) * out + height * self.axis
