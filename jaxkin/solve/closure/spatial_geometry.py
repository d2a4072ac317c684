"""Compute the constants of loops in space: where their chains begin and end, and the poses between their steps."""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry.patches import FollowedSpline
from jaxkin.solve.closure.rod_spin import Lines, spin_lines
from jaxkin.solve.system.chain_tables import Z_AXIS, chain_tables
from jaxkin.solve.system.joints import inverse_poses
from jaxkin.solve.system.loop_system import LoopSystem


class Spatial(NamedTuple):
    """Constants of the loops, lengths divided by the characteristic length, in frames about the centroid."""

    between: Float[Array, "steps distinct 4 4"]
    """The constant pose of the frame of each step relative to the frame behind the step before."""
    begin: Float[Array, "chains 4 4"]
    """The constant pose of the begin of the chain relative to that of the distinct chain with the same rows."""
    end: Float[Array, "chains 4 4"]
    """The constant pose of the end of the chain relative to the frame behind its last step."""
    pitch: Float[Array, " joints"]
    """Advance of the screws of each joint for a full turn."""
    lines: Lines
    """Lines of the idle spins, unit vectors: see `rod_spin`."""
    centres: Float[Array, "3 spherical"]
    """Points about which the spherical loops turn, of `LoopSystem.sections`."""
    curves: tuple[FollowedSpline, ...] = ()
    """The curves of `LoopSystem.curves`."""


def spatial_geometry(
    system: LoopSystem,
    frames: Float[Array, "frames 4 4"],
    pitch: Float[Array, " joints"],
    curves: tuple[FollowedSpline, ...] = (),
) -> Spatial:
    """Compute the constants of the loops from scaled frames: those on part 1, those on part 2, and the identity."""
    table = chain_tables(system)
    # from behind each step, and from the begin of the chain, to the next step, and to the end of the chain
    upright = np.full_like(table.axis[:1], Z_AXIS)
    behind = np.concatenate([table.begin[None], table.leave]), np.concatenate([upright, table.axis])
    before = np.concatenate([table.enter, table.end[None]]), np.concatenate([table.axis, upright])
    which, axis = np.stack([behind, before], axis=1)
    # `AXES` moves the columns of frames round: column c is what column c + axis + 1 was
    columns = np.where(np.arange(4) < 3, (np.arange(4) + axis[..., None] + 1) % 3, 3)
    left, right = frames[which[..., None, None], np.arange(4)[:, None], columns[..., None, :]]
    between = inverse_poses(left) @ right
    own, of_distinct = frames[table.begin], frames[table.begin[table.distinct][table.same_rows_as]]
    return Spatial(
        between[:-1, table.distinct],
        inverse_poses(of_distinct) @ own,
        between[-1],
        pitch,
        spin_lines(system, frames),
        _centres(system, frames),
        curves,
    )


def _centres(system: LoopSystem, frames: Float[Array, "frames 4 4"]) -> Float[Array, "3 spherical"]:
    """Compute the point nearest to all axes of each spherical loop, from the frames on part 1 of its joints."""
    centres = [jnp.zeros((3, 0), frames.dtype)]
    for loop in system.sections.spherical:
        axes = system.axes(joint for joint, _ in system.loops[loop])
        of_frame, axis = np.array(axes).T
        direction, point = frames[of_frame, :3, axis], frames[of_frame, :3, 3]
        across = jnp.eye(3, dtype=frames.dtype) - direction[:, :, None] * direction[:, None]
        a, b, c = jnp.sum(across, axis=0)
        right = jnp.einsum("aij,aj->i", across, point)
        normals = jnp.stack([jnp.cross(b, c), jnp.cross(c, a), jnp.cross(a, b)])
        centres.append((right @ normals / (a @ normals[0]))[:, None])
    return jnp.concatenate(centres, axis=1)
