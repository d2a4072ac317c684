"""The screw motion between two poses, and displacements along it."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import skew

SMALL = 1e-4
"""Angle in radians below which sines are taken as their series: the next terms are a^2/24 of those kept, rounding."""


def screw_between(one: np.ndarray, other: np.ndarray) -> Float[np.ndarray, "6"]:
    """Find the constant twist (rotation, velocity of the origin) that moves one pose to another in a unit of time."""
    from scipy.spatial.transform import Rotation

    change = other @ np.linalg.inv(one)
    turn = Rotation.from_matrix(change[:3, :3]).as_rotvec()
    return np.concatenate([turn, np.linalg.solve(_mean_rotation(turn), change[:3, 3])])


def displacement_along(velocity: np.ndarray, share: float) -> Float[np.ndarray, "4 4"]:
    """Compute the displacement by a share of a screw motion."""
    from scipy.spatial.transform import Rotation

    found = np.eye(4)
    turn = share * velocity[:3]
    found[:3, :3] = Rotation.from_rotvec(turn).as_matrix()
    found[:3, 3] = _mean_rotation(turn) @ (share * velocity[3:])
    return found


def _mean_rotation(turn: np.ndarray) -> Float[np.ndarray, "3 3"]:
    """Compute the mean of all rotations up to a rotation vector: 1 + (1 - cos a)/a^2 W + (a - sin a)/a^3 W^2."""
    cross = skew(turn)
    angle = float(np.linalg.norm(turn))
    if angle < SMALL:
        return np.eye(3) + cross / 2 + cross @ cross / 6
    return np.eye(3) + (1 - np.cos(angle)) / angle**2 * cross + (angle - np.sin(angle)) / angle**3 * cross @ cross
