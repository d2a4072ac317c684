"""The values of targets, poses, points or rotations, as displacements of the joints that stand for the targets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array

from jaxkin._arguments import exact_numbers
from jaxkin._traced import traced
from jaxkin.geometry.trig import TURN
from jaxkin.joints.joint import Joint

if TYPE_CHECKING:
    from jaxkin.mechanism.targets import Target

OFF_PLANE = 1e-9
"""How far a target of a planar mechanism may leave its plane, over the size of the joints, or in radians, and how far
entries of its poses may be off those of rigid ones: rounding."""
ROUNDINGS = 16
"""The same in units of rounding, where these are more: displacements that a motion has in float32 are right to two."""


def driven_indices(joint: Joint, target: Target) -> range:
    """List the indices of the coordinates of the joint that the target prescribes."""
    slides = joint.freedoms - (1 if joint.freedoms == 3 else 3)
    return {
        "pose": range(joint.freedoms),
        "point": range(slides),
        "orientation": range(slides, joint.freedoms),
    }[target.kind]


def driven_coordinates(joint: Joint, target: Target, values: Any, size: float | Array) -> dict[str, Any]:
    """Compute the driven coordinates of the joint of a target, by full names, from its values.

    Raises ValueError for values of another shape, poses that are not rigid and poses that leave the plane of the joint;
    where JAX traces them, such poses are NaN. `size` is that of the mechanism.
    """
    given: Any = target_values(target, values)
    near = rounding(values)
    good = _are_rigid(target, given, near)
    xp: Any = jnp if traced(given, joint) else np
    # poses that are not good stand at rest until the end: NaN would spoil the derivatives of all poses
    rest = np.array(target.at) if target.kind == "point" else np.eye(target.shape[0])
    given = xp.where(good.reshape(-1, *[1] * len(target.shape)), given, rest)
    frame = xp.asarray(joint.frames_1, float)[0]
    at, axes = frame[:3, 3], frame[:3, :3]
    eye = xp.broadcast_to(xp.eye(3), (len(given), 3, 3))
    turned = eye if target.kind == "point" else given[:, :3, :3]
    moved = xp.zeros((len(given), 3))
    if target.kind == "pose":
        moved = given[:, :3, :3] @ at + given[:, :3, 3] - at
    elif target.kind == "point":
        moved = given - at
    if joint.freedoms == 3:
        local, turn = moved @ axes, axes.T @ turned @ axes
        good &= _are_in_plane(target, axes[:, 2], local[:, 2] / size, turn, near)
        slides, angles = local[:, :2].T, xp.arctan2(turn[:, 1, 0], turn[:, 0, 0])[None]
    else:
        slides, angles = moved.T, _angles(turned, xp)
    rows = [*xp.where(good, slides, np.nan), *_unwrapped(xp.where(good, angles, np.nan), xp)]
    return {joint.full_names[k]: rows[k] for k in driven_indices(joint, target)}


def target_values(target: Target, values: Any) -> Any:
    """Convert the values of a target to an array (poses, *shape of one), of JAX where they are traced.

    Raises ValueError for what is no number, and for arrays of another shape.
    """
    shape = f"(poses, {', '.join(map(str, target.shape))})"
    given = exact_numbers(values, f"{target.joint}: the values", f"real numbers, an array {shape}")
    if given.ndim != len(target.shape) + 1 or given.shape[1:] != target.shape:
        raise ValueError(f"{target.joint}: expected an array of shape {shape}, got shape {given.shape}")
    return given


def rounding(values: Any) -> float:
    """Tell by how much entries of given poses may be off: `OFF_PLANE`, more where they are in single precision."""
    dtype = (jnp if traced(values) else np).asarray(values).dtype
    return max(OFF_PLANE, ROUNDINGS * float(np.finfo(dtype).eps)) if np.issubdtype(dtype, np.floating) else OFF_PLANE


def _are_rigid(target: Target, given: Any, near: float) -> Any:
    """Tell which poses are finite and rigid within `near`; ValueError where finite known ones are not rigid."""
    xp: Any = jnp if traced(given) else np
    finite = xp.isfinite(given).all(axis=tuple(range(1, given.ndim)))
    if target.kind == "point":
        return finite
    if xp is np:
        check_rigid(target, given[finite], near)
        return finite
    off, mirrored = _off_rigid(target, given, xp)
    return finite & (off <= near) & ~mirrored


def check_rigid(target: Target, given: np.ndarray, near: float = OFF_PLANE) -> None:
    """Raise ValueError where an entry of a pose that should be rigid is off by more than `near`."""
    every, mirrored = _off_rigid(target, given, np)
    if (off := every.max(initial=0.0)) > near or mirrored.any():
        raise ValueError(
            f"{target.joint}: the poses must be rigid, with columns of perpendicular unit vectors, right-handed, and a "
            f"last row 0, 0, 0, 1; they are off by {off:.2g}" + (", and mirrored" if mirrored.any() else "")
        )


def _off_rigid(target: Target, given: Any, xp: Any) -> tuple[Any, Any]:
    """Compute by how much entries of each pose are off what those of a rigid one are, and which poses are mirrored."""
    turned = given[:, :3, :3]
    off = xp.abs(turned @ turned.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2))
    if target.kind == "pose":
        off = xp.maximum(off, xp.abs(given[:, 3] - np.array([0.0, 0.0, 0.0, 1.0])).max(axis=1))
    return off, xp.linalg.det(turned) < 0


def _are_in_plane(target: Target, normal: Any, off: Any, turn: Any, near: float) -> Any:
    """Tell which poses keep to the plane of a planar pair within `near`; ValueError where known ones do not.

    `off` is how far the point is off the plane, over the size of the mechanism; `turn` the rotation in axes of the
    plane.
    """
    xp: Any = jnp if traced(off, turn) else np
    off = xp.stack([xp.abs(off), xp.abs(turn[:, :2, 2]).max(axis=1), xp.abs(turn[:, 2, :2]).max(axis=1)]).max(axis=0)
    if xp is np and (leaves := float(off.max(initial=0.0))) > near:
        raise ValueError(
            f"{target.joint}: the loops move in one plane, with the normal {np.round(np.asarray(normal), 6)}, and "
            f"the target leaves it by {leaves:.2g} of the size of the mechanism, or radians"
        )
    return off <= near


def _unwrapped(angles: Any, xp: Any) -> Any:
    """Unwrap angles (angles, poses) from pose to pose, past poses that are NaN: these stay NaN, and spoil no other."""
    finite = xp.isfinite(angles).all(axis=0)
    numbered = xp.where(finite, xp.arange(len(finite)), 0)
    held = angles[:, np.maximum.accumulate(numbered) if xp is np else lax.cummax(numbered)]
    turns = xp.round(xp.diff(held, axis=1, prepend=held[:, :1]) / TURN)
    return angles - TURN * xp.cumsum(xp.where(xp.isfinite(turns), turns, 0.0), axis=1)


def _angles(turned: Any, xp: Any) -> Any:
    """Compute the angles theta, phi, psi (3, poses) of rotations Rz(psi) Ry(phi) Rx(theta)."""
    level = xp.hypot(turned[:, 2, 1], turned[:, 2, 2])
    sines = xp.stack([turned[:, 2, 1], -turned[:, 2, 0], turned[:, 1, 0]])
    return xp.arctan2(sines, xp.stack([turned[:, 2, 2], level, turned[:, 0, 0]]))
