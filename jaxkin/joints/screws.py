"""Chains of movements on the host (numpy, float64): displacements, screws, and the way back from a displacement.

The same products as `geometry.motions` in JAX, for decisions that must not depend on the precision of the device.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import Pose, inverse, rotation
from jaxkin.joints.joint import Joint

Frames = Float[np.ndarray, "frames 4 4"]
Screws = Float[np.ndarray, "6 freedoms"]
"""Columns (w; v): angular velocity, and velocity of the point of the body at the world's origin."""


def chain(
    movements: Sequence[str],
    frames: Frames,
    q: Float[np.ndarray, "freedoms"],
    pitch: float = 0.0,
    frames_2: Frames | None = None,
) -> tuple[Pose, Screws]:
    """The displacement of part 2 relative to part 1 in world coordinates, and the screws of the freedoms there.

    `q` holds the coordinates of the movements in turn. A column of the screws is the rate of the displacement for one
    coordinate; its product with the displacement is the derivative. `pitch` is the advance of a screw in a turn;
    `frames_2` are the frames on the side of part 2 where they are not those of part 1.
    """
    pose, screws = np.eye(4), np.zeros((6, len(q)))
    first = 0
    for movement, frame, leave in zip(movements, frames, frames if frames_2 is None else frames_2, strict=True):
        pose = pose @ frame
        for element in MOVEMENTS[movement].elements:
            k = first + element.coordinate
            axis, step = pose[:3, element.axis], np.eye(4)
            if element.kind != "translate":
                screws[:3, k], screws[3:, k] = axis, np.cross(pose[:3, 3], axis)
                step[:3, :3] = rotation(np.eye(3)[element.axis], q[k])
            if element.kind != "rotate":
                advance = 1.0 if element.kind == "translate" else pitch / (2 * np.pi)
                screws[3:, k] += advance * axis
                step[element.axis, 3] = advance * q[k]
            pose = pose @ step
        pose = pose @ inverse(leave)
        first += len(MOVEMENTS[movement].coordinates)
    return pose, screws


def displacements(joint: Joint, q: Float[np.ndarray, "poses freedoms"]) -> Float[np.ndarray, "3 4 poses"]:
    """The displacements of part 2 of a joint relative to part 1, in world coordinates, for many poses at once."""
    found, first = np.eye(4)[:3, :, None], 0
    for movement, frame_1, frame_2 in zip(joint.movements, joint.frames_1, joint.frames_2, strict=True):
        found = np.einsum("ikn,kj->ijn", found, np.asarray(frame_1, float))
        for element in MOVEMENTS[movement].elements:
            value = q[:, first + element.coordinate]
            columns = [found[:, column] for column in range(4)]
            i, j, k = (np.arange(3) + element.axis) % 3
            if element.kind != "rotate":
                advance = 1.0 if element.kind == "translate" else float(joint.pitch) / (2 * np.pi)
                columns[3] = columns[3] + advance * value * columns[i]
            if element.kind != "translate":
                cos, sin = np.cos(value), np.sin(value)
                columns[j], columns[k] = columns[j] * cos + columns[k] * sin, columns[k] * cos - columns[j] * sin
            found = np.stack(np.broadcast_arrays(*columns), axis=1)
        found = np.einsum("ikn,kj->ijn", found, inverse(np.asarray(frame_2, float)))
        first += len(MOVEMENTS[movement].coordinates)
    return np.broadcast_to(found, (3, 4, len(q)))


def inverses(poses: Float[np.ndarray, "3 4 poses"]) -> Float[np.ndarray, "3 4 poses"]:
    """The displacements back: R^T, and -R^T t for the origin."""
    turned = poses[:, :3].swapaxes(0, 1)
    return np.concatenate([turned, -np.einsum("ijn,jn->in", turned, poses[:, 3])[:, None]], axis=1)


def complement(screws: Screws) -> Float[np.ndarray, "constraints 6"]:
    """An orthonormal basis of what is forbidden: all rows vanish on the screws that are allowed."""
    basis, strengths, _ = np.linalg.svd(screws, full_matrices=True)
    return basis[:, int(np.sum(strengths > 1e-9)) :].T


def moved(pose: Pose, screws: Screws) -> Screws:
    """The screws of a body that has been displaced with them."""
    turned = pose[:3, :3] @ screws[:3]
    return np.concatenate([turned, pose[:3, :3] @ screws[3:] + np.cross(pose[:3, 3], turned, axisb=0, axisc=0)])


def freedoms(movements: Sequence[str]) -> int:
    """Number of coordinates of a chain."""
    return sum(len(MOVEMENTS[movement].coordinates) for movement in movements)


def misfit(movements: Sequence[str], frames: Frames, displacement: Pose) -> float:
    """How far the chain stays from a displacement, from the assembled pose on: zero if the joint allows it.

    Gauss-Newton on the twist that is missing; radians and the unit of the frames taken as equal.
    """
    q = np.zeros(freedoms(movements))
    best = np.inf
    for _ in range(12):  # from a radian away: some steps of approach, then the digits double
        reached, screws = chain(movements, frames, q)
        missing = displacement @ inverse(reached)
        skew = missing[:3, :3] - missing[:3, :3].T
        twist = np.array([skew[2, 1] / 2, skew[0, 2] / 2, skew[1, 0] / 2, *missing[:3, 3]])
        size = float(np.linalg.norm(missing - np.eye(4)))
        if size < 1e-13 or len(q) == 0:
            return size
        best = min(best, size)
        q = q + np.linalg.lstsq(screws, twist, rcond=1e-10)[0]
    return best
