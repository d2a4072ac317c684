"""Unite the faces of one part that lie on the same surface: half cylinders, split planes, the knuckles of a hinge."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.geometry.part import Face
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere, Surface

_PARALLEL = 0.99
"""Smallest cosine between the normals of faces in one plane: planes fitted to faces only a few roundings wide do not
agree better."""


def merge_faces(faces: Sequence[Face], tolerance: float) -> tuple[Face, ...]:
    """Unite faces on the same surface with the material on the same side, in the order of their first members.

    Two faces are on the same surface when the corners of each lie within `tolerance` (a length) of the surface of the
    other, and their radii agree within it. For two planes only the corners of the smaller face are compared: a plane
    fitted to a few triangles is far off at the corners of a larger face. A united face has the surface of its largest
    member and the names of all of them, "face 3, 8".
    """
    # one corner of every face: most faces are told apart by it, without a look at all their triangles
    points = np.array([face.triangles[0, 0] for face in faces]).reshape(-1, 3)
    free = np.ones(len(faces), bool)
    groups = []
    for index in sorted(range(len(faces)), key=lambda index: -faces[index].area):
        if free[index]:
            near = np.abs(faces[index].surface.distance(points)) <= tolerance
            near[index] = True  # a face is in its own group, even if its triangles are far off its surface
            group = [k for k in np.flatnonzero(free & near).tolist() if _same(faces[index], faces[k], tolerance)]
            free[group] = False
            groups.append((group, faces[index].surface))
    return tuple(
        _united([faces[index] for index in group], surface) for group, surface in sorted(groups, key=lambda g: g[0][0])
    )


def _same(a: Face, b: Face, tolerance: float) -> bool:
    """Check whether two faces are on the same surface, as `merge_faces` says; `a` is the larger one."""
    if a is b:
        return True
    tests = ((a.surface, b),) if isinstance(a.surface, Plane) else ((a.surface, b), (b.surface, a))
    return _alike(a.surface, b.surface, tolerance) and all(
        bool(np.all(np.abs(surface.distance(face.triangles)) <= tolerance)) for surface, face in tests
    )


def _alike(a: Surface, b: Surface, tolerance: float) -> bool:
    """Check what the distances of corners do not show: the side of the material, and the radii of narrow faces."""
    match a, b:
        case Plane(), Plane():
            return float(a.normal @ b.normal) > _PARALLEL
        case (Cylinder(), Cylinder()) | (Sphere(), Sphere()):
            return a.side == b.side and abs(a.radius - b.radius) <= tolerance
        case Cone(), Cone():
            return a.side == b.side and float(a.axis @ b.axis) > 0
    return False


def _united(group: list[Face], surface: Surface) -> Face:
    """Make one face of several with a given surface."""
    if len(group) == 1:
        return group[0]
    name = ", ".join([group[0].name, *(face.name.removeprefix("face ") for face in group[1:])])
    return Face(name, surface, np.concatenate([face.triangles for face in group]))
