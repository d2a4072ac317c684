"""The sweep: displacements of all joints for given displacements of some, over a whole range (Section 5)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.traced import traced
from jaxkin.joints.joint import Joint
from jaxkin.motion.dead_ends import dead_end
from jaxkin.motion.drive import Driven, resolve
from jaxkin.motion.mechanism import Mechanism
from jaxkin.motion.motion import Motion
from jaxkin.motion.systems import block_joints, block_system
from jaxkin.solve.compiled import solve
from jaxkin.solve.status import Status
from jaxkin.solve.sweep import Poses
from jaxkin.topology.structure import Block

SEVERITY = (Status.CLOSED, Status.JUMPED, Status.UNREACHABLE, Status.STALLED, Status.NONFINITE)
"""Of several loop systems the worst decides the status of the pose."""


def sweep(mechanism: Mechanism, drive: Mapping[str, object]) -> Motion:
    """The motion of all parts while some joint coordinates run through given displacements.

    `drive` maps "joint" (if it has one coordinate) or "joint.coordinate" to an array of one value a pose: radians, or
    lengths in the unit of the mechanism, measured from the assembled pose. Several arrays must have equal length. The
    motion is followed from the assembled pose; a single input may come in any order, several are followed in the order
    given. Only loops that a driven joint moves are solved; coordinates that nothing drives stay at rest.

    Works inside `jax.jit`, `vmap` and `grad`. A pose that cannot be reached is reported in `motion.status`, it is never
    an exception. Raises ValueError for a drive that makes no sense (see `jaxkin.motion.drive.resolve`), or that the
    loops have no freedoms for (see `jaxkin.motion.dead_ends.dead_end`; not where the geometry is traced).
    """
    driven = resolve(mechanism, drive)
    _refuse_dead_ends(mechanism, driven)
    _warn_of_float32()
    first = next(iter(driven.values())).values
    displacements: list[Float[Array, "poses _"]] = [
        jnp.zeros((first.shape[0], joint.freedoms), first.dtype) for joint in mechanism.all_joints
    ]
    for entry in driven.values():
        displacements[entry.joint] = displacements[entry.joint].at[:, entry.coordinate].set(entry.values)
    solutions = []
    for block in mechanism.structure.blocks:
        inputs = {name: entry for name, entry in driven.items() if entry.joint in block.joints}
        if len(first) and (inputs or _edited([mechanism.all_joints[joint] for joint in block.joints])):
            solutions.append(_solve_block(mechanism, block, list(inputs.values()), displacements))
    status, residual = _worst(solutions, first)
    inputs = {name: entry.values for name, entry in driven.items()}
    return Motion(mechanism, inputs, tuple(displacements), status, residual)


def _solve_block(mechanism: Mechanism, block: Block, driven: list[Driven], displacements: list[Array]) -> Poses:
    """One structure element solved; its joints' displacements are set in place. Without a drive: one pose for all."""
    driven = sorted(driven, key=lambda entry: (block.joints.index(entry.joint), entry.coordinate))
    system = block_system(mechanism, block, tuple((entry.joint, entry.coordinate) for entry in driven))
    dtype, poses = displacements[0].dtype, displacements[0].shape[0]
    inputs = jnp.stack([entry.values for entry in driven]) if driven else jnp.zeros((0, 1), dtype)
    coordinates, found = solve(system, block_joints(mechanism, block, dtype), _padded(inputs))
    coordinates, found = jax.tree.map(lambda rows: rows[..., : inputs.shape[1]], (coordinates, found))
    first = 0
    for joint in block.joints:
        freedoms = mechanism.all_joints[joint].freedoms
        rows = coordinates[first : first + freedoms].T
        displacements[joint] = jnp.broadcast_to(rows, (poses, freedoms))
        first += freedoms
    return found


def _padded(inputs: Float[Array, "driven poses"]) -> Float[Array, "driven padded"]:
    """The last pose repeated up to one of few lengths, so that ranges of similar length share one compiled program.

    A power of two from 32 to 512 poses, above that a multiple of an eighth of one. Traced inputs are left alone: their
    program is compiled for their length anyway.
    """
    poses = inputs.shape[1]
    if traced(lax.stop_gradient(inputs)):
        return inputs
    power = 2 ** max(5, (poses - 1).bit_length())
    length = power if power <= 512 else -(-poses // (power // 16)) * (power // 16)
    return jnp.pad(inputs, ((0, 0), (0, length - poses)), mode="edge")


def _refuse_dead_ends(mechanism: Mechanism, driven: Mapping[str, Driven]) -> None:
    if traced(mechanism) or not all(np.all(np.isfinite(leaf)) for leaf in jax.tree.leaves(mechanism)):
        return
    if text := dead_end(mechanism, [(entry.joint, entry.coordinate) for entry in driven.values()]):
        raise ValueError(text)


def _edited(joints: list[Joint]) -> bool:
    """Whether the loops may be open at the assembled pose: after a change of lengths, or where numbers are traced."""
    return traced(joints) or any(not np.array_equal(joint.before, joint.after) for joint in joints)


def _worst(solutions: list[Poses], like: Float[Array, " poses"]) -> tuple[Array, Array]:
    """Status and residual of the mechanism from those of its loop systems."""
    rank = jnp.zeros(len(Status), int).at[jnp.array([s.value for s in SEVERITY])].set(jnp.arange(len(Status)))
    worst, square = jnp.zeros(like.shape, int), jnp.zeros_like(like)
    for solution in solutions:
        worst = jnp.maximum(worst, rank[solution.status])
        square = square + solution.gap**2
    status = jnp.array([s.value for s in SEVERITY], jnp.int32)[worst]
    return jnp.where(jnp.isfinite(like), status, Status.NONFINITE.value).astype(jnp.int32), jnp.sqrt(square)


_warned = False


def _warn_of_float32() -> None:
    global _warned  # noqa: PLW0603
    if _warned or jnp.zeros(()).dtype == jnp.float64:
        return
    _warned = True
    warnings.warn(
        "jaxkin computes in float32: loops close to about 5e-7 of the size. For 1e-15 write "
        'jax.config.update("jax_enable_x64", True) before the first array is made.',
        stacklevel=4,
    )
