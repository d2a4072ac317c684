"""What acts on a mechanism besides its weight: forces, torques, springs and dampers, each a pytree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import jax
import numpy as np
from jaxtyping import Array, Float

from jaxkin._traced import traced

Numbers = Float[Array | np.ndarray, "*poses"]
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
    stiffness: Numbers
    """Newtons per metre."""
    length: Numbers
    """Length without a force, unit of the mechanism."""
    damping: Numbers
    """Newton seconds per metre, along the line of the points."""


@dataclass(frozen=True, eq=False)
class JointLoad:
    """A force or torque in a coordinate of a joint, with a spring and a damper: load - stiffness (q - rest) - damping
    q'. It acts on part 2, and its opposite on part 1."""

    coordinate: str
    """"joint" or "joint.coordinate"."""
    load: Numbers
    """Newton metres of an angle, newtons of a length; positive along the coordinate."""
    stiffness: Numbers
    """Newton metres per radian, or newtons per metre."""
    rest: Numbers
    """Displacement without a force of the spring: radians, or the unit of the mechanism."""
    damping: Numbers
    """Newton metre seconds per radian, or newton seconds per metre."""


Applied = Force | Torque | Spring | JointLoad

for _kind, _fields, _static in (
    (Force, ["point", "vector"], ["part", "turns"]),
    (Torque, ["vector"], ["part", "turns"]),
    (Spring, ["points", "stiffness", "length", "damping"], ["parts"]),
    (JointLoad, ["load", "stiffness", "rest", "damping"], ["coordinate"]),
):
    jax.tree_util.register_dataclass(_kind, data_fields=_fields, meta_fields=_static)


def force(part: str, point: Any, vector: Any, *, turns: bool = False) -> Force:
    """Apply a force to a point of a part: newtons along world axes, for all poses or one row a pose.

    `point` is where the point is in the assembled pose. With `turns` the vector, given for the assembled pose, turns
    with the part.
    """
    return Force(
        part, _vectors(point, f"the point on {part!r}", one=True), _vectors(vector, f"the force on {part!r}"), turns
    )


def torque(part: str, vector: Any, *, turns: bool = False) -> Torque:
    """Apply a torque to a part: newton metres about world axes, for all poses or one row a pose.

    With `turns` the vector, given for the assembled pose, turns with the part.
    """
    return Torque(part, _vectors(vector, f"the torque on {part!r}"), turns)


def spring(
    part1: str, point1: Any, part2: str, point2: Any, stiffness: Any, length: Any = 0.0, damping: Any = 0.0
) -> Spring:
    """Put a spring with a damper between points of two parts, where they are in the assembled pose.

    It pulls with stiffness (distance - length) + damping times the rate of the distance: newtons per metre, the unit of
    the mechanism, newton seconds per metre.
    """
    what = f"the spring of {part1!r} and {part2!r}"
    xp = jax.numpy if traced(point1, point2) else np
    points = xp.stack([_vectors(point, f"a point of {what}", one=True) for point in (point1, point2)])
    numbers = (_numbers(each, what) for each in (stiffness, length, damping))
    return Spring((part1, part2), points, *numbers)


def joint_spring(coordinate: str, stiffness: Any, rest: Any = 0.0, damping: Any = 0.0) -> JointLoad:
    """Put a spring with a damper in a coordinate of a joint, "joint" or "joint.coordinate".

    `stiffness` is in newton metres per radian or newtons per metre, `rest` the displacement without a force, in radians
    or the unit of the mechanism, `damping` in newton metre seconds per radian or newton seconds per metre.
    """
    what = f"the spring in {coordinate!r}"
    return JointLoad(coordinate, np.zeros(()), *(_numbers(each, what) for each in (stiffness, rest, damping)))


def joint_load(coordinate: str, load: Any) -> JointLoad:
    """Apply a torque (newton metres) or force (newtons) in a coordinate of a joint, for all poses or one a pose.

    It acts on part 2 of the joint along the coordinate, and its opposite on part 1.
    """
    return JointLoad(coordinate, _numbers(load, f"the load in {coordinate!r}"), *[np.zeros(())] * 3)


def _vectors(given: Any, what: str, one: bool = False) -> Vectors:
    """Three numbers, or unless `one`, rows of three; ValueError for others."""
    found = _real(given, what, "three numbers (x, y, z)")
    if found.shape[-1:] != (3,) or found.ndim > (1 if one else 2):
        rows = "" if one else ", or one row of them a pose"
        raise ValueError(f"{what} must be three numbers (x, y, z){rows}, got shape {found.shape}")
    return found


def _numbers(given: Any, what: str) -> Numbers:
    found = _real(given, what, "numbers")
    if found.ndim > 1:
        raise ValueError(f"{what} must have one number, or one a pose, got shape {found.shape}")
    return found


def _real(given: Any, what: str, expected: str) -> Any:
    if traced(given):
        return jax.numpy.asarray(given, float)
    try:
        return np.asarray(given, float)
    except (TypeError, ValueError):
        raise ValueError(f"{what} must be {expected}, got {given!r}") from None
