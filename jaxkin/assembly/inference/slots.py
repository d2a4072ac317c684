"""Slots that a screw ends in: between two walls beside it that look at each other."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane


def walls_beside(screw: Bore, part: Part, near: tuple[float, float], least: float = 0.0) -> list[Vector]:
    """Find the normals of the walls of slots that a screw, or its tip, ends in; empty where there is none.

    The walls are plane faces along the screw, on both sides of it. `near` is their least and greatest distance from its
    axis over its radius, `least` their length across the screw.
    """
    walls = [wall for face in part.faces if (wall := _wall(screw, face, near, least)) is not None]
    return [one for k, one in enumerate(walls) if any(np.linalg.norm(one + other) < ACROSS for other in walls[:k])]


def _wall(screw: Bore, face: Face, near: tuple[float, float], least: float) -> Vector | None:
    """Find the normal of a plane face that stands beside a screw, along it, and looks at it; None where it does not."""
    if not isinstance(face.surface, Plane) or abs(face.surface.normal @ screw.axis) > ACROSS:
        return None
    normal = face.surface.normal
    apart = float((screw.point - face.surface.point) @ normal)
    along, aside = screw.axis, np.cross(normal, screw.axis)
    corners = face.triangles.reshape(-1, 3) - screw.point
    heights, sides = corners @ along, corners @ aside
    slack = SAME_LENGTH * screw.radius  # a wall that ends at the axis is beside the screw, one where the screw ends not
    beside = heights.min() < screw.half - slack and heights.max() > slack - screw.half
    beside = beside and sides.min() <= slack and sides.max() >= -slack
    close = near[0] * screw.radius <= apart <= near[1] * screw.radius
    return normal if beside and close and np.ptp(sides) >= least else None
