"""Joints by hand that slide along two or three axes and turn about none, one or two: they keep a plane or an angle.

In the terms of Herve's displacement subgroups: translations of a plane and of space, and the Schoenflies motions; two
of these one after the other keep the angle of two directions. `pairs` says what points, directions and limits are.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin._traced import traced
from jaxkin.joints.axis_frame import PERPENDICULAR, Triple, axis_frame
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.limits import GivenLimits, with_limits

_ORIGIN = (0.0, 0.0, 0.0)
_PARALLEL = 1e-6
"""Largest sine of the angle between directions that count as parallel: numbers of six digits."""


def rectangular(
    name: str,
    part1: str,
    part2: str,
    *,
    normal: Triple,
    direction: Triple | None = None,
    point: Triple = _ORIGIN,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make two slides in the plane across the normal, as of an XY table; the point only says where they are drawn.

    x is along `direction`, which must be perpendicular to the normal within 1e-6 (ValueError); any way in the plane
    without it. Coordinates: x, y.
    """
    frame = _slide_frame(name, point, normal, direction, "normal")
    return with_limits(joint(name, (part1, part2), JointKind.RECTANGULAR, ("T_xy",), [frame]), limits)


def cartesian(
    name: str,
    part1: str,
    part2: str,
    *,
    axis: Triple = (0.0, 0.0, 1.0),
    direction: Triple | None = None,
    point: Triple = _ORIGIN,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make three slides at right angles, of a part that does not turn; the point only says where they are drawn.

    z is along `axis` and x along `direction`, which must be perpendicular to it within 1e-6 (ValueError); without both,
    the slides are along the axes of the world. Coordinates: x, y, z.
    """
    frame = _slide_frame(name, point, axis, direction)
    return with_limits(joint(name, (part1, part2), JointKind.CARTESIAN, ("T_xyz",), [frame]), limits)


def schoenflies(
    name: str,
    part1: str,
    part2: str,
    *,
    axis: Triple,
    direction: Triple | None = None,
    point: Triple = _ORIGIN,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make three slides and a turn about the axis, as the hand of a SCARA robot moves: two axes that stay parallel.

    Part 2 turns about the line through the point, which slides along with it. z is along the axis and x along
    `direction`, which must be perpendicular to it within 1e-6 (ValueError). Coordinates: x, y, z, phi.
    """
    frame = _slide_frame(name, point, axis, direction)
    return with_limits(joint(name, (part1, part2), JointKind.SCHOENFLIES, ("T_xyz_phi",), [frame]), limits)


def constant_angle(
    name: str,
    part1: str,
    part2: str,
    *,
    axis1: Triple,
    axis2: Triple,
    direction: Triple | None = None,
    point: Triple = _ORIGIN,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a joint that keeps the angle between a direction of part 1 and one of part 2, and nothing else.

    Part 2 slides along all axes and turns about axis1 of part 1, then about its own axis2, both through the point. z is
    along axis1 and x along `direction`, which must be perpendicular to it within 1e-6 (ValueError). Coordinates: x, y,
    z, phi1, phi2. Raises ValueError for parallel axes, which a Schoenflies joint keeps.
    """
    frame = _slide_frame(name, point, axis1, direction, "axis1")
    second = axis_frame(name, point, axis2, "axis2")
    if not traced(axis1, axis2) and np.linalg.norm(np.cross(frame[:3, 2], second[:3, 2])) <= _PARALLEL:
        raise ValueError(
            f"joint {name!r}: axis1 and axis2 are parallel, so that there is one turn and not two; use "
            f"jk.schoenflies(..., axis=...)"
        )
    made = joint(name, (part1, part2), JointKind.CONSTANT_ANGLE, ("T_xyz_phi", "T_phi"), [frame, second])
    return with_limits(made, limits)


def _slide_frame(
    name: str, point: Triple, axis: Triple, direction: Triple | None, what: str = "axis"
) -> np.ndarray | jax.Array:
    """Make the frame at the point with z along the axis, which messages call `what`, and x along a direction."""
    pose = axis_frame(name, point, axis, what)
    if direction is None:
        return pose
    x, z = axis_frame(name, point, direction, "direction")[:3, 2], pose[:3, 2]
    is_traced = traced(point, axis, direction)
    if not is_traced and abs(float(x @ z)) > PERPENDICULAR:
        raise ValueError(
            f"joint {name!r}: direction must be perpendicular to {what}, the cosine between them is {float(x @ z):.3g}"
        )
    xp = jnp if is_traced else np
    x = x - (x @ z) * z
    x = x / xp.linalg.norm(x)
    return xp.stack([*(xp.append(column, 0.0) for column in (x, xp.cross(z, x), z)), pose[:, 3]], axis=1)
