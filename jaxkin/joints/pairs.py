"""Joints written by hand: the lower pairs, and the contact states of the paper, in world coordinates.

All points and directions are those of the assembled pose. Coordinates are those of part 2 relative to part 1, positive
along the given axis and about it by the right-hand rule. `limits` are the lowest and the highest of each, (low, high)
for the only coordinate, {"z": (low, high)} for some of several: poses beyond them are computed too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin._arguments import one_number, several
from jaxkin._traced import traced
from jaxkin.contacts.states import find_state
from jaxkin.geometry.pose import is_rigid
from jaxkin.joints.axis_frame import PERPENDICULAR, Triple, axis_frame
from jaxkin.joints.curve_joints import cam, curve_on_curve, point_on_curve
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.limits import GivenLimits, with_limits
from jaxkin.joints.sliding_joints import cartesian, constant_angle, rectangular, schoenflies
from jaxkin.joints.surface_joints import point_on_surface

__all__ = [  # noqa: RUF022 - what users import from `jaxkin`, in the order of the documents
    "revolute",
    "prismatic",
    "cylindrical",
    "planar",
    "spherical",
    "universal",
    "constant_velocity",
    "screw",
    "fixed",
    "free",
    "rectangular",
    "cartesian",
    "schoenflies",
    "constant_angle",
    "pin_in_slot",
    "point_on_curve",
    "cam",
    "curve_on_curve",
    "point_on_surface",
    "contact_joint",
]


def revolute(
    name: str, part1: str, part2: str, *, point: Triple, axis: Triple, limits: GivenLimits | None = None
) -> Joint:
    """Make a hinge about the axis through the point. Coordinate: phi."""
    return with_limits(
        joint(name, (part1, part2), JointKind.REVOLUTE, ("T_phi",), [axis_frame(name, point, axis)]), limits
    )


def prismatic(
    name: str,
    part1: str,
    part2: str,
    *,
    axis: Triple,
    point: Triple = (0.0, 0.0, 0.0),
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a slide along the axis; the point only says where it is drawn. Coordinate: z."""
    return with_limits(
        joint(name, (part1, part2), JointKind.PRISMATIC, ("T_z",), [axis_frame(name, point, axis)]), limits
    )


def cylindrical(
    name: str, part1: str, part2: str, *, point: Triple, axis: Triple, limits: GivenLimits | None = None
) -> Joint:
    """Make a pin that turns and slides in its hole, contact state (e). Coordinates: z, phi."""
    return with_limits(
        joint(name, (part1, part2), JointKind.CYLINDRICAL, ("T_z_phi",), [axis_frame(name, point, axis)]), limits
    )


def planar(
    name: str,
    part1: str,
    part2: str,
    *,
    normal: Triple,
    point: Triple = (0.0, 0.0, 0.0),
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a plane on a plane, contact state (a), that turns about the point. Coordinates: x, y, phi."""
    return with_limits(
        joint(name, (part1, part2), JointKind.PLANAR, ("T_xy_phi",), [axis_frame(name, point, normal, "normal")]),
        limits,
    )


def spherical(name: str, part1: str, part2: str, *, point: Triple) -> Joint:
    """Make a ball in its socket, contact state (o), with axes parallel to those of the world.

    Coordinates: theta, phi, psi, angles about x, y, z; the rotation is Rz(psi) Ry(phi) Rx(theta).
    """
    return joint(
        name, (part1, part2), JointKind.SPHERICAL, ("T_theta_phi_psi",), [axis_frame(name, point, (0.0, 0.0, 1.0))]
    )


def universal(
    name: str, part1: str, part2: str, *, point: Triple, axis1: Triple, axis2: Triple, limits: GivenLimits | None = None
) -> Joint:
    """Make a cross that turns in part 1 about axis1 (phi), and on which part 2 turns about axis2 (theta).

    The movement is T_theta_phi with y along axis1 and x along axis2. Coordinates: theta, phi. Raises ValueError where
    the axes are not perpendicular within 1e-6.
    """
    pose = axis_frame(name, point, axis1, "axis1")
    x = axis_frame(name, point, axis2, "axis2")[:3, 2]
    y = pose[:3, 2]
    if not traced(point, axis1, axis2) and abs(float(x @ y)) > PERPENDICULAR:
        raise ValueError(
            f"joint {name!r}: axis1 and axis2 of a universal joint must be perpendicular, the cosine between them is "
            f"{float(x @ y):.3g}; use two revolute joints and a part between them for a skew cross"
        )
    xp = jnp if isinstance(pose, jax.Array) else np
    x = x - (x @ y) * y
    x = x / xp.linalg.norm(x)
    columns = [xp.append(column, 0.0) for column in (x, y, xp.cross(x, y))]
    pose = xp.stack([*columns, pose[:, 3]], axis=1)
    return with_limits(joint(name, (part1, part2), JointKind.UNIVERSAL, ("T_theta_phi",), [pose]), limits)


def constant_velocity(
    name: str, part1: str, part2: str, *, point: Triple, axis: Triple, axis2: Triple | None = None
) -> Joint:
    """Make a homokinetic joint (Rzeppa, tripod on a shaft with a fixed centre) between two shafts that meet at a point.

    `axis` is the direction of the shaft of part 1 and `axis2` that of part 2, both from part 1 to part 2; without
    `axis2` the shafts are in line. The joint bends about any axis in the plane that bisects the shafts, and does not
    twist: both shafts turn alike at any angle between them. Only the direction that bisects them matters, and `axis`
    may be that. Coordinates: theta, phi, of the movement Rx(theta) Ry(phi) Rx(theta) with z along that direction; a
    bend about x alone is 2 theta, one about y alone is phi. Raises ValueError for shafts in opposite directions.
    """
    along = axis_frame(name, point, axis)[:3, 2]
    if axis2 is not None:
        xp = jnp if traced(axis, axis2) else np
        along = xp.asarray(along) + xp.asarray(axis_frame(name, point, axis2, "axis2")[:3, 2])
        if not traced(along) and np.linalg.norm(along) < 1e-6:
            raise ValueError(
                f"joint {name!r}: axis and axis2 of a constant velocity joint must both point from {part1!r} to "
                f"{part2!r}, but they are opposite; turn one of them round"
            )
    pose = axis_frame(name, point, along)
    return joint(name, (part1, part2), JointKind.CONSTANT_VELOCITY, ("T_theta_phi_theta",), [pose])


def screw(
    name: str,
    part1: str,
    part2: str,
    *,
    point: Triple,
    axis: Triple,
    pitch: float | int | jax.Array,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a helical pair that advances by `pitch` per turn (positive: right-handed). Coordinate: phi."""
    one_number(pitch, f"joint {name!r}: pitch", "a finite number, the advance per turn")
    return with_limits(
        joint(name, (part1, part2), JointKind.SCREW, ("T_screw",), [axis_frame(name, point, axis)], pitch), limits
    )


def fixed(name: str, part1: str, part2: str) -> Joint:
    """Connect two parts rigidly. No coordinates."""
    return joint(name, (part1, part2), JointKind.FIXED, ("I",), [np.eye(4)])


def free(name: str, part1: str, part2: str, *, point: Triple, limits: GivenLimits | None = None) -> Joint:
    """Make a joint that leaves all six freedoms, about the point, along axes parallel to those of the world.

    Coordinates: z1, z2, z3, slides along x, y, z; then theta, phi, psi as of `spherical`. It holds nothing; its
    coordinates say where part 2 is, and drive it.
    """
    frames = [axis_frame(name, point, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    movements = ("T_z", "T_z", "T_z", "T_theta_phi_psi")
    return with_limits(joint(name, (part1, part2), JointKind.FREE, movements, [*frames, frames[2]]), limits)


def pin_in_slot(
    name: str,
    part1: str,
    part2: str,
    *,
    point: Triple,
    axis: Triple,
    direction: Triple | None = None,
    centre: Triple | None = None,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a pin of part 2, through the point along the axis, in a slot of part 1: a straight or a circular one.

    A straight slot runs along `direction`, perpendicular to the axis. Coordinates: z, how far the pin is along it, and
    phi, the turn of part 2. A circular slot runs about the line along the axis through `centre`. Coordinates: phi1, how
    far the pin is around it, and phi2, the turn of part 2 against the slot there: part 2 has turned by phi1 + phi2.
    Raises ValueError for both or neither of them, a direction that is not perpendicular within 1e-6, and a centre on
    the axis of the pin.
    """
    if (direction is None) == (centre is None):
        raise ValueError(
            f"joint {name!r}: a slot is straight, direction=(x, y, z), or circular, centre=(x, y, z): "
            f"give one of them, got {'neither' if centre is None else 'both'}"
        )
    pin = axis_frame(name, point, axis)
    known = not traced(point, axis, direction, centre)
    if direction is not None:
        along, z = axis_frame(name, point, direction, "direction")[:3, 2], pin[:3, 2]
        if known and abs(float(along @ z)) > PERPENDICULAR:
            raise ValueError(
                f"joint {name!r}: the direction of a slot must be perpendicular to the axis of its pin, the cosine "
                f"between them is {float(along @ z):.3g}; use a prismatic and a revolute joint and a part between them "
                f"for a skew slot"
            )
        slot, slides = axis_frame(name, point, along - (along @ z) * z), "T_z"
    else:
        slot, slides = axis_frame(name, centre, axis, point_label="centre"), "T_phi"
        arm = pin[:3, 3] - slot[:3, 3]
        if known and np.linalg.norm(np.cross(pin[:3, 2], arm)) <= 1e-9 * np.linalg.norm([pin[:3, 3], slot[:3, 3]]):
            raise ValueError(
                f"joint {name!r}: the centre of a circular slot must lie beside the axis of its pin, got "
                f"centre={np.asarray(centre).tolist()} on the axis through point={np.asarray(point).tolist()}; use a "
                f"revolute joint for a pin at the centre"
            )
    return with_limits(joint(name, (part1, part2), JointKind.PIN_IN_SLOT, (slides, "T_phi"), [slot, pin]), limits)


def contact_joint(
    name: str,
    part1: str,
    part2: str,
    *,
    state: str,
    frames: Sequence[np.ndarray] | np.ndarray | jax.Array,
    region: Literal["circle"] | None = None,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a joint that is one of the sixteen contact states of the paper, "a" to "p" (Table 2 as corrected).

    `frames` are the 4x4 poses that Table 1 prescribes, in world coordinates; surface 1 of the table belongs to part 1.
    `region="circle"` selects the contacts on a circle: a ball that fills a bore (j), a ball seated in a cone (n).
    """
    try:
        movements = find_state(state, region).movements
    except ValueError as error:
        raise ValueError(f"joint {name!r}: {error}") from None
    frames = several(frames, f"joint {name!r}: frames", "4x4 poses", "[np.eye(4)]")
    if any(np.shape(pose) != (4, 4) for pose in frames):
        shapes = ", ".join(str(np.shape(pose)) for pose in frames)
        raise ValueError(f"joint {name!r}: frames must be a list of 4x4 poses, [frame, ...], got the shapes {shapes}")
    if len(frames) != len(movements):
        raise ValueError(
            f"joint {name!r}: contact state ({state}) has {len(movements)} frames (Table 1), got {len(frames)}"
        )
    for number, pose in enumerate(frames, start=1):
        if not traced(pose) and not is_rigid(np.asarray(pose, float)):
            raise ValueError(
                f"joint {name!r}: frame {number} is no rigid pose: its first three columns must be perpendicular unit "
                f"vectors, right-handed, its last row 0, 0, 0, 1; got {np.asarray(pose).tolist()}"
            )
    return with_limits(joint(name, (part1, part2), JointKind.of_state(state), movements, frames), limits)


JOINTS_BY_HAND: dict[str, Callable[..., Joint]] = {
    JointKind.REVOLUTE: revolute,
    JointKind.PRISMATIC: prismatic,
    JointKind.CYLINDRICAL: cylindrical,
    JointKind.PLANAR: planar,
    JointKind.SPHERICAL: spherical,
    JointKind.UNIVERSAL: universal,
    JointKind.CONSTANT_VELOCITY: constant_velocity,
    JointKind.SCREW: screw,
    JointKind.FIXED: fixed,
    JointKind.FREE: free,
    JointKind.RECTANGULAR: rectangular,
    JointKind.CARTESIAN: cartesian,
    JointKind.SCHOENFLIES: schoenflies,
    JointKind.CONSTANT_ANGLE: constant_angle,
    JointKind.PIN_IN_SLOT: pin_in_slot,
    JointKind.POINT_ON_CURVE: point_on_curve,
    JointKind.CAM: cam,
    JointKind.CURVE_ON_CURVE: curve_on_curve,
    JointKind.POINT_ON_SURFACE: point_on_surface,
}
"""Kind of a joint that is no contact state -> the function that makes it. Studies are read and written by this table:
keyword arguments of the function are keys of the joint in the file."""
