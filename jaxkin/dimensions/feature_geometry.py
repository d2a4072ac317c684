"""Distance, angle and offset of two features of a part, and the least movement that changes one of them alone.

Every function takes `xp`, numpy or jax.numpy: on the host for numbers that are there, in JAX for those that are traced.
Nothing is decided by looking at a number, so that one program serves parallel, skew and intersecting axes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from jaxkin.dimensions.features import Feature, Quantity


class Between(NamedTuple):
    """How the second of two features lies to the first; lengths in the unit of the mechanism."""

    distance: Any
    """Of two points, or along the common normal; from a plane along its normal, negative behind it."""
    angle: Any
    """Between the directions, 0 to pi; the direction of a plane is its normal. Zero where one is a point."""
    offset: Any
    """Along the first, from its origin: the foot of the second. Of parallel axes, the origin of the second."""
    away: Any
    """Unit vector along which the second moves to change the distance alone."""
    hinge: Any
    """Unit vector about which the second turns to change the angle alone."""
    about: Any
    """A point of that axis."""
    across: Any
    """The distance as a vector, from the first to the second."""
    parallel: Any
    """Whether the two directions are parallel, or one is a point."""


def between(xp, one: Feature, pose1, two: Feature, pose2) -> Between:
    """How feature `two` at `pose2` lies to feature `one` at `pose1` (4x4 poses)."""
    p1, p2, u1, u2 = pose1[:3, 3], pose2[:3, 3], pose1[:3, one.axis], pose2[:3, two.axis]
    side = pose1[:3, (one.axis + 1) % 3]  # where the two coincide, a direction is chosen: an axis of the first frame
    delta = p2 - p1
    zero, size = xp.zeros(()), p1 @ p1 + p2 @ p2
    kinds = (one.kind, two.kind)
    if "point" in kinds:
        axis = u1 if two.kind == "point" else u2
        along = zero if kinds == ("point", "point") else delta @ axis
        if "plane" in kinds:
            sign = 1.0 if one.kind == "plane" else -1.0
            return Between(sign * along, zero, along, sign * axis, side, p2, along * axis, xp.asarray(True))
        if kinds == ("point", "axis"):  # perpendicular to the axis of the second, which is what moves
            side = pose2[:3, (two.axis + 1) % 3]
        across = delta - along * axis if "axis" in kinds else delta
        length, away = _unit(xp, across, side, size)
        return Between(length, zero, along if one.kind == "axis" else -along, away, side, p2, across, xp.asarray(True))

    cross = xp.cross(u1, u2)
    square = cross @ cross
    parallel = square < 50 * xp.finfo(square.dtype).eps
    safe = xp.where(parallel, 1.0, square)
    sine = xp.sqrt(safe)
    angle = xp.where(parallel, xp.where(u1 @ u2 > 0, 0.0, xp.pi), xp.arctan2(sine, u1 @ u2))
    across = delta - (delta @ u1) * u1
    length, level = _unit(xp, across, side, size)
    if "plane" in kinds:
        normal, sign = (u1, 1.0) if one.kind == "plane" else (u2, -1.0)
        distance = sign * (delta @ normal)
        hinge = xp.where(parallel, side, cross / sine)
        return Between(distance, angle, delta @ u1, sign * normal, hinge, p2, (delta @ normal) * normal, parallel)
    common = cross / sine
    signed = delta @ common
    sign = xp.where(signed < 0, -1.0, 1.0)
    foot1 = xp.cross(delta, u2) @ cross / safe
    foot2 = xp.where(parallel, 0.0, xp.cross(delta, u1) @ cross / safe)
    return Between(
        distance=xp.where(parallel, length, sign * signed),
        angle=angle,
        offset=xp.where(parallel, delta @ u1, foot1),
        away=xp.where(parallel, level, sign * common),
        hinge=xp.where(parallel, level, common),
        about=p2 + foot2 * u2,
        across=xp.where(parallel, across, signed * common),
        parallel=parallel,
    )


def value(found: Between, quantity: Quantity):
    """The quantity of that name; a radius is the distance from a plane, on whichever side."""
    if quantity == "radius":
        return found.distance * _side(found)
    return {"distance": found.distance, "angle": found.angle, "offset": found.offset}[quantity]


def _side(found: Between):
    return 1.0 - 2.0 * (found.distance < 0)


def moved(xp, quantity: Quantity, found: Between, change, direction, pose):
    """The pose of the second feature after its quantity grew by `change`, all its others to the first unchanged.

    `direction` is that of the first, along which an offset moves the second.
    """
    if quantity == "angle":
        return turned(xp, pose, change * found.hinge, found.about)
    step = {"distance": found.away, "radius": found.away * _side(found), "offset": direction}[quantity]
    return shifted(xp, pose, change * step)


def shifted(xp, pose, by):
    """The pose moved by a vector."""
    column = xp.concatenate([pose[:3, 3] + by, xp.ones(1)])
    return xp.concatenate([pose[:, :3], column[:, None]], axis=1)


def turned(xp, pose, vector, about):
    """The pose turned by a rotation vector about an axis through a point."""
    square = vector @ vector
    small = square < 1e-6
    angle = xp.sqrt(xp.where(small, 1.0, square))
    first = xp.where(small, 1.0 - square / 6.0 + square * square / 120.0, xp.sin(angle) / angle)
    second = xp.where(small, 0.5 - square / 24.0 + square * square / 720.0, (1.0 - xp.cos(angle)) / angle**2)
    x, y, z = vector
    zero = xp.zeros(())
    cross = xp.stack([xp.stack([zero, -z, y]), xp.stack([z, zero, -x]), xp.stack([-y, x, zero])])
    rotation = xp.eye(3) + first * cross + second * (cross @ cross)
    point = about + rotation @ (pose[:3, 3] - about)
    top = xp.concatenate([rotation @ pose[:3, :3], point[:, None]], axis=1)
    return xp.concatenate([top, pose[3:]])


def _unit(xp, vector, instead, size):
    """Length and direction of a vector; zero, and the direction given, where only rounding of `size` is left of it."""
    square = vector @ vector
    nothing = square <= 1e4 * xp.finfo(square.dtype).eps ** 2 * size
    length = xp.sqrt(xp.where(nothing, 1.0, square))
    return xp.where(nothing, 0.0, length), xp.where(nothing, instead, vector / length)
