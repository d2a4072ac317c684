"""Solid models from STEP files: parts in their assembled pose with their analytic faces, in the unit of the file."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from jaxkin.geometry.merge import merge_faces
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Pose, apply, unit
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere, Surface
from jaxkin.io.step_glb import Instance, instances
from jaxkin.io.step_unit import length_unit

TESSELLATION = {"tol_linear": 0.01, "tol_relative": True, "tol_angular": 0.2}
"""Sag over edge length, and radians a chord: the surfaces are exact, only the outlines of faces follow the triangles."""


def read_step(path: str | Path) -> tuple[tuple[Part, ...], str]:
    """The parts of a STEP file, in world coordinates and in the length unit of the file, and the name of that unit."""
    import cascadio

    path = Path(path)
    data = path.read_bytes()
    name, metres = length_unit(data.decode("latin-1"))
    glb = cascadio.load(data, "step", include_brep=True, **TESSELLATION)
    found = list(instances(glb))
    names = _unique([_name(instance, number) for number, instance in enumerate(found, start=1)])
    return tuple(_part(name, instance, metres) for name, instance in zip(names, found, strict=True)), name


def _part(name: str, instance: Instance, metres: float) -> Part:
    scale, pose = 1 / metres, instance.pose.copy()
    pose[:3, 3] *= scale
    triangles = instance.triangles * scale
    size = float(np.linalg.norm(np.ptp(triangles.reshape(-1, 3), axis=0)))
    tolerance = max(1e-6 * size, 3e-7 * float(np.abs(triangles).max()))
    faces, notes = [], []
    for index, described in enumerate(instance.faces):
        corners = triangles[instance.face_of == index]
        if len(corners) == 0:
            continue
        surface = _surface(described, corners, scale)
        if surface is None:
            kind = "freeform surface" if described is None else described["type"]
            notes.append(f"face {index}: {kind}, not one of the four surfaces")
        else:
            faces.append(Face(f"face {index}", surface.moved(pose), apply(pose, corners)))
    merged = merge_faces(faces, tolerance)
    return Part(name, merged, apply(pose, triangles), instance.color, tuple(notes))


def _surface(described: dict[str, Any] | None, corners: np.ndarray, scale: float) -> Surface | None:
    """The surface in the frame of the mesh, outwards as the triangles are wound."""
    if described is None:
        return None
    at = {key: np.array(described[key]) * scale for key in ("origin", "apex", "center") if key in described}
    match described["type"]:
        case "plane":
            plane = Plane(at["origin"], unit(described["normal"]))
            return Plane(plane.point, plane.normal * _side(plane, corners))
        case "cylinder":
            cylinder = Cylinder(at["origin"], unit(described["axis"]), described["radius"] * scale, 1)
            return Cylinder(cylinder.point, cylinder.axis, cylinder.radius, _side(cylinder, corners))
        case "cone":
            axis = unit(described["axis"])
            axis = axis if ((corners - at["apex"]) @ axis).sum() > 0 else -axis
            cone = Cone(at["apex"], axis, abs(described["semi_angle"]), 1)
            return Cone(cone.apex, cone.axis, cone.half_angle, _side(cone, corners))
        case "sphere":
            sphere = Sphere(at["center"], described["radius"] * scale, 1)
            return Sphere(sphere.centre, sphere.radius, _side(sphere, corners))
    return None


def _side(surface: Surface, corners: np.ndarray) -> int:
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return 1 if np.sum(areas * surface.normals(corners.mean(axis=1))) > 0 else -1


def _name(instance: Instance, number: int) -> str:
    """The first name that a person gave; translators fill in numbers and labels of their data structure."""
    for name in instance.names:
        if name.strip() and not re.fullmatch(r"\d+|=>\[.*\].*|Open CASCADE STEP translator.*", name.strip()):
            return name.strip()
    return f"part {number}"


def _unique(names: list[str]) -> list[str]:
    seen: Counter[str] = Counter()
    result = []
    for name in names:
        seen[name] += 1
        result.append(name if seen[name] == 1 else f"{name}#{seen[name]}")
    return result
