"""Distance, angle and offset between two features of a part, and the movement that changes only one of them.

Every function takes `xp`, numpy on the host or jax.numpy for traced numbers. No Python branch depends on a number, so
that one compiled program serves parallel, skew and intersecting axes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from jaxkin.dimensions.features import Feature, Quantity


class Between(NamedTuple):
    """How the second of two features lies to the first; lengths in the unit of the mechanism, angles in radians."""

    distance: Any
    """Between two points, or along the common normal; from a plane along its normal, negative behind the plane."""
    angle: Any
    """Between the directions, 0 to pi; the direction of a plane is its normal. Zero where a feature is a point."""
    offset: Any
    """Position on the first feature, from its origin, of the foot of the common normal; for parallel axes, of the
    origin of the second."""
    away: Any
    """Unit vector along which the second feature moves to change only the distance."""
    hinge: Any
    """Unit vector of the axis about which the second feature turns to change only the angle."""
    about: Any
    """A point of the axis `hinge`: about it the second feature turns without a change of the distance."""
    across: Any
    """The distance as a vector, from the first feature to the second."""
    parallel: Any
    """Whether the two directions are parallel, or a feature is a point."""


class _Ends(NamedTuple):
    """Positions and directions of two features: vectors of three numbers."""

    origin_1: Any
    origin_2: Any
    direction_1: Any
    direction_2: Any
    delta: Any
    """From the origin of the first feature to that of the second."""
    side_1: Any
    side_2: Any
    """Unit vectors perpendicular to the direction of either feature: stand in for `away` where the two coincide."""
    square: Any
    """Sum of the squared distances of both origins from that of the world: the scale of rounding errors."""


class _Inclination(NamedTuple):
    """The angle between two directions."""

    cross: Any
    """Cross product of the two."""
    square: Any
    """Squared sine of the angle; 1 where they are parallel, so that it can be divided by."""
    angle: Any
    parallel: Any


def between(xp, one: Feature, pose1, two: Feature, pose2) -> Between:
    """Measure how feature `two` at `pose2` lies to feature `one` at `pose1` (4x4 poses)."""
    p1, p2 = pose1[:3, 3], pose2[:3, 3]
    ends = _Ends(
        p1,
        p2,
        pose1[:3, one.axis],
        pose2[:3, two.axis],
        p2 - p1,
        pose1[:3, (one.axis + 1) % 3],
        pose2[:3, (two.axis + 1) % 3],
        p1 @ p1 + p2 @ p2,
    )
    match one.kind, two.kind:
        case "point", "point":
            return _of_points(xp, ends)
        case ("point", "plane") | ("plane", "point"):
            return _of_point_and_plane(xp, ends, plane_first=one.kind == "plane")
        case ("point", "axis") | ("axis", "point"):
            return _of_point_and_axis(xp, ends, axis_first=one.kind == "axis")
        case "axis", "axis":
            return _of_axes(xp, ends)
    return _with_plane(xp, ends, plane_first=one.kind == "plane")


def _of_points(xp, ends: _Ends) -> Between:
    """Measure between two points."""
    zero = xp.zeros(())
    length, away = _unit(xp, ends.delta, ends.side_1, ends.square)
    return Between(length, zero, -zero, away, ends.side_1, ends.origin_2, ends.delta, xp.asarray(True))


def _of_point_and_plane(xp, ends: _Ends, plane_first: bool) -> Between:
    """Measure between a point and a plane: along the normal."""
    normal, sign = (ends.direction_1, 1.0) if plane_first else (ends.direction_2, -1.0)
    along = ends.delta @ normal
    return Between(
        sign * along,
        xp.zeros(()),
        along,
        sign * normal,
        ends.side_1,
        ends.origin_2,
        along * normal,
        xp.asarray(True),
    )


def _of_point_and_axis(xp, ends: _Ends, axis_first: bool) -> Between:
    """Measure between a point and an axis: perpendicular to the axis."""
    axis = ends.direction_1 if axis_first else ends.direction_2
    side = ends.side_1 if axis_first else ends.side_2  # perpendicular to the axis
    along = ends.delta @ axis
    across = ends.delta - along * axis
    length, away = _unit(xp, across, side, ends.square)
    offset = along if axis_first else -along
    return Between(length, xp.zeros(()), offset, away, side, ends.origin_2, across, xp.asarray(True))


def _with_plane(xp, ends: _Ends, plane_first: bool) -> Between:
    """Measure between a plane and an axis, or between two planes: along the normal of the first plane."""
    lie = _inclination(xp, ends)
    normal, sign = (ends.direction_1, 1.0) if plane_first else (ends.direction_2, -1.0)
    along = ends.delta @ normal
    hinge = xp.where(lie.parallel, ends.side_1, lie.cross / xp.sqrt(lie.square))
    offset = ends.delta @ ends.direction_1
    about = ends.origin_2 if plane_first else ends.origin_1  # the point whose distance from the plane it is
    return Between(sign * along, lie.angle, offset, sign * normal, hinge, about, along * normal, lie.parallel)


def _of_axes(xp, ends: _Ends) -> Between:
    """Measure between two axes: along their common normal, or perpendicular to both where they are parallel."""
    lie = _inclination(xp, ends)
    u1, u2, delta, parallel = ends.direction_1, ends.direction_2, ends.delta, lie.parallel
    across = delta - (delta @ u1) * u1
    length, level = _unit(xp, across, ends.side_1, ends.square)
    common = lie.cross / xp.sqrt(lie.square)
    signed = delta @ common
    sign = xp.where(signed < 0, -1.0, 1.0)
    foot1 = xp.cross(delta, u2) @ lie.cross / lie.square
    foot2 = xp.where(parallel, 0.0, xp.cross(delta, u1) @ lie.cross / lie.square)
    return Between(
        distance=xp.where(parallel, length, sign * signed),
        angle=lie.angle,
        offset=xp.where(parallel, delta @ u1, foot1),
        away=xp.where(parallel, level, sign * common),
        hinge=xp.where(parallel, level, common),
        about=ends.origin_2 + foot2 * u2,
        across=xp.where(parallel, across, signed * common),
        parallel=parallel,
    )


def _inclination(xp, ends: _Ends) -> _Inclination:
    """Measure the angle between two directions; sines below about 7 roundings count as parallel."""
    cross = xp.cross(ends.direction_1, ends.direction_2)
    square = cross @ cross
    parallel = square < 50 * xp.finfo(square.dtype).eps
    safe = xp.where(parallel, 1.0, square)
    cosine = ends.direction_1 @ ends.direction_2
    angle = xp.where(parallel, xp.where(cosine > 0, 0.0, xp.pi), xp.arctan2(xp.sqrt(safe), cosine))
    return _Inclination(cross, safe, angle, parallel)


def value(found: Between, quantity: Quantity):
    """Pick a quantity by its name; a radius is the distance from a plane, positive on both sides."""
    if quantity == "radius":
        return found.distance * _side(found)
    return {"distance": found.distance, "angle": found.angle, "offset": found.offset}[quantity]


def _side(found: Between):
    """Return +1 where the distance is positive or zero, -1 where it is negative."""
    return 1.0 - 2.0 * (found.distance < 0)


def moved(xp, quantity: Quantity, found: Between, change, direction, pose):
    """Move the pose of the second feature so that one quantity grows by `change` and its others to the first stay.

    `direction` is that of the first feature: an offset grows along it.
    """
    if quantity == "angle":
        return turned(xp, pose, change * found.hinge, found.about)
    step = {"distance": found.away, "radius": found.away * _side(found), "offset": direction}[quantity]
    return shifted(xp, pose, change * step)


def shifted(xp, pose, by):
    """Translate a pose by a vector."""
    column = xp.concatenate([pose[:3, 3] + by, xp.ones(1)])
    return xp.concatenate([pose[:, :3], column[:, None]], axis=1)


def turned(xp, pose, vector, about):
    """Rotate a pose by a rotation vector (axis times radians) about an axis through the point `about` (Rodrigues)."""
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
    """Compute length and direction of a vector; where it is rounding error only, zero and the direction `instead`.

    `size` is the square of the numbers that were subtracted.
    """
    square = vector @ vector
    nothing = square <= 1e4 * xp.finfo(square.dtype).eps ** 2 * size
    length = xp.sqrt(xp.where(nothing, 1.0, square))
    return xp.where(nothing, 0.0, length), xp.where(nothing, instead, vector / length)
