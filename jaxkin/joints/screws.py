"""Chains of movements on the host (numpy, float64): displacements, screws, and the fit to a given displacement.

The products are those of `geometry.movements` in JAX, for decisions that must not depend on the precision of the
device.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import repeat
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.elementary_motions import amount, displaced_columns, rates
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import FollowedSpline
from jaxkin.geometry.pose import Transform, cross, inverse, skew
from jaxkin.joints.joint import Joint

DEPENDENT = 1e-9
"""Singular value of the screws of a joint, lengths scaled to the size of the mechanism, at which they are dependent.
Screws of one joint are unit twists at a few lever arms and dependent exactly or not at all: 1e-9 is above their
rounding, 1e-14, and a hundred times below the rank threshold of whole loops (`linkage.first_order.RANK_TOLERANCE`)."""

Frames = Float[np.ndarray, "frames 4 4"]
Screws = Float[np.ndarray, "6 freedoms"]
"""Columns (w; v): angular velocity, and velocity of the point of the body at the origin of the world."""


def chain(
    movements: Sequence[str],
    frames: Frames,
    q: Float[np.ndarray, "freedoms"],
    pitch: float = 0.0,
    frames_2: Frames | None = None,
    splines: Sequence[FollowedSpline | None] = (),
) -> tuple[Transform, Screws]:
    """Compute the displacement D of part 2 relative to part 1 in world coordinates, and the screws of its freedoms.

    `q` holds the coordinates of the movements, one after the other. Column k of the screws is the twist S_k with
    dD/dq_k = [S_k] D. `pitch` is the advance of a screw per turn; `frames_2` are the frames on the side of part 2, by
    default those of part 1; `splines` what the movements follow, where they follow something.
    """
    pose, screws = np.eye(4), np.zeros((6, len(q)))
    leaves = frames if frames_2 is None else frames_2
    numbered = zip(movements, coordinate_ranges(movements), frames, leaves, splines or repeat(None), strict=False)
    for movement, own, frame, leave, spline in numbered:
        columns = list((pose @ frame).T)
        point = None if spline is None else spline.at(*q[own.start : own.stop])
        for element in MOVEMENTS[movement].elements:
            k = own[element.coordinate]
            axis, origin = columns[element.axis][:3], columns[3][:3]
            slides, turns = rates(element, pitch, point)
            screws[:3, k] += turns * axis
            screws[3:, k] += turns * cross(origin, axis) + slides * axis
            columns = displaced_columns(columns, element.axis, *amount(element, q[k], pitch, point, _cos_sin))
        pose = np.array(columns).T @ inverse(leave)
    return pose, screws


def displacements(joint: Joint, q: Float[np.ndarray, "poses freedoms"]) -> Float[np.ndarray, "3 4 poses"]:
    """Compute the displacements of part 2 of a joint relative to part 1, in world coordinates, for many poses."""
    if not joint.freedoms and np.array_equal(joint.frames_1, joint.frames_2):
        return np.broadcast_to(np.eye(4)[:3, :, None], (3, 4, len(q)))  # exactly, whatever the frames round to
    found, owns = np.eye(4)[:3, :, None], coordinate_ranges(joint.movements)
    numbered = zip(joint.movements, owns, joint.frames_1, joint.frames_2, joint.splines, strict=True)
    for movement, own, frame_1, frame_2, spline in numbered:
        found = np.einsum("ikn,kj->ijn", found, np.asarray(frame_1, float))
        point = None if spline is None else spline.at(*q[:, own.start : own.stop].T)
        for element in MOVEMENTS[movement].elements:
            how_far = amount(element, q[:, own[element.coordinate]], float(joint.pitch), point, _cos_sin)
            columns = displaced_columns([found[:, column] for column in range(4)], element.axis, *how_far)
            found = np.stack(np.broadcast_arrays(*columns), axis=1)
        found = np.einsum("ikn,kj->ijn", found, inverse(np.asarray(frame_2, float)))
    return np.broadcast_to(found, (3, 4, len(q)))


def _cos_sin(angle: Any) -> tuple[Any, Any]:
    return np.cos(angle), np.sin(angle)


def inverses(poses: Float[np.ndarray, "3 4 poses"]) -> Float[np.ndarray, "3 4 poses"]:
    """Invert displacements: rotation R^T, translation -R^T t."""
    rotated = poses[:, :3].swapaxes(0, 1)
    return np.concatenate([rotated, -np.einsum("ijn,jn->in", rotated, poses[:, 3])[:, None]], axis=1)


def products(
    one: Float[np.ndarray, "3 4 poses"], other: Float[np.ndarray, "3 4 poses"]
) -> Float[np.ndarray, "3 4 poses"]:
    """Multiply displacements pose by pose: first `other`, then `one`, in world coordinates."""
    found = one[:, 0, None] * other[None, 0] + one[:, 1, None] * other[None, 1] + one[:, 2, None] * other[None, 2]
    found[:, 3] += one[:, 3]
    return found


def complement(screws: Screws) -> Float[np.ndarray, "constraints 6"]:
    """Find an orthonormal basis of the constraints: rows that vanish on all given screws.

    Singular values of the screws up to `DEPENDENT` count as zero.
    """
    basis, strengths, _ = np.linalg.svd(screws, full_matrices=True)
    return basis[:, int(np.sum(strengths > DEPENDENT)) :].T


def moved(pose: Transform, screws: Screws) -> Screws:
    """Displace screws together with the body that they belong to."""
    adjoint = np.zeros((6, 6))
    adjoint[:3, :3] = adjoint[3:, 3:] = pose[:3, :3]
    adjoint[3:, :3] = skew(pose[:3, 3]) @ pose[:3, :3]
    return adjoint @ screws


def freedoms(movements: Sequence[str]) -> int:
    """Count the coordinates of a chain."""
    return sum(len(MOVEMENTS[movement].coordinates) for movement in movements)


def misfit(movements: Sequence[str], frames: Frames, displacement: Transform) -> float:
    """Measure how near a chain comes to a displacement, starting at the assembled pose: zero if the chain allows it.

    Gauss-Newton steps on the twist from the displacement reached to the one wanted. The result is the Frobenius norm of
    their difference, with radians and the unit of the frames taken as equal.
    """
    q = np.zeros(freedoms(movements))
    best = np.inf
    for _ in range(12):  # from a radian away: some steps of approach, then quadratic convergence
        reached, screws = chain(movements, frames, q)
        missing = displacement @ inverse(reached)
        twice = missing[:3, :3] - missing[:3, :3].T
        twist = np.array([twice[2, 1] / 2, twice[0, 2] / 2, twice[1, 0] / 2, *missing[:3, 3]])
        size = float(np.linalg.norm(missing - np.eye(4)))
        if size < 1e-13 or len(q) == 0:
            return size
        best = min(best, size)
        q = q + np.linalg.lstsq(screws, twist, rcond=1e-10)[0]
    return best
