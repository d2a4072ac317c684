"""Rigid poses as 4x4 matrices, on the host (numpy, float64).

A pose F maps local coordinates to world coordinates; a displacement D maps points of the world to their new places, in
world coordinates. A motion T in a local frame F makes the displacement D = F T F^-1 (the paper's M^-1 T M with
M = F^-1).
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

Vector = Float[np.ndarray, "3"]
Points = Float[np.ndarray, "*batch 3"]
Transform = Float[np.ndarray, "4 4"]
"""Rotation matrix and translation, the last row 0, 0, 0, 1: a pose or a displacement."""

_IDENTITY = np.eye(4)

RIGID_TOLERANCE = 1e-6
"""Largest error of the entries of a matrix that is taken for a rigid pose: poses that went through single precision are
rigid to a few times 1e-7."""


def unit(vector: Vector) -> Vector:
    """Divide a vector by its length; ValueError for a zero or non-finite vector."""
    vector = np.asarray(vector, float)
    length = float(np.linalg.norm(vector))
    if not np.isfinite(length) or length == 0.0:
        raise ValueError(f"a direction must be a finite vector of non-zero length, got {vector.tolist()}")
    return vector / length


def perpendicular(direction: Vector) -> Vector:
    """Choose a unit vector perpendicular to a unit direction by a fixed rule: equal input gives equal output."""
    least = np.eye(3)[int(np.argmin(np.abs(direction)))]
    return unit(least - (least @ direction) * direction)


def frame(origin: Vector, z: Vector, x: Vector | None = None) -> Transform:
    """Make the pose of a right-handed frame with the given z axis; its x axis is `x` projected perpendicular to z."""
    z = unit(z)
    x = perpendicular(z) if x is None else unit(np.asarray(x, float) - (np.asarray(x, float) @ z) * z)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = x, cross(z, x), z, origin
    return pose


def inverse(pose: Transform) -> Transform:
    """Invert a rigid pose, by transposition of its rotation."""
    result, turn = _IDENTITY.copy(), pose[:3, :3].T
    result[:3, :3] = turn
    result[:3, 3] = -turn @ pose[:3, 3]
    return result


def cross(a: Vector, b: Vector) -> Vector:
    """Compute the cross product of two single vectors, ten times as fast as `np.cross`, which is made for many."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def skew(vector: Vector) -> Float[np.ndarray, "3 3"]:
    """Make the matrix whose product with a vector is the cross product of `vector` with it."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def is_rigid(matrix: Transform) -> bool:
    """Check whether a 4x4 matrix is a right-handed rotation R with a translation, within `RIGID_TOLERANCE`.

    That is: all entries are finite, R^T R = I, det R = 1, and the last row is 0, 0, 0, 1.
    """
    turn = matrix[:3, :3]
    if not np.all(np.abs(turn) <= 1 + RIGID_TOLERANCE):  # their squares may be no numbers
        return False
    errors = np.concatenate([(turn.T @ turn - np.eye(3)).ravel(), matrix[3] - [0.0, 0.0, 0.0, 1.0]])
    return bool(np.all(np.isfinite(matrix)) and np.abs(errors).max() <= RIGID_TOLERANCE and np.linalg.det(turn) > 0)


def rotation(axis: Vector, angle: float) -> Float[np.ndarray, "3 3"]:
    """Make the matrix of a rotation about a unit axis by an angle in radians, right-hand rule (Rodrigues)."""
    turned = skew(axis)
    return np.eye(3) + np.sin(angle) * turned + (1.0 - np.cos(angle)) * (turned @ turned)


def apply(pose: Transform, points: Points) -> Points:
    """Map points from the local coordinates of a pose to world coordinates, or move them by a displacement."""
    return points @ pose[:3, :3].T + pose[:3, 3]


def turned_by(pose: Transform) -> float:
    """Measure the angle of the rotation of a pose, radians, 0 to pi."""
    turn = pose[:3, :3]
    sine = np.linalg.norm([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return float(np.arctan2(sine, np.trace(turn) - 1.0))
