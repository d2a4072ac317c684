"""What is known of a shipped assembly: its file, what is fixed and driven, and the dimensions it was drawn with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jaxkin.geometry.pose import Transform, Vector, rotation, unit


@dataclass(frozen=True)
class Example:
    """One shipped assembly."""

    file: str
    description: str
    fixed: tuple[str, ...]
    """The parts that are fixed."""
    drive: tuple[str, str]
    """The two parts whose joint is driven: by an angle about z of the drawing, or as the description says."""
    unit: str
    dimensions: dict[str, float]
    """Lengths in `unit`, angles in radians, by name; in the coordinates of the drawing."""
    turn: tuple[Vector, float]
    """The rotation from the drawing to the world: its axis and its angle in radians."""
    shift: Vector
    """The origin of the drawing in the world."""

    @property
    def placement(self) -> Transform:
        """The pose of the drawing in the world: `apply(placement, point_of_the_drawing)` is where the file has it."""
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = rotation(unit(self.turn[0]), self.turn[1]), self.shift
        return pose
