"""Displacements of a solid relative to another one, many at once, on the host."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float


class Displaced(NamedTuple):
    """Displacements of solid 2 relative to solid 1: x -> rotation x + shift, in the axes of the two trees."""

    rotation: Float[np.ndarray, "poses 3 3"]
    shift: Float[np.ndarray, "poses 3"]

    def of(self, pose: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Displace points (_, ..., 3), each by the displacement at its place in `pose`."""
        flat = points.reshape(len(points), int(np.prod(points.shape[1:-1])), 3)
        return (flat @ self.rotation[pose].swapaxes(1, 2) + self.shift[pose, None]).reshape(points.shape)

    def at(self, poses: np.ndarray) -> Displaced:
        """Choose some of the displacements."""
        return Displaced(self.rotation[poses], self.shift[poses])

    def inverse(self) -> Displaced:
        """Compute the displacements of solid 1 relative to solid 2."""
        turn = np.swapaxes(self.rotation, 1, 2)
        return Displaced(turn, -np.einsum("pij,pj->pi", turn, self.shift))
