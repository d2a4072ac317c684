"""Compute joint-motion matrices (Table 2) and displacements of parts (Section 5.2), over many poses at once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin._traced import inside_trace, traced
from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.movements import displaced
from jaxkin.geometry.rigid import Rigid, as_matrices, as_rigid, inverse, product
from jaxkin.joints.joint import Joint
from jaxkin.linkage.host_transforms import host_transforms
from jaxkin.linkage.linkage import Linkage
from jaxkin.topology.structure import Structure

JointDisplacements = tuple[Float[Array, "poses _"], ...]
"""For each joint of `Linkage.joints` its coordinates: radians, and lengths in the unit of the mechanism."""

MAX_HOST_POSES = 8192
"""Most poses of a range that is computed on the host, where nothing is compiled: of longer ones the program takes less
time, once it is there."""


def part_transforms(
    linkage: Linkage, displacements: tuple[Float[Array | np.ndarray, "poses _"], ...]
) -> tuple[Float[Array, "poses 4 4"], ...]:
    """Compute the displacements of all parts from the assembled pose, in the order of `linkage.parts`, in the world."""
    poses = displacements[0].shape[0]
    unknown = traced((linkage, displacements)) or inside_trace()
    if poses > MAX_HOST_POSES or unknown or _on_several_devices(displacements):
        return transforms(linkage.structure, linkage.joints, displacements)
    found = host_transforms(linkage.structure, linkage.joints, [np.asarray(q) for q in displacements])
    return jax.device_put(tuple(each.astype(displacements[0].dtype, copy=False) for each in found))


def _on_several_devices(displacements: tuple[Array | np.ndarray, ...]) -> bool:
    return any(isinstance(q, jax.Array) and len(q.devices()) > 1 for q in displacements)


@partial(jax.jit, static_argnums=0)
def transforms(
    structure: Structure, joints: tuple[Joint, ...], displacements: JointDisplacements
) -> tuple[Float[Array, "poses 4 4"], ...]:
    """Compute the displacements of all parts, as `part_transforms`, in a program for their number of poses."""
    poses, dtype = displacements[0].shape[0], displacements[0].dtype
    found = moving_parts(structure, joints, displacements)
    still = jnp.broadcast_to(jnp.eye(4, dtype=dtype), (poses, 4, 4))
    return tuple(as_matrices(found[part]) if part in found else still for part in structure.part_names)


def moving_parts(
    structure: Structure, joints: tuple[Joint, ...], displacements: JointDisplacements
) -> dict[str, Rigid]:
    """Compute the displacements of all parts that are not fixed along the tree from the fixed parts.

    P_child = P_parent J, or P_parent J^-1 where the tree passes the joint from part 2 to part 1. Where a joint up to a
    part has no finite displacement, that of the part is NaN, with derivatives of zero.
    """
    found: dict[str, Rigid] = {}
    known: dict[str, Bool[Array, " poses"]] = {}
    for part, parent, joint, sign in structure.tree:
        q, finite = _numbers_of(displacements[joint])
        moved = joint_motion(joints[joint], q)
        moved = moved if sign > 0 else inverse(moved)
        # without this barrier XLA computes the whole chain anew for every child part, and rounds it otherwise
        found[part] = lax.optimization_barrier(product(found[parent], moved) if parent in found else moved)
        known[part] = known[parent] & finite if parent in known else finite
    return {part: jnp.where(known[part], place, jnp.nan) for part, place in found.items()}


def _numbers_of(q: Float[Array, "poses _"]) -> tuple[Float[Array, "poses _"], Bool[Array, " poses"]]:
    """Put zeros in place of the displacements of poses that are not finite, and tell which are: what is computed from
    NaN, and left out afterwards, would make NaN of the derivatives of all poses."""
    finite = jnp.all(jnp.isfinite(q), axis=1)
    return jnp.where(finite[:, None], q, 0.0), finite


@jax.jit
def moved_point(transforms: Float[Array, "poses 4 4"], point: Float[Array, "3"]) -> Float[Array, "poses 3"]:
    """Apply transforms of a part, or derivatives of these, to a point of the part in the assembled pose."""
    return jnp.einsum("pij,j->pi", transforms[:, :3, :3], point) + transforms[:, :3, 3]


def loop_motion(
    joints: Sequence[Joint], displacements: Sequence[Float[Array, "poses _"]], loop: Sequence[tuple[int, int]]
) -> Float[Array, "3 4 poses"]:
    """Compute the product of the displacements of joints along a loop, or of their inverses where the sign is negative:
    the identity where the loop closes.

    Frames of neighbouring movements are multiplied first: these products are the same for all poses.
    """
    steps, ends = [], []
    for number, sign in loop:
        joint, q = joints[number], displacements[number]
        enter, leave = (joint.frames_1, joint.frames_2) if sign > 0 else (joint.frames_2, joint.frames_1)
        numbered = list(enumerate(zip(joint.movements, coordinate_ranges(joint.movements), strict=True)))
        for frame, (movement, own) in numbered if sign > 0 else reversed(numbered):
            curve = joint.curves[frame] if joint.curves else None
            pitch = jnp.asarray(joint.pitch, q.dtype)
            steps.append((movement, q[:, own.start : own.stop].T, pitch, curve, sign < 0))
            ends.append((enter[frame], leave[frame]))
    enter, leave = (jnp.stack([jnp.asarray(each, float) for each in side]) for side in zip(*ends, strict=True))
    turned = leave[:, :3, :3].swapaxes(1, 2)
    back = jnp.concatenate([turned, -turned @ leave[:, :3, 3:]], axis=2)
    between = [*(back[:-1] @ enter[1:]), back[-1]]
    found = as_rigid(enter[0])
    for step, then in zip(steps, between, strict=True):
        # a barrier, as in `moving_parts`
        found = lax.optimization_barrier(product(displaced(found, *step), then[:, :, None]))
    return found


def joint_motion(joint: Joint, q: Float[Array, "poses _"]) -> Float[Array, "3 4 poses"]:
    """Compute the displacement J of part 2 relative to part 1, the product of all `frames_1 T frames_2^-1` (Table 2).

    Columns of `q` are the joint's coordinates: radians, and lengths in the unit of the mechanism. Returns rotation and
    translation in world coordinates, `[row, column, pose]`.
    """
    found = None
    for frame, (movement, own) in enumerate(zip(joint.movements, coordinate_ranges(joint.movements), strict=True)):
        frame_1, frame_2 = (as_rigid(jnp.asarray(side[frame], q.dtype)) for side in (joint.frames_1, joint.frames_2))
        begin = frame_1 if found is None else product(found, frame_1)
        curve = joint.curves[frame] if joint.curves else None
        moved = displaced(begin, movement, q[:, own.start : own.stop].T, jnp.asarray(joint.pitch, q.dtype), curve)
        found = product(moved, inverse(frame_2))
    still = jnp.eye(4, dtype=q.dtype)[:3, :, None] if found is None else found
    return jnp.broadcast_to(still, (3, 4, q.shape[0]))
