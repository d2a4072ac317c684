"""Find the axes of the elementary motions of a loop system in the assembled pose.

The closure of a chain is E_1(q_1) E_2(q_2) ... E_n(q_n) M = 1. Every E is a turn about, or a slide along, its axis in
the assembled pose; M is what is left open there, and 1 unless dimensions were changed.
"""

from __future__ import annotations

from itertools import accumulate
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._traced import traced
from jaxkin.geometry.trig import TURN
from jaxkin.solve.closure.planar import squared_off_plane
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.joints import Joints, inverse_poses, scaled_frames
from jaxkin.solve.system.loop_system import LoopSystem


class AssembledAxes(NamedTuple):
    """The axes of all rows of `ChainTables`, lengths over the characteristic length, origin in the centroid.

    Vectors have two components, in the plane, in planar systems; a turn has no `direction` there. The axes of a loop
    that is cut at a ball are in the frame behind that ball.
    """

    direction: Float[Array | np.ndarray, "rows chains components"]
    """Unit vectors."""
    centre: Float[Array | np.ndarray, "rows chains components"]
    """Points of the axes."""
    sense: Float[Array | np.ndarray, "rows chains"]
    """1, or -1 where the coordinate counts backwards, as the chain is travelled; 0 for no motion."""
    advance: Float[Array | np.ndarray, "rows chains"]
    """Slide for a coordinate of 1, in the direction."""
    open_turn: Float[Array | np.ndarray, "chains components components"]
    """Rotation that is left open."""
    open_shift: Float[Array | np.ndarray, "chains components"]
    """Translation that is left open."""
    off_plane: Float[Array | np.ndarray, ""]
    """Squared residual out of the plane (Eq. 12), which no motion in the plane can close."""
    length: Float[Array | np.ndarray, ""]
    """The characteristic length."""


def assembled_axes(system: LoopSystem, joints: Joints) -> AssembledAxes:
    """Find the axes from the frames of the joints: in NumPy, without compiling anything, unless JAX traces them."""
    xp: Any = jnp if traced(joints) else np
    table = chain_tables(system)
    frames, length = scaled_frames(joints.frames_1, joints.frames_2, xp)
    # columns that are moved bring the axis of each motion to z
    columns = np.concatenate([(table.axis[..., None] + [1, 2, 3]) % 3, np.full((*table.axis.shape, 1), 3)], axis=-1)

    def seen_along(which: np.ndarray) -> Any:
        return frames[which[..., None, None], np.arange(4)[:, None], columns[:, :, None, :]]

    # each from where the motion before ends to where this one begins, all at once
    before = xp.concatenate([frames[table.begin][None], seen_along(table.leave)])
    then = xp.concatenate([seen_along(table.enter), frames[table.end][None]])
    first, *others = _product(inverse_poses(before, xp), then)
    poses = list(accumulate(others, _product, initial=first))
    found, last = xp.stack(poses[:-1]), poses[-1]
    direction, point = found[..., :3, 2], found[..., :3, 3]
    sense = (table.sign * ((table.turn + table.slide) > 0)).astype(float)
    pitch = xp.stack([xp.asarray(pitch, float) for pitch in joints.pitch]) / length
    advance = table.slide + table.screw * pitch[table.joint] / TURN
    turn, shift = last[:, :3, :3], last[:, :3, 3]
    if not system.planar:
        return AssembledAxes(direction, point, sense, advance, turn, shift, xp.zeros(()), length)

    moves = table.column < system.columns
    turns = moves & (table.turn > 0)
    row, chain = np.argwhere(turns)[0]
    plane, normal = found[row, chain, :3, :2].T, direction[row, chain]
    off_plane = squared_off_plane(direction, turns, moves, normal, last, xp)
    sense = xp.where(turns, sense * xp.sign(direction @ normal), sense)
    flat = _product(_product(plane, turn), plane.T)
    return AssembledAxes(
        _product(direction, plane.T),
        _product(point, plane.T),
        sense,
        advance,
        flat,
        _product(shift, plane.T),
        off_plane,
        length,
    )


def _product(one: Any, other: Any) -> Any:
    """Multiply small matrices, many at once: as a sum of products, for which XLA takes a twentieth of the time that it
    takes for products of matrices on a CPU (jaxlib 0.10.2)."""
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return one @ other
    return sum(one[..., k, None] * other[..., k, None, :] for k in range(one.shape[-1]))
