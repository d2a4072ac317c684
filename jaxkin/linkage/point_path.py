"""Compute the path of one point of a part (Section 5.2), and its derivatives, at a fraction of the price of the
displacements of the part.

The point is carried from joint to joint down to the fixed parts. The frames between two movements are multiplied first,
so that each pose has one affine map a movement; what a single turn does with one point is such a map of (cos, sin).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.affine import affine_image
from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.movements import MOVEMENTS, displace_point
from jaxkin.geometry.trig import cos_and_sin
from jaxkin.joints.joint import Joint
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.linkage.linkage import Linkage


class _Step(NamedTuple):
    """A movement on the way of a point down to the fixed parts."""

    joint: Joint
    number: int
    """Of the movement in the chain of the joint."""
    back: bool
    """Whether the way leads from part 1 to part 2, and the inverse of the movement is applied."""
    q: tuple[Float[Array, " poses"], ...]
    """Its coordinates."""


@partial(jax.jit, static_argnums=2)
def point_path(
    linkage: Linkage, displacements: JointDisplacements, part: str, point: Float[Array, "3"]
) -> Float[Array, "poses 3"]:
    """Compute the path of a point of a part, in world coordinates, from where it is in the assembled pose.

    Lengths are in the unit of the mechanism. Poses in which a joint on the way has no finite displacement are NaN, with
    derivatives of zero.
    """
    hangs = {part: (parent, joint, sign) for part, parent, joint, sign in linkage.structure.tree}
    poses = displacements[0].shape[0]
    known = jnp.ones(poses, bool)
    frame = jnp.append(point, 1.0)[:, None]  # homogeneous, from the rows, and one, to the frame that is reached
    rows: tuple[Array, ...] = ()
    while part in hangs:
        part, joint, sign = hangs[part]
        numbers, finite = _finite_rows(jnp.asarray(displacements[joint]))
        known = known & finite
        for step in _steps(linkage.joints[joint], numbers, sign):
            rows, frame = _passed(step, rows, frame)
    here = affine_image(frame[:3], rows)
    # each coordinate by itself: in a transposed array, the reverse pass would read each as often as it is used
    return jnp.stack([jnp.where(known, jnp.broadcast_to(row, poses), jnp.nan) for row in here], axis=1)


def _finite_rows(q: Float[Array, "poses _"]) -> tuple[tuple[Float[Array, " poses"], ...], Bool[Array, " poses"]]:
    """List the coordinates of a joint, zero where one of a pose is not finite, and tell where all are: NaN that is left
    out afterwards would make NaN of the derivatives of all poses."""
    columns = [q[:, k] for k in range(q.shape[1])]
    finite = jnp.ones(q.shape[0], bool)
    for column in columns:
        finite = finite & jnp.isfinite(column)
    return tuple(jnp.where(finite, column, 0.0) for column in columns), finite


def _steps(joint: Joint, q: Sequence[Float[Array, " poses"]], sign: int) -> Iterator[_Step]:
    """List the movements of a joint as a point passes them, from part 2 to part 1, or back where `sign` is negative."""
    ranges = list(enumerate(coordinate_ranges(joint.movements)))
    for number, own in reversed(ranges) if sign > 0 else ranges:
        yield _Step(joint, number, sign < 0, tuple(q[own.start : own.stop]))


def _passed(
    step: _Step, rows: tuple[Array, ...], frame: Float[Array, "4 _"]
) -> tuple[tuple[Array, ...], Float[Array, "4 _"]]:
    """Pass a movement; without rows the point is the same in all poses so far."""
    joint, number, back, q = step
    before, after = (jnp.asarray(side[number], frame.dtype) for side in (joint.frames_2, joint.frames_1))
    before, after = (after, before) if back else (before, after)
    local = before[:3, :3].T @ (frame[:3] - before[:3, 3:] * frame[3])
    movement = joint.movements[number]
    elements = MOVEMENTS[movement].elements
    if not elements:
        return rows, after @ jnp.concatenate([local, frame[3:]])
    if not rows and len(elements) == 1 and elements[0].kind == "rotate" and elements[0].law is None:
        cos, sin = cos_and_sin(q[elements[0].coordinate])
        return (cos, sin), after @ _turned(local[:, 0], elements[0].axis, -1.0 if back else 1.0)
    curve, pitch = joint.curves[number] if joint.curves else None, jnp.asarray(joint.pitch, frame.dtype)
    moved = displace_point(affine_image(local, rows), movement, q, pitch, curve, back)
    return tuple(jnp.broadcast_arrays(*moved)), after


def _turned(point: Float[Array, "3"], axis: int, sense: float) -> Float[Array, "4 3"]:
    """Make the map from (cos, sin, 1) to the point, turned about an axis of its frame."""
    i, j, k = axis, (axis + 1) % 3, (axis + 2) % 3
    zero, one = jnp.zeros((), point.dtype), jnp.ones((), point.dtype)
    lines = {
        i: (zero, zero, point[i]),
        j: (point[j], -sense * point[k], zero),
        k: (point[k], sense * point[j], zero),
        3: (zero, zero, one),
    }
    return jnp.stack([jnp.stack(lines[row]) for row in range(4)])
