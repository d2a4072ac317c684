"""Mass, centre and inertia that a file gives for a part."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Pose, apply


@dataclass(frozen=True, eq=False)
class Inertial:
    """What a rigid part weighs, in the axes and about the origin of whatever holds it."""

    mass: float
    """Kilograms."""
    centre: Float[np.ndarray, "3"]
    """Centre of mass, in the unit of the assembly."""
    inertia: Float[np.ndarray, "3 3"]
    """About the centre of mass, kg m^2."""

    def moved(self, pose: Pose) -> Inertial:
        """Displace by a pose (4, 4)."""
        turn = pose[:3, :3]
        return Inertial(self.mass, apply(pose, self.centre), turn @ self.inertia @ turn.T)

    def in_unit(self, factor: float) -> Inertial:
        """Give the centre in another unit of length, `factor` of which are one of the old; mass and inertia stay."""
        return replace(self, centre=factor * self.centre)


NONE = Inertial(0.0, np.zeros(3), np.zeros((3, 3)))
"""Of a part that a file says is without mass."""
