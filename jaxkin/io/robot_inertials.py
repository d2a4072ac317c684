"""Masses of links from the elements <inertial> of robot files; what is no mass of a body is refused."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.geometry.inertial import Inertial
from jaxkin.geometry.pose import Pose

SIX = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
"""Names of the entries of an inertia matrix in URDF and SDF, in the order of `inertial`."""
ROUNDED = 1e-6
"""Least eigenvalue of an inertia over its largest one, below zero, that still counts as rounding of the file."""


def inertial(mass: float, place: Pose, six: Sequence[float] | np.ndarray, where: str) -> Inertial:
    """Make the inertial of a link of the place of its centre and axes, and xx, yy, zz, xy, xz, yz of its inertia there.

    Raises ValueError for a mass below zero, and for a matrix that no distribution of mass has.
    """
    if mass < 0:
        raise ValueError(f"{where}: expected a mass from 0 on, got {mass:g}")
    xx, yy, zz, xy, xz, yz = map(float, six)
    matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    least, *_, largest = np.linalg.eigvalsh(matrix)
    if least < -ROUNDED * abs(largest):
        raise ValueError(f"{where}: expected an inertia without negative eigenvalues, got {list(map(float, six))}")
    turn = place[:3, :3]
    return Inertial(mass, place[:3, 3].copy(), turn @ matrix @ turn.T)
