"""Parts with bores and pins, faces known exactly, without a file: for tests of what solids imply."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from jaxkin.assembly.assembly import Assembly
from jaxkin.geometry.part import Face, Part, moved, scaled
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane
from jaxkin.joints.joint import Joint
from jaxkin.mechanism.mechanism import Mechanism

Z = np.array([0.0, 0.0, 1.0])
SECTIONS = 48
SEEDS = [0, pytest.param(1, marks=pytest.mark.long)]
"""Seeds of `anywhere`: what is drawn at a place, a size and in an order at random is drawn twice."""
TO_X = np.array([[0.0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])
"""The pose that turns the axis z into x."""


def ring(inner: float, outer: float, low: float, high: float, at=(0.0, 0.0)) -> list[tuple]:
    """Surfaces and triangles of a ring about an axis along z."""
    mesh = trimesh.creation.annulus(inner, outer, segment=[[*at, low], [*at, high]], sections=SECTIONS)
    return _faces(mesh, np.array([*at, 0.0]), [(inner, -1), (outer, 1)], low, high)


def pin(radius: float, low: float, high: float, at=(0.0, 0.0)) -> list[tuple]:
    """Surfaces and triangles of a cylinder about an axis along z."""
    mesh = trimesh.creation.cylinder(radius, segment=[[*at, low], [*at, high]], sections=SECTIONS)
    return _faces(mesh, np.array([*at, 0.0]), [(radius, 1)], low, high)


def cone(first: float, last: float, low: float, high: float, side: int, at=(0.0, 0.0)) -> list[tuple]:
    """The surface and the triangles of a cone about an axis along z, of one radius at its low end and another at its
    high one; a countersink with -1 as `side`."""
    mesh = trimesh.creation.revolve([[first, low], [last, high]], sections=SECTIONS)
    axis, slope = np.array([*at, 0.0]), (last - first) / (high - low)
    triangles = mesh.triangles + axis
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    outwards = np.sum(normals[:, :2] * (triangles.mean(axis=1) - axis)[:, :2], axis=1) > 0
    triangles = np.where((outwards == (side > 0))[:, None, None], triangles, triangles[:, ::-1])
    surface = Cone(axis + (low - first / slope) * Z, np.sign(slope) * Z, float(np.arctan(abs(slope))), side)
    return [(surface, triangles)]


def block(low: Iterable[float], high: Iterable[float]) -> list[tuple]:
    """Surfaces and triangles of a box."""
    mesh = trimesh.creation.box(bounds=[[*low], [*high]])
    faces = []
    for normal in (*np.eye(3), *-np.eye(3)):
        triangles = mesh.triangles[mesh.face_normals @ normal > 0.9]
        faces.append((Plane(triangles[0, 0], normal), triangles))
    return faces


def _faces(mesh: trimesh.Trimesh, axis: np.ndarray, walls: list[tuple[float, int]], low: float, high: float) -> list:
    up = mesh.face_normals @ Z
    faces = [
        (Plane(axis + height * Z, sign * Z), mesh.triangles[sign * up > 0.9])
        for height, sign in ((low, -1.0), (high, 1.0))
    ]
    middle = mesh.triangles.mean(axis=1) - axis
    outwards = np.sum(mesh.face_normals[:, :2] * middle[:, :2], axis=1) > 0
    for radius, side in walls:
        of_wall = (np.abs(up) < 0.1) & (outwards == (side > 0))
        faces.append((Cylinder(axis, Z, float(radius), side), mesh.triangles[of_wall]))
    return faces


def part(name: str, *pieces: list[tuple]) -> Part:
    """A part of several pieces."""
    faces = [face for piece in pieces for face in piece]
    triangles = np.concatenate([triangles for _, triangles in faces])
    return Part(name, tuple(Face(f"face {k}", *face) for k, face in enumerate(faces, 1)), triangles)


def across(*pieces: list[tuple]) -> list[tuple]:
    """Pieces about the axis x in place of z."""
    return [(face.surface, face.triangles) for face in moved(part("turned", *pieces), TO_X).faces]


def assembly(*parts: Part) -> Assembly:
    """An assembly in millimetres."""
    return Assembly(parts, "mm", "drawn.step")


def anywhere(drawn: Assembly, seed: int, *, scaled_at_random: bool = True) -> Assembly:
    """Turn, move, scale and shuffle an assembly."""
    generator = np.random.default_rng(seed)
    pose = np.eye(4)
    pose[:3, :3] = np.linalg.qr(generator.normal(size=(3, 3)))[0]
    pose[:3, :3] *= np.sign(np.linalg.det(pose[:3, :3]))
    pose[:3, 3] = generator.normal(size=3) * 300
    size = 10 ** generator.uniform(-1, 1) if scaled_at_random else 1.0
    parts = [moved(scaled(each, size), pose) for each in drawn.parts]
    return replace(drawn, parts=tuple(parts[k] for k in generator.permutation(len(parts))))


def owners(mechanism: Mechanism) -> dict[str, str]:
    """Map each part to the first part of its body."""
    return {part: body for body, parts in mechanism.bodies.items() for part in parts}


def moving(mechanism: Mechanism) -> list[Joint]:
    """List the joints that have freedoms."""
    return [joint for joint in mechanism.all_joints if joint.freedoms]


def kind_of(mechanism: Mechanism, one: str, other: str) -> str:
    """Find the kind of the only joint between the bodies of two parts."""
    body = owners(mechanism)
    pair = {body[one], body[other]}
    (joint,) = (joint for joint in moving(mechanism) if {body[part] for part in joint.parts} == pair)
    return str(joint.kind)
