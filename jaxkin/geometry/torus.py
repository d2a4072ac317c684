"""Tori, recognised in order to be named: no contact state of the paper has one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Points, Vector


@dataclass(frozen=True, eq=False)
class Torus:
    centre: Vector
    axis: Vector
    ring: float
    """Radius of the circle of the centres of the tube."""
    radius: float
    """Of the tube."""
    kind: ClassVar[str] = "torus"

    def distance(self, points: Points) -> Float[np.ndarray, "*batch"]:
        """Distance from the surface, positive outside the tube."""
        return np.linalg.norm(self._from_tube(points), axis=-1) - self.radius

    def normals(self, points: Points) -> Points:
        """Out of the tube."""
        offset = self._from_tube(points)
        length = np.linalg.norm(offset, axis=-1, keepdims=True)
        return offset / np.where(length > 0, length, 1.0)

    def _from_tube(self, points: Points) -> Points:
        offset = points - self.centre
        height = (offset @ self.axis)[..., None]
        radial = offset - height * self.axis
        length = np.linalg.norm(radial, axis=-1, keepdims=True)
        out = radial / np.where(length > 0, length, 1.0)
        return (length - self.ring) * out + height * self.axis
