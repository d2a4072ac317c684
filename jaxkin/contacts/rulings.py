"""Find where two unbounded surfaces touch in the states with a cone: along a ruling, or where two rulings cross.

A ruling is a straight line on a cone or a cylinder. The functions have the same arguments as those of `touch.py`.
"""

from __future__ import annotations

import numpy as np

from jaxkin.contacts.touch import Touch, closest_points, common_axis, distance, foot
from jaxkin.geometry.pose import Vector, perpendicular, unit
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere

ROUNDING = 1e-12
"""Length that counts as zero, of what is left of a unit vector beside another one: unit vectors are so to 1e-15."""


def plane_cone(s1: Plane, s2: Cone, at: Vector) -> Touch | None:
    """State (c): a cone lying on a plane along a ruling; None where the ruling stands on the plane."""
    line = ruling(s2, -s1.normal)
    rise = float(s1.normal @ line)
    if abs(rise) > 0.5:
        return None
    point = foot(at, s2.apex, line)
    height = float(s1.distance(point))
    tilt = float(abs(np.arcsin(rise)))
    return Touch(height, tilt, point - height * s1.normal, s1.normal, unit(line - rise * s1.normal))


def cylinder_along_cone(s1: Cylinder, s2: Cone, at: Vector) -> Touch:
    """State (h): a cylinder and a cone touching along a ruling that they share."""
    rise = s2.axis - (s2.axis @ s1.axis) * s1.axis
    across = _direction(rise, s1.axis)
    line2 = ruling(s2, -across)
    normal = s2.side * across
    line1 = foot(at, s1.point, s1.axis) + s1.side * s1.radius * normal
    return _shared_ruling(line1, s1.axis, normal, s2.apex, line2, at)


def cylinder_across_cone(s1: Cylinder, s2: Cone, at: Vector) -> Touch | None:
    """State (i): a cone touching a cylinder at a point where their rulings cross."""
    touches = []
    for normal in _normals(s1.axis, s2.apex - s1.point, s1.radius):
        point = foot(at, s1.point, s1.axis) + s1.radius * normal
        touches.append(_crossing_rulings(point, s1.axis, normal, s2))
    return _nearest(touches)


def cone_in_cone(s1: Cone, s2: Cone, at: Vector) -> Touch:
    """State (k): a cone that fills a conical seat. The common axis is the mean of the two."""
    axis, tilt = common_axis(s1.axis, s2.axis)
    if s1.axis @ s2.axis < 0:
        tilt = np.pi  # the cones open in opposite directions, which the mean axis does not show
    angle_misfit = abs(s1.half_angle - s2.half_angle)
    along = float((s2.apex - s1.apex) @ axis)
    across = distance(foot(at, s1.apex, s1.axis), foot(at, s2.apex, s2.axis))
    gap = np.hypot(along * np.sin(s1.half_angle), across * np.cos(s1.half_angle))
    return Touch(float(gap), tilt + angle_misfit, (s1.apex + s2.apex) / 2, direction=axis)


def cone_along_cone(s1: Cone, s2: Cone, at: Vector) -> Touch | None:
    """State (l): two cones touching along a ruling that they share."""
    rise = s2.axis - (s2.axis @ s1.axis) * s1.axis
    if np.linalg.norm(rise) < 1e-6:  # parallel axes: the plane of the axes is that of the apexes
        rise = s2.apex - s1.apex
        rise = rise - (rise @ s1.axis) * s1.axis
    across = _direction(rise, s1.axis)
    touches = []
    for outwards in (across, -across):
        line1 = ruling(s1, outwards)
        normal = s1.side * unit(outwards - (outwards @ line1) * line1)
        line2 = ruling(s2, -s2.side * normal)
        touches.append(_shared_ruling(s1.apex, line1, normal, s2.apex, line2, at))
    return min(touches, key=lambda touch: touch.tilt * distance(at, s1.apex) + abs(touch.gap))


def cone_across_cone(s1: Cone, s2: Cone, at: Vector) -> Touch | None:
    """State (m): two cones touching at a point where their rulings cross."""
    between = s2.apex - s1.apex
    if not np.any(between):
        return None
    touches = []
    for normal in _normals(unit(between), s1.axis, -np.sin(s1.half_angle)):
        touches.append(_crossing_rulings(s1.apex, ruling(s1, normal), normal, s2))
    return _nearest(touches)


def cone_sphere(s1: Cone, s2: Sphere, at: Vector) -> Touch | None:
    """State (n): a ball against a cone, touching at a point."""
    height = float(s1.distance(s2.centre))
    normal = s1.normals(s2.centre)
    if not np.any(normal):
        return None
    return Touch(height - s2.radius, 0.0, s2.centre - height * normal, normal)


def sphere_in_seat(s1: Cone, s2: Sphere, at: Vector) -> Touch:
    """State (n) on a circle: a ball seated in a cone."""
    sin, cos = np.sin(s1.half_angle), np.cos(s1.half_angle)
    centre = foot(s2.centre, s1.apex, s1.axis)
    height = float((centre - s1.apex) @ s1.axis)
    gap = np.hypot(distance(centre, s2.centre), height * sin - s2.radius)
    return Touch(float(gap), 0.0, centre - s2.radius * sin * s1.axis, direction=s1.axis, radius=s2.radius * cos)


def ruling(cone: Cone, outwards: Vector) -> Vector:
    """Return the unit vector from the apex along the ruling on the side of the axis that `outwards` points to."""
    across = _direction(outwards - (outwards @ cone.axis) * cone.axis, cone.axis)
    return np.cos(cone.half_angle) * cone.axis + np.sin(cone.half_angle) * across


def _shared_ruling(p1: Vector, d1: Vector, normal: Vector, p2: Vector, d2: Vector, at: Vector) -> Touch:
    """Measure how two rulings, that should be one, miss each other near `at`; their whole distance counts as the gap.

    `p1`, `d1` and `p2`, `d2` are a point and the unit vector of each; `normal` is the normal of surface 1.
    """
    on1, on2 = foot(at, p1, d1), foot(at, p2, d2)
    offset = on2 - foot(on2, p1, d1)
    gap = np.copysign(np.linalg.norm(offset), offset @ normal)
    _, tilt = common_axis(d1, d2)
    return Touch(float(gap), tilt, on1, normal, d1)


def _crossing_rulings(p1: Vector, d1: Vector, normal: Vector, cone: Cone) -> Touch | None:
    """Measure how a ruling of surface 1 and a ruling of a cone, that should cross, miss each other.

    `p1` is a point of the first, `d1` its unit vector, `normal` the normal of surface 1 along it. The second is the
    ruling on the side of the cone towards surface 1. None where the rulings are parallel, or cross behind the apex.
    """
    line2 = ruling(cone, -normal)
    closest = closest_points(p1, d1, cone.apex, line2)
    if closest is None or (closest[1] - cone.apex) @ line2 <= 0:
        return None
    return Touch(float((closest[1] - closest[0]) @ normal), 0.0, closest[0], normal)


def _normals(edge: Vector, direction: Vector, height: float) -> list[Vector]:
    """Find the unit vectors n with n . edge = 0 and n . direction = height: two or none; `edge` is a unit vector."""
    level = direction - (direction @ edge) * edge
    length = float(np.linalg.norm(level))
    if length <= abs(height):
        return []
    x = level / length
    y = np.cross(edge, x)
    turn = np.arccos(height / length)
    return [np.cos(turn) * x + np.sin(turn) * y, np.cos(turn) * x - np.sin(turn) * y]


def _nearest(touches: list[Touch | None]) -> Touch | None:
    """Choose the touch with the smallest gap; None where there is no touch."""
    real = [touch for touch in touches if touch is not None]
    return min(real, key=lambda touch: abs(touch.gap)) if real else None


def _direction(vector: Vector, axis: Vector) -> Vector:
    """Return the unit vector along `vector`, or any one perpendicular to `axis` where `vector` is rounding."""
    return unit(vector) if np.linalg.norm(vector) > ROUNDING else perpendicular(axis)
