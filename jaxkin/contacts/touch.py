"""Find where two unbounded surfaces touch in the states without a cone, and by how much they miss each other.

There is one function for each state, from surface 1, surface 2 and a point `at` near the contact to a `Touch`. Gaps
that vary along an axis are measured next to `at`. None is returned where the state is not possible for the two
surfaces, such as a crossing of parallel axes. The states with a cone are in `rulings.py`; `tolerance.py` decides
whether a touch counts as a contact.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from jaxkin.geometry.pose import Points, Vector, cross, unit
from jaxkin.geometry.surfaces import Cylinder, Plane, Sphere

CROSSING = 0.03
"""Smallest angle, radians, between two lines that cross: at a smaller one the surfaces have a tilted contact along a
line, not a contact at a point."""


@dataclass(frozen=True, eq=False)
class Touch:
    """The place where two unbounded surfaces touch or nearly touch."""

    gap: float
    """Length between the surfaces where they should touch: positive apart, negative overlapping."""
    tilt: float
    """Angle between directions that should be parallel, radians."""
    point: Vector
    """A point of the contact; the centre of a contact on a circle."""
    normal: Vector = field(default_factory=lambda: np.zeros(3))
    """The common normal at `point`, out of the material of surface 1 (the paper's m); zero where there is none."""
    direction: Vector = field(default_factory=lambda: np.zeros(3))
    """Along a contact line (the paper's l); the common axis where two surfaces share one; else zero."""
    radius: float = 0.0
    """Radius of a contact on a circle; else 0."""
    clearance: float | None = None
    """Radius of the hole less that of the pin or ball in it, for the fits (e), (o) and (j) on a circle; else None."""


def plane_plane(s1: Plane, s2: Plane, at: Vector) -> Touch:
    """State (a): two planes face to face."""
    gap = float(s1.distance(at - s2.distance(at) * s2.normal))
    return Touch(gap, angle(s1.normal, -s2.normal), at - s1.distance(at) * s1.normal, normal=s1.normal)


def plane_cylinder(s1: Plane, s2: Cylinder, at: Vector) -> Touch | None:
    """State (b): a cylinder lying on a plane."""
    slope = float(s1.normal @ s2.axis)
    if abs(slope) > 0.5:
        return None
    centre = foot(at, s2.point, s2.axis)
    height = float(s1.distance(centre))
    line = unit(s2.axis - slope * s1.normal)
    return Touch(height - s2.radius, float(abs(np.arcsin(slope))), centre - height * s1.normal, s1.normal, line)


def plane_sphere(s1: Plane, s2: Sphere, at: Vector) -> Touch:
    """State (d): a ball on a plane."""
    height = float(s1.distance(s2.centre))
    return Touch(height - s2.radius, 0.0, s2.centre - height * s1.normal, normal=s1.normal)


def cylinder_in_cylinder(s1: Cylinder, s2: Cylinder, at: Vector) -> Touch:
    """State (e): a pin that fills its hole. The common axis is the mean of the two axes, the gap their distance."""
    foot1, foot2 = foot(at, s1.point, s1.axis), foot(at, s2.point, s2.axis)
    clearance = -(s1.side * s1.radius + s2.side * s2.radius)
    axis, tilt = common_axis(s1.axis, s2.axis)
    return Touch(distance(foot1, foot2), tilt, (foot1 + foot2) / 2, direction=axis, clearance=clearance)


def cylinder_along_cylinder(s1: Cylinder, s2: Cylinder, at: Vector) -> Touch | None:
    """State (f): parallel cylinders touching along a line, side by side or one inside the other."""
    foot1, foot2 = foot(at, s1.point, s1.axis), foot(at, s2.point, s2.axis)
    axis, tilt = common_axis(s1.axis, s2.axis)
    offset = foot2 - foot1
    touch = round_touch(foot1, s1.radius, s1.side, offset - (offset @ axis) * axis, s2.radius, s2.side)
    return None if touch is None else Touch(touch.gap, tilt, touch.point, touch.normal, s1.axis)


def cylinder_across_cylinder(s1: Cylinder, s2: Cylinder, at: Vector) -> Touch | None:
    """State (g): crossed cylinders touching at a point."""
    closest = closest_points(s1.point, s1.axis, s2.point, s2.axis)
    if closest is None:
        return None
    return round_touch(closest[0], s1.radius, s1.side, closest[1] - closest[0], s2.radius, s2.side)


def cylinder_sphere(s1: Cylinder, s2: Sphere, at: Vector) -> Touch | None:
    """State (j): a ball against a cylinder or in a wider bore."""
    foot1 = foot(s2.centre, s1.point, s1.axis)
    return round_touch(foot1, s1.radius, s1.side, s2.centre - foot1, s2.radius, s2.side)


def sphere_in_bore(s1: Cylinder, s2: Sphere, at: Vector) -> Touch:
    """State (j) on a circle: a ball that fills its bore."""
    foot1 = foot(s2.centre, s1.point, s1.axis)
    gap = distance(foot1, s2.centre)
    return Touch(gap, 0.0, s2.centre, direction=s1.axis, radius=s2.radius, clearance=s1.radius - s2.radius)


def sphere_in_sphere(s1: Sphere, s2: Sphere, at: Vector) -> Touch:
    """State (o): a ball that fills its socket. The common centre is the mean of the two, the gap their distance."""
    clearance = -(s1.side * s1.radius + s2.side * s2.radius)
    return Touch(distance(s1.centre, s2.centre), 0.0, (s1.centre + s2.centre) / 2, clearance=clearance)


def sphere_on_sphere(s1: Sphere, s2: Sphere, at: Vector) -> Touch | None:
    """State (p): two spheres touching at a point, side by side or one inside the other."""
    return round_touch(s1.centre, s1.radius, s1.side, s2.centre - s1.centre, s2.radius, s2.side)


def round_touch(centre: Vector, r1: float, side1: int, offset: Vector, r2: float, side2: int) -> Touch | None:
    """Find where two circles in one plane touch, or two spheres; None if their centres coincide.

    `offset` leads from the first centre, `centre`, to the second; `r1`, `r2` are the radii, and the sides are +1 for
    material inside, -1 for material outside.
    """
    between = float(np.linalg.norm(offset))
    if between == 0.0:
        return None
    outside = 1 if side1 == side2 else -1  # +1 next to each other, -1 one in the other
    towards = offset / between
    gap = outside * between - (side1 * r1 + side2 * r2)
    return Touch(gap, 0.0, centre + outside * side1 * r1 * towards, normal=outside * towards)


def foot(points: Points, origin: Vector, direction: Vector) -> Points:
    """Project points onto a line, given by a point and a unit vector."""
    return origin + ((points - origin) @ direction)[..., None] * direction


def closest_points(p1: Vector, d1: Vector, p2: Vector, d2: Vector) -> tuple[Vector, Vector] | None:
    """Find the points of two lines that are nearest to each other; None if the lines are parallel within `CROSSING`.

    A line is given by a point and a unit vector.
    """
    normal = cross(d1, d2)
    square = float(normal @ normal)
    if square < np.sin(CROSSING) ** 2:
        return None
    between = p2 - p1
    return p1 + (cross(between, d2) @ normal / square) * d1, p2 + (cross(between, d1) @ normal / square) * d2


def common_axis(axis1: Vector, axis2: Vector) -> tuple[Vector, float]:
    """Compute the mean of two axes, unit vectors, and the angle between them (radians, at most pi / 2).

    The second axis is reversed if it points against the first.
    """
    turned = axis2 if axis1 @ axis2 >= 0 else -axis2
    return unit(axis1 + turned), angle(axis1, turned)


def angle(direction1: Vector, direction2: Vector) -> float:
    """Compute the angle between two unit vectors, 0 to pi, accurate for small angles too."""
    return float(np.arctan2(np.linalg.norm(cross(direction1, direction2)), direction1 @ direction2))


def distance(point1: Vector, point2: Vector) -> float:
    """Compute the distance of two points."""
    return float(np.linalg.norm(point1 - point2))
