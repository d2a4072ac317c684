"""Pieces of parts whose outline is a polygon, as wheels with teeth and squares of shafts."""

import numpy as np

from jaxkin.geometry.surfaces import Plane
from reference.round_parts import Z


def prism(outline, low, high, at=(0.0, 0.0), side=1.0):
    """The walls of a polygon that is star-shaped about a point, and its ends; those of a hole with -1 as `side`, which
    has no ends."""
    corners = np.column_stack([np.asarray(outline, float) + at, np.zeros(len(outline))])
    others, faces = np.roll(corners, -1, axis=0), []
    for one, other in zip(corners, others, strict=True):
        normal = side * np.cross(other - one, Z)
        square = [one + low * Z, other + low * Z, other + high * Z, one + high * Z]
        triangles = np.array([square[:3], [square[0], square[2], square[3]]])
        faces.append((Plane(square[0], normal / np.linalg.norm(normal)), triangles[:, :: int(side)]))
    middle = np.array([*at, 0.0])
    fan = np.stack([np.broadcast_to(middle, corners.shape), corners, others], axis=1)
    ends = [(Plane(middle + high * Z, Z), fan + high * Z), (Plane(middle + low * Z, -Z), fan[:, ::-1] + low * Z)]
    return [*faces, *(ends if side > 0 else ())]


def square(half):
    """The corners of a square."""
    return [(half, -half), (half, half), (-half, half), (-half, -half)]


def teeth(number, module, turn=0.0):
    """The outline of a wheel with straight flanks, and some backlash."""
    radius, outline = module * number / 2, []
    for k in range(number):
        middle, half = 2 * np.pi * k / number + turn, np.pi / (2 * number) - 0.05 * module / radius
        flanks = [(-1.25, -1.75), (1.0, -0.45), (1.0, 0.45), (-1.25, 1.75)]
        outline += [
            (radius + height * module) * np.array([np.cos(middle + wide * half), np.sin(middle + wide * half)])
            for height, wide in flanks
        ]
    return outline
