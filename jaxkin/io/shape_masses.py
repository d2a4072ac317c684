"""What the solids of robots weigh: boxes and the like by their formulas, meshes by their surfaces."""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.inertial import Inertial, of_density_one
from jaxkin.io.robot_model import LinkShape, Weighed


def inertial_of(weighed: Weighed, corners: np.ndarray | None) -> Inertial | None:
    """Compute mass, centre and inertia of a solid of known mass, or density, in the frame of its link.

    `corners` are the triangles (n, 3, 3) of a mesh, in its own frame, metres. None where their surface is open.
    """
    found = of_density_one(corners) if corners is not None else _of_formula(weighed.shape)
    if found is None:
        return None
    mass = weighed.amount if weighed.is_mass else weighed.amount * found.mass
    return Inertial(mass, found.centre, mass / found.mass * found.inertia).moved(weighed.shape.pose)


def _of_formula(shape: LinkShape) -> Inertial:
    """Compute the volume, as a mass, and the inertia of a solid that is no mesh, about its middle."""
    if shape.kind == "box":
        volume, squares = np.prod(shape.size), np.square(shape.size) / 12
    elif shape.kind == "sphere":
        radii = np.broadcast_to(shape.size, 3)
        volume, squares = 4 / 3 * np.pi * np.prod(radii), np.square(radii) / 5
    else:
        radius, length = shape.size
        volume, squares = np.pi * radius**2 * length, np.array([radius**2 / 4, radius**2 / 4, length**2 / 12])
    # the inertia about an axis is the sum of the mean squares along the other two
    inertia = volume * np.diag(np.sum(squares) - squares)
    if shape.kind == "capsule":
        # both halves of a ball, whose centres are 3/8 of the radius beyond the ends of the cylinder
        ball = 4 / 3 * np.pi * radius**3
        along = length**2 / 4 + 3 / 8 * length * radius
        inertia += ball * (2 / 5 * radius**2 * np.eye(3) + along * np.diag([1.0, 1.0, 0.0]))
        volume += ball
    return Inertial(float(volume), np.zeros(3), inertia)
