"""The axes of the elementary motions of a loop system in the assembled pose (host code: numpy, no compilation).

The closure of a chain is E_1(q_1) E_2(q_2) ... E_n(q_n) M = 1. Every E is a turn about, or a slide along, its axis in
the assembled pose; M is what is left open there, and 1 unless dimensions were changed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Float

from jaxkin.solve.system.chain_tables import AXES, chain_tables
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem

Numbers = Float[Array | np.ndarray, "..."]


class Axes(NamedTuple):
    """The axes of all rows of `ChainTables`, lengths over the characteristic length, origin in the centroid.

    Vectors have two entries in planar systems, in the plane; a turn has no `direction` there. Those of a loop that is
    cut at a ball are in the frame behind that ball.
    """

    direction: Numbers
    """(rows, chains, 2 or 3): unit vectors."""
    centre: Numbers
    """(rows, chains, 2 or 3): points of the axes."""
    sense: Numbers
    """(rows, chains): 1, or -1 where the coordinate counts backwards, as the chain is travelled; 0 for no motion."""
    advance: Numbers
    """(rows, chains): slide for a coordinate of 1, in the direction."""
    open_turn: Numbers
    """(chains, 2 or 3, 2 or 3): rotation that is left open."""
    open_shift: Numbers
    """(chains, 2 or 3): translation that is left open."""
    off_plane: Numbers
    """Squared residual out of the plane (Eq. 12), which no motion in the plane can close."""
    length: Numbers
    """The characteristic length."""


def assembled_axes(system: LoopSystem, joints: Joints) -> Axes:
    """Find the axes from the frames of the joints, which must be numbers."""
    table = chain_tables(system)
    frames_1, frames_2 = ([np.asarray(frames, float) for frames in side] for side in joints[:2])
    origins = np.concatenate([frames[:, :3, 3] for frames in frames_1])
    centre = origins.mean(axis=0)
    radius = np.sqrt(np.mean(np.sum((origins - centre) ** 2, axis=1)))
    length = radius if radius > 0 else 1.0
    frames = np.concatenate([*frames_1, *frames_2])
    frames[:, :3, 3] = (frames[:, :3, 3] - centre) / length
    frames = np.concatenate([frames, np.eye(4)[None]])

    pose, poses = _inverse(frames[table.begin]), []
    for enter, leave, axis in zip(table.enter, table.leave, table.axis, strict=True):
        along = np.zeros((len(axis), 4, 4))
        along[:, :3, :3], along[:, 3, 3] = AXES[axis], 1.0
        poses.append(pose @ frames[enter] @ along)
        pose = poses[-1] @ _inverse(frames[leave] @ along)
    found, last = np.stack(poses), pose @ frames[table.end]
    direction, point = found[..., :3, 2], found[..., :3, 3]
    sense = table.sign * ((table.turn + table.slide) > 0)
    pitch = np.asarray([float(pitch) for pitch in joints.pitch]) / length
    advance = table.slide + table.screw * pitch[table.joint] / (2 * np.pi)
    turn, shift = last[:, :3, :3], last[:, :3, 3]
    if not system.planar:
        return Axes(direction, point, sense.astype(float), advance, turn, shift, np.zeros(()), np.asarray(length))

    moves = table.column < system.columns
    row, chain = np.argwhere(moves & (table.turn > 0))[0]
    plane, normal = found[row, chain, :3, :2].T, direction[row, chain]
    turns = moves & (table.turn > 0)
    tilt = np.where(turns, np.sum(np.cross(direction, normal) ** 2, axis=-1), (direction @ normal) ** 2)
    off = np.sum(tilt[moves]) + np.sum((turn @ normal - normal) ** 2) + np.sum((shift @ normal) ** 2)
    sense = np.where(turns, sense * np.sign(direction @ normal), sense)
    flat = np.einsum("ai,cij,bj->cab", plane, turn, plane)
    return Axes(direction @ plane.T, point @ plane.T, sense, advance, flat, shift @ plane.T, off, np.asarray(length))


def _inverse(poses: Float[np.ndarray, "chains 4 4"]) -> Float[np.ndarray, "chains 4 4"]:
    turned = poses[:, :3, :3].swapaxes(1, 2)
    found = np.zeros_like(poses)
    found[:, :3, :3], found[:, 3, 3] = turned, 1.0
    found[:, :3, 3] = -np.einsum("cij,cj->ci", turned, poses[:, :3, 3])
    return found
