"""Mass, centre and inertia that a file gives for a part, and those of solids for a density of one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Transform, apply
from jaxkin.geometry.triangles import is_closed

ROUNDED_MOMENTS = 0.02
"""Excess of the largest principal moment of inertia over the sum of the other two, over the largest one, that is the
rounding of two digits: a plate of 0.33, 0.33 and 0.67 has 0.015."""


@dataclass(frozen=True, eq=False)
class Inertial:
    """What a rigid part weighs, in the axes and about the origin of whatever holds it."""

    mass: float
    """Kilograms."""
    centre: Float[np.ndarray, "3"]
    """Centre of mass, in the unit of the assembly."""
    inertia: Float[np.ndarray, "3 3"]
    """About the centre of mass, kg m^2."""

    def moved(self, pose: Transform) -> Inertial:
        """Displace by a pose (4, 4)."""
        turn = pose[:3, :3]
        return Inertial(self.mass, apply(pose, self.centre), turn @ self.inertia @ turn.T)

    def in_unit(self, factor: float) -> Inertial:
        """Give the centre in another unit of length, `factor` of which are one of the old; mass and inertia stay."""
        return replace(self, centre=factor * self.centre)


def sum_of(several: Sequence[Inertial]) -> Inertial:
    """Add up masses that are rigid with each other and not all zero, in the same axes; lengths in metres.

    About the common centre: I = sum I_k + m_k (d_k^2 1 - d_k d_k^T), with d_k from there to the centre of mass k.
    """
    mass = sum(each.mass for each in several)
    centre = sum((each.mass * each.centre for each in several), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for each in several:
        d = each.centre - centre
        inertia += each.inertia + each.mass * (d @ d * np.eye(3) - np.outer(d, d))
    return Inertial(mass, centre, inertia)


def of_density_one(triangles: Float[np.ndarray, "faces 3 3"]) -> Inertial | None:
    """Compute the volume, as a mass, its centre and its inertia from the surface of a solid; None where it is open.

    Triangles may all be turned inside out.
    """
    import trimesh

    middle = (triangles.reshape(-1, 3).min(axis=0) + triangles.reshape(-1, 3).max(axis=0)) / 2
    centred = triangles - middle  # far from the origin of the world the digits would be lost
    found = trimesh.triangles.mass_properties(centred, density=1.0, center_mass=None, skip_inertia=False)
    volume = float(found["volume"])
    if not is_closed(centred) or volume == 0.0:
        return None
    inertia = np.sign(volume) * np.asarray(found["inertia"])
    return Inertial(abs(volume), np.asarray(found["center_mass"]) + middle, inertia)


def exceeds_sum(moments: Float[np.ndarray, "3"]) -> bool:
    """Tell whether the largest principal moment of inertia is above the sum of the other two, which no body has.

    `moments` rise. Those of a flat plate add up to each other: of their digits only two need be right.
    """
    return bool(moments[2] - moments[0] - moments[1] > ROUNDED_MOMENTS * moments[2])


NONE = Inertial(0.0, np.zeros(3), np.zeros((3, 3)))
"""Of a part that a file says is without mass."""
