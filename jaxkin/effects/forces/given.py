"""What acts on a mechanism besides its weight: forces, torques, springs and dampers, each a pytree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import jax
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import numbers, one_number, text, yes_or_no
from jaxkin._traced import traced

Scalars = Float[Array | np.ndarray, "*poses"]
"""One number for all poses, or one a pose."""
Vectors = Float[Array | np.ndarray, "*poses 3"]


@dataclass(frozen=True, eq=False)
class Force:
    """A force on a point of a part."""

    part: str
    point: Float[Array | np.ndarray, "3"]
    """Where the point is in the assembled pose, unit of the mechanism."""
    vector: Vectors
    """Newtons, world axes; one for all poses, or one a pose."""
    turns: bool = False
    """Whether the vector turns with the part."""


@dataclass(frozen=True, eq=False)
class Torque:
    """A torque on a part."""

    part: str
    vector: Vectors
    """Newton metres, world axes; one for all poses, or one a pose."""
    turns: bool = False
    """Whether the vector turns with the part."""


@dataclass(frozen=True, eq=False)
class Spring:
    """A spring with a damper between a point of a part and a point of another one."""

    parts: tuple[str, str]
    points: Float[Array | np.ndarray, "2 3"]
    """Where the points are in the assembled pose, unit of the mechanism."""
    stiffness: Scalars
    """Newtons per metre."""
    length: Scalars
    """Length without a force, unit of the mechanism."""
    damping: Scalars
    """Newton seconds per metre, along the line of the points."""


@dataclass(frozen=True, eq=False)
class JointLoad:
    """A force or torque in a coordinate of a joint, with a spring and a damper: load - stiffness (q - rest) - damping
    q'. It acts on part 2, and its opposite on part 1."""

    coordinate: str
    """"joint" or "joint.coordinate"."""
    load: Scalars
    """Newton metres of an angle, newtons of a length; positive along the coordinate."""
    stiffness: Scalars
    """Newton metres per radian, or newtons per metre."""
    rest: Scalars
    """Displacement without a force of the spring: radians, or the unit of the mechanism."""
    damping: Scalars
    """Newton metre seconds per radian, or newton seconds per metre."""


@dataclass(frozen=True, eq=False)
class JointFriction:
    """Coulomb friction in a joint: see `jk.joint_friction`."""

    joint: str
    coefficient: Float[Array | np.ndarray, ""]
    radius: Float[Array | np.ndarray, ""] | None
    """Radius at which the faces touch, unit of the mechanism; None for a joint that does not turn with friction."""
    smooth: Float[Array | np.ndarray, ""]
    """Speed of sliding, unit of the mechanism a second, below which friction fades; 0 for none."""


Applied = Force | Torque | Spring | JointLoad | JointFriction

for _kind, _fields, _static in (
    (Force, ["point", "vector"], ["part", "turns"]),
    (Torque, ["vector"], ["part", "turns"]),
    (Spring, ["points", "stiffness", "length", "damping"], ["parts"]),
    (JointLoad, ["load", "stiffness", "rest", "damping"], ["coordinate"]),
    (JointFriction, ["coefficient", "radius", "smooth"], ["joint"]),
):
    jax.tree_util.register_dataclass(_kind, data_fields=_fields, meta_fields=_static)


def force(part: str, point: Any, vector: Any, *, turns: bool = False) -> Force:
    """Apply a force to a point of a part: newtons along world axes, for all poses or one row a pose.

    `point` is where the point is in the assembled pose. With `turns` the vector, given for the assembled pose, turns
    with the part.
    """
    what = f"the force on {text(part, 'the part of a force')!r}"
    return Force(
        part,
        _vectors(point, f"the point on {part!r}", one=True),
        _vectors(vector, what),
        yes_or_no(turns, f"turns of {what}"),
    )


def torque(part: str, vector: Any, *, turns: bool = False) -> Torque:
    """Apply a torque to a part: newton metres about world axes, for all poses or one row a pose.

    With `turns` the vector, given for the assembled pose, turns with the part.
    """
    what = f"the torque on {text(part, 'the part of a torque')!r}"
    return Torque(part, _vectors(vector, what), yes_or_no(turns, f"turns of {what}"))


def spring(
    part1: str, point1: Any, part2: str, point2: Any, stiffness: Any, length: Any = 0.0, damping: Any = 0.0
) -> Spring:
    """Put a spring with a damper between points of two parts, where they are in the assembled pose.

    It pulls with stiffness (distance - length) + damping times the rate of the distance: newtons per metre, the unit of
    the mechanism, newton seconds per metre. Where the points meet, a spring has no direction and no force, midway
    between those beside, and a damper that of the velocity, as beside.
    """
    what = f"the spring of {text(part1, 'a part of a spring')!r} and {text(part2, 'a part of a spring')!r}"
    if part1 == part2:
        raise ValueError(f"a spring acts between two parts, got {part1!r} twice: name the part of its other end")
    xp = jax.numpy if traced(point1, point2) else np
    points = xp.stack([_vectors(point, f"a point of {what}", one=True) for point in (point1, point2)])
    numbers = (_numbers(each, what) for each in (stiffness, length, damping))
    return Spring((part1, part2), points, *numbers)


def joint_spring(coordinate: str, stiffness: Any, rest: Any = 0.0, damping: Any = 0.0) -> JointLoad:
    """Put a spring with a damper in a coordinate of a joint, "joint" or "joint.coordinate".

    `stiffness` is in newton metres per radian or newtons per metre, `rest` the displacement without a force, in radians
    or the unit of the mechanism, `damping` in newton metre seconds per radian or newton seconds per metre.
    """
    what = f"the spring in {text(coordinate, 'the coordinate of a spring')!r}"
    return JointLoad(coordinate, np.zeros(()), *(_numbers(each, what) for each in (stiffness, rest, damping)))


def joint_load(coordinate: str, load: Any) -> JointLoad:
    """Apply a torque (newton metres) or force (newtons) in a coordinate of a joint, for all poses or one a pose.

    It acts on part 2 of the joint along the coordinate, and its opposite on part 1.
    """
    what = f"the load in {text(coordinate, 'the coordinate of a load')!r}"
    return JointLoad(coordinate, _numbers(load, what), *[np.zeros(())] * 3)


def joint_friction(joint: str, coefficient: Any, *, radius: Any = None, smooth: Any = 0.0) -> JointFriction:
    """Put Coulomb friction into a joint: force on its sliding faces = coefficient times what presses them together.

    The faces of hinges, cylindrical joints, screws and balls touch at `radius` from the axis or centre, unit of the
    mechanism: friction there is a torque of coefficient x radius x force. What presses them together is the force that
    the joint transmits: all of it in a hinge or a ball, across the axis in a slide or a cylindrical joint, along the
    normal of a plane, across the thread of a screw, of mean radius `radius`. Torques across the axis, which tilt a pin
    in its bearing, press nothing.

    Friction acts against the sliding velocity, of a cylindrical joint against that of turn and slide together. At rest
    it has no direction. With `smooth`, a speed v0 in the unit of the mechanism a second, it is multiplied by
    v / sqrt(v^2 + v0^2). One number each. Raises ValueError for numbers below zero.
    """
    what = f"the friction of {text(joint, 'the joint of friction')!r}"
    given = [_one(coefficient, what, "coefficient"), _one(smooth, what, "smooth")]
    across = None if radius is None else _one(radius, what, "radius")
    if across is not None and not traced(across) and across == 0:
        raise ValueError(f"the radius of {what} must be above zero")
    return JointFriction(joint, given[0], across, given[1])


def _one(given: Any, what: str, name: str) -> Any:
    """Check one number from zero on; ValueError for others."""
    found = one_number(given, f"the {name} of {what}", "one number from 0 on")
    if not traced(found) and found < 0:
        raise ValueError(f"the {name} of {what} must be one number from 0 on, got {given!r}")
    return found


def _vectors(given: Any, what: str, one: bool = False) -> Vectors:
    """Check three numbers, or unless `one`, rows of three; ValueError for others, and for three that are not finite.

    Rows may be NaN, as those of `_numbers`.
    """
    found = numbers(given, what, "three numbers (x, y, z)")
    if found.ndim == 1 and not traced(found) and not np.isfinite(found).all():
        raise ValueError(f"{what} must be three finite numbers (x, y, z), got {given!r}")
    if found.shape[-1:] != (3,) or found.ndim > (1 if one else 2):
        rows = "" if one else ", or one row of them a pose"
        raise ValueError(f"{what} must be three numbers (x, y, z){rows}, got shape {found.shape}")
    return found


def _numbers(given: Any, what: str) -> Scalars:
    """Check one number, or one a pose; ValueError for others, and for one that is not finite.

    Of several some may be NaN, where nothing was measured: so are the forces of those poses.
    """
    found = numbers(given, what)
    if found.ndim > 1 or (found.ndim == 0 and not (traced(found) or np.isfinite(found))):
        raise ValueError(f"{what} must have one finite number, or one a pose, got {given!r}")
    return found


_AXES: dict[type, dict[str, tuple[int, int]]] = {
    Force: {"point": (1, 1), "vector": (1, 2)},
    Torque: {"vector": (1, 2)},
    Spring: {"points": (2, 2), "stiffness": (0, 1), "length": (0, 1), "damping": (0, 1)},
    JointLoad: {"load": (0, 1), "stiffness": (0, 1), "rest": (0, 1), "damping": (0, 1)},
    JointFriction: {"coefficient": (0, 0), "radius": (0, 0), "smooth": (0, 0)},
}
"""Kind of a load -> its numbers, with their axes where they are given once, and at most: one more for rows a pose."""


def rows_per_pose(load: Applied) -> list[str]:
    """Name the numbers of a load that are given for each pose."""
    return [name for name, (once, _) in _AXES[type(load)].items() if np.ndim(getattr(load, name)) > once]


def batch_of(load: Applied) -> tuple[int, ...]:
    """Return the axes in front of those that the numbers of a load may have, as `jax.vmap` makes them; () without."""
    shapes = [np.shape(getattr(load, name))[: -most or None] for name, (_, most) in _AXES[type(load)].items()]
    return max(shapes, key=len)
