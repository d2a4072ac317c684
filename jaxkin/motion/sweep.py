"""The sweep: displacements of all joints for given displacements of some, over a whole range (Section 5)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes, lax
from jaxtyping import Array, Float, Int

from jaxkin.geometry.traced import traced
from jaxkin.joints.joint import Joint
from jaxkin.motion.dead_ends import dead_end
from jaxkin.motion.drive import Driven, resolve
from jaxkin.motion.mechanism import Mechanism
from jaxkin.motion.motion import Motion
from jaxkin.motion.systems import block_joints, block_system
from jaxkin.solve.compiled import solve
from jaxkin.solve.methods import CONTINUATION, METHODS
from jaxkin.solve.status import Status, Tolerance
from jaxkin.solve.status import tolerance as default_tolerance
from jaxkin.solve.sweep import Poses
from jaxkin.solve.system import Form
from jaxkin.topology.names import nearest
from jaxkin.topology.structure import Block

SEVERITY = (Status.CLOSED, Status.JUMPED, Status.UNREACHABLE, Status.STALLED, Status.NONFINITE)
"""Of several loop systems the worst decides the status of the pose."""


def sweep(
    mechanism: Mechanism, drive: Mapping[str, object], *, tolerance: float | None = None, method: str = CONTINUATION
) -> Motion:
    """The motion of all parts while some joint coordinates run through given displacements.

    `drive` maps "joint" (if it has one coordinate) or "joint.coordinate" to an array of one value a pose: radians, or
    lengths in the unit of the mechanism, measured from the assembled pose. Several arrays must have equal length. The
    motion is followed from the assembled pose; a single input may come in any order, several are followed in the order
    given. Only loops that a driven joint moves are solved; coordinates that nothing drives stay at rest.

    A pose is closed where its residual is at most `tolerance`, and improved no further; by default 1e-12 (2e-6 in
    float32), and improved down to rounding. `method` names another way to find poses (`jaxkin.solve.methods.METHODS`):
    for comparison, none is as fast or watches the branch. `jk.work_precision` shows what either costs.

    Works inside `jax.jit`, `vmap` and `grad`. A pose that cannot be reached is reported in `motion.status`, it is never
    an exception. Raises ValueError for a drive that makes no sense (see `jaxkin.motion.drive.resolve`), or that the
    loops have no freedoms for (see `jaxkin.motion.dead_ends.dead_end`; not where the geometry is traced).
    """
    driven = resolve(mechanism, drive)
    _refuse_dead_ends(mechanism, driven)
    asked = _tolerance(tolerance)
    if method not in METHODS:
        raise ValueError(f"there is no method {method!r}{nearest(method, METHODS)}; there are {', '.join(METHODS)}")
    _warn_of_float32()
    values = tuple(entry.values for entry in driven.values())
    poses = values[0].shape[0]
    solutions, blocks = [], []
    for block, form in zip(mechanism.structure.blocks, mechanism.forms, strict=True):
        inside = [entry for entry in driven.values() if entry.joint in block.joints]
        if poses and (inside or _edited([mechanism.all_joints[joint] for joint in block.joints])):
            solutions.append(_solve_block(mechanism, block, form, inside, method, asked))
            blocks.append(block.joints)
    layout = Layout(
        tuple(joint.freedoms for joint in mechanism.all_joints),
        tuple((entry.joint, entry.coordinate) for entry in driven.values()),
        tuple(blocks),
    )
    return Motion(mechanism, dict(zip(driven, values, strict=True)), *_collect(layout, values, solutions))


def _solve_block(
    mechanism: Mechanism, block: Block, form: Form, driven: list[Driven], method: str, tolerance: Tolerance
) -> tuple[Float[Array, "columns padded"], Poses]:
    """Displacements and poses of one structure element. Without a drive: one pose for all."""
    driven = sorted(driven, key=lambda entry: (block.joints.index(entry.joint), entry.coordinate))
    system = block_system(mechanism, block, tuple((entry.joint, entry.coordinate) for entry in driven), form)
    dtype = driven[0].values.dtype if driven else dtypes.canonicalize_dtype(float)
    inputs = _padded([entry.values for entry in driven], dtype)
    return solve(system, method, block_joints(mechanism, block), inputs, tolerance)


def _tolerance(asked: float | None) -> Tolerance:
    """The tolerance asked for; without one that of the precision, and poses down to rounding."""
    dtype = dtypes.canonicalize_dtype(float)  # numbers of the host: to make arrays of the device takes longer
    if asked is None:
        return Tolerance(np.asarray(default_tolerance(dtype), dtype), np.zeros((), dtype))
    if not traced(asked) and not float(asked) > 0:
        raise ValueError(f"tolerance must be a positive number such as 1e-9, got {asked!r}")
    given = jnp.asarray(asked, dtype) if traced(asked) else np.asarray(asked, dtype)
    return Tolerance(given, given)


class Layout(NamedTuple):
    """Where the displacements of the joints come from (static)."""

    freedoms: tuple[int, ...]
    """Of every joint."""
    driven: tuple[tuple[int, int], ...]
    """Joint and coordinate of every input."""
    blocks: tuple[tuple[int, ...], ...]
    """Joints of every structure element that was solved."""


@partial(jax.jit, static_argnums=0)
def _collect(
    layout: Layout,
    values: tuple[Float[Array, " poses"], ...],
    solutions: list[tuple[Float[Array, "_ _"], Poses]],
) -> tuple[tuple[Float[Array, "poses _"], ...], Int[Array, " poses"], Float[Array, " poses"]]:
    """Displacements of all joints, status and closure residual: the worst of the structure elements decides."""
    poses, dtype = values[0].shape[0], values[0].dtype
    displacements = [jnp.zeros((poses, freedoms), dtype) for freedoms in layout.freedoms]
    for (joint, coordinate), given in zip(layout.driven, values, strict=True):
        displacements[joint] = displacements[joint].at[:, coordinate].set(given)
    rank = jnp.array([SEVERITY.index(status) for status in Status], jnp.int32)
    worst = jnp.where(jnp.isfinite(values[0]), 0, SEVERITY.index(Status.NONFINITE)).astype(jnp.int32)
    square = jnp.zeros(poses, dtype)
    for joints, (coordinates, found) in zip(layout.blocks, solutions, strict=True):
        first = 0
        for joint in joints:
            rows = coordinates[first : first + layout.freedoms[joint], :poses].T
            displacements[joint] = jnp.broadcast_to(rows, (poses, layout.freedoms[joint]))
            first += layout.freedoms[joint]
        worst = jnp.maximum(worst, rank[found.status[:poses]])
        square = square + found.gap[:poses] ** 2
    status = jnp.array([status.value for status in SEVERITY], jnp.int32)[worst]
    return tuple(displacements), status, jnp.sqrt(square)


def _padded(rows: list[Float[Array, " poses"]], dtype) -> Float[Array, "driven padded"]:
    """The inputs, the last pose repeated up to one of few lengths: ranges of similar length share a compiled program.

    A power of two from 32 to 512 poses, above that a multiple of an eighth of one. Traced inputs are left alone: their
    program is compiled for their length anyway.
    """
    if not rows:
        return jnp.zeros((0, 1), dtype)
    poses = rows[0].shape[0]
    power = 2 ** max(5, (poses - 1).bit_length())
    length = power if power <= 512 else -(-poses // (power // 16)) * (power // 16)
    if not traced(rows):
        # on the host: there it costs a copy, not a program for every length
        return jnp.asarray(np.pad(np.stack([np.asarray(row) for row in rows]), ((0, 0), (0, length - poses)), "edge"))
    inputs = jnp.stack(rows)
    return inputs if traced(lax.stop_gradient(inputs)) else jnp.pad(inputs, ((0, 0), (0, length - poses)), mode="edge")


def _refuse_dead_ends(mechanism: Mechanism, driven: Mapping[str, Driven]) -> None:
    if traced(mechanism) or not all(np.all(np.isfinite(leaf)) for leaf in jax.tree.leaves(mechanism)):
        return
    if text := dead_end(mechanism, [(entry.joint, entry.coordinate) for entry in driven.values()]):
        raise ValueError(text)


def _edited(joints: list[Joint]) -> bool:
    """Whether the loops may be open at the assembled pose: after a change of lengths, or where numbers are traced."""
    return traced(joints) or any(not np.array_equal(joint.before, joint.after) for joint in joints)


_warned = False


def _warn_of_float32() -> None:
    global _warned  # noqa: PLW0603
    if _warned or dtypes.canonicalize_dtype(float) == jnp.float64:
        return
    _warned = True
    warnings.warn(
        "jaxkin computes in float32: loops close to about 5e-7 of the size. For 1e-15 write "
        'jax.config.update("jax_enable_x64", True) before the first array is made.',
        stacklevel=4,
    )
