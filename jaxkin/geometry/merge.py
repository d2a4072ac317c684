"""Faces of one part that lie on the same surface become one: half cylinders, split planes, the knuckles of a hinge."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.geometry.part import Face
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere, Surface


def merge_faces(faces: Sequence[Face], tolerance: float) -> tuple[Face, ...]:
    """The faces with those on the same surface, material on the same side, united; order of first appearance.

    Two faces are on the same surface when the corners of each lie within `tolerance` (a length) of the surface of the
    other, and their radii agree within it. The united face has the surface of its largest member.
    """
    groups: list[list[Face]] = []
    for face in faces:
        for group in groups:
            if all(_same(face, other, tolerance) for other in group):
                group.append(face)
                break
        else:
            groups.append([face])
    return tuple(_united(group) for group in groups)


def _same(a: Face, b: Face, tolerance: float) -> bool:
    return _alike(a.surface, b.surface, tolerance) and all(
        bool(np.all(np.abs(surface.distance(face.triangles)) <= tolerance))
        for surface, face in ((a.surface, b), (b.surface, a))
    )


def _alike(a: Surface, b: Surface, tolerance: float) -> bool:
    """What the distances of the corners do not tell: the side of the material, and the radii of small patches."""
    match a, b:
        case Plane(), Plane():
            return float(a.normal @ b.normal) > 0
        case (Cylinder(), Cylinder()) | (Sphere(), Sphere()):
            return a.side == b.side and abs(a.radius - b.radius) <= tolerance
        case Cone(), Cone():
            return a.side == b.side and float(a.axis @ b.axis) > 0
    return False


def _united(group: list[Face]) -> Face:
    if len(group) == 1:
        return group[0]
    largest = max(group, key=lambda face: face.area)
    name = ", ".join([group[0].name, *(face.name.removeprefix("face ") for face in group[1:])])
    return Face(name, largest.surface, np.concatenate([face.triangles for face in group]))
