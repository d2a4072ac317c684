"""Pairs of trimmed faces in every contact state, made without a CAD kernel.

`patch` triangulates a piece of an analytic surface in its parameters; `PAIRS` holds one pair of faces for every state
and variant, at the scale of one, in contact somewhere near the origin.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import apply, perpendicular, unit
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere

X, Y, Z = np.eye(3)
ORIGIN = np.zeros(3)
TURN = (-np.pi, np.pi)


def patch(surface, u, v, towards=None, axis=Z, steps=24) -> Face:
    """A face of the surface: u is the angle from `towards` about the axis, v the height along it from point or apex.

    On a plane u and v are lengths along `towards` and across; on a sphere v is the latitude about `axis`.
    """
    axis = {"plane": lambda: surface.normal, "sphere": lambda: axis}.get(surface.kind, lambda: surface.axis)()
    x = perpendicular(axis) if towards is None else unit(towards - (towards @ axis) * axis)
    y = np.cross(axis, x)
    us, vs = np.meshgrid(np.linspace(*u, steps + 1), np.linspace(*v, 4), indexing="ij")
    us, vs = us[..., None], vs[..., None]
    round_ = np.cos(us) * x + np.sin(us) * y
    match surface:
        case Plane():
            points = surface.point + us * x + vs * y
        case Cylinder():
            points = surface.point + surface.radius * round_ + vs * axis
        case Cone():
            points = surface.apex + vs * (axis + np.tan(surface.half_angle) * round_)
        case Sphere():
            points = surface.centre + surface.radius * (np.cos(vs) * round_ + np.sin(vs) * axis)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    triangles = np.concatenate([np.stack([a, b, c], -2).reshape(-1, 3, 3), np.stack([a, c, d], -2).reshape(-1, 3, 3)])
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    triangles = triangles[np.linalg.norm(normals, axis=1) > 1e-12]  # poles and apexes
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    inwards = np.sum(normals * surface.normals(triangles.mean(axis=1)), axis=1) < 0
    triangles[inwards] = triangles[inwards][:, ::-1]
    return Face(surface.kind, surface, triangles)


def moved(face: Face, displacement, scale: float = 1.0) -> Face:
    """The face displaced, then scaled about the origin."""
    surface = face.surface.moved(displacement)
    lengths = {
        name: getattr(surface, name) * scale for name in ("point", "apex", "centre", "radius") if hasattr(surface, name)
    }
    return Face(face.name, replace(surface, **lengths), apply(displacement, face.triangles) * scale)


def part(name: str, *faces: Face) -> Part:
    return Part(name, faces, np.concatenate([face.triangles for face in faces]))


def random_displacement(rng: np.random.Generator, reach: float = 3.0):
    """A uniformly random rotation and a translation of up to `reach` along each axis."""
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    pose = np.eye(4)
    pose[:3, :3] = q * np.linalg.det(q)
    pose[:3, 3] = rng.uniform(-reach, reach, 3)
    return pose


@dataclass(frozen=True)
class Pair:
    """Two faces in contact."""

    letter: str
    region: str
    variant: str
    face1: Face
    face2: Face

    def __str__(self) -> str:
        return f"{self.letter}-{self.region}-{self.variant}"


def _pairs() -> list[Pair]:
    flat = patch(Plane(ORIGIN, Z), (-3, 3), (-3, 3), X)
    roller = Cylinder(ORIGIN, X, 1.0, 1)
    full = patch(roller, TURN, (-3, 3), Z)
    al, be = 0.4, 0.3
    lying = np.cos(al) * X + np.sin(al) * Z  # axis of a cone of half angle al whose lowest ruling is along x
    g = np.cos(0.9) * X + np.sin(0.9) * Y
    crossing = np.cos(al) * g + np.sin(al) * Z
    below = np.cos(0.5) * X - np.sin(0.5) * Z  # axis of a cone of half angle 0.5 whose highest ruling is along x

    def ball(centre, r, side=1):
        return patch(Sphere(np.asarray(centre, float), r, side), TURN, (-1.5, 1.5), axis=unit(X + Y))

    def upright(x, r, side=1, v=(-1, 2)):
        return patch(Cylinder(x * X, Z, r, side), TURN, v)

    def cone(apex, axis, angle, side, v):
        return patch(Cone(np.asarray(apex, float), axis, angle, side), TURN, v)

    bore = upright(0, 1.0, -1, (0, 3))
    ruling = np.cos(0.5) * Z + np.sin(0.5) * X  # of a cone of half angle 0.5 about z
    inward = np.sin(0.5) * Z - np.cos(0.5) * X  # its normal there, to the axis
    seat = cone(ORIGIN, Z, 0.5, -1, (0.2, 3))
    return [
        Pair("a", "surface", "flat", flat, patch(Plane(np.array([0.3, 0.1, 0]), -Z), (-1, 1), (-1, 1), X + Y)),
        Pair("b", "line", "roller", flat, patch(Cylinder(1.5 * Z, X, 1.5, 1), TURN, (-1, 2), Z)),
        Pair("c", "line", "cone", flat, cone([0.1, 0.2, 0], lying, al, 1, (0.5, 2))),
        Pair("c", "line", "apex", flat, cone([0.1, 0.2, 0], lying, al, 1, (0, 2))),
        Pair("d", "point", "ball", flat, ball([0.3, 0.2, 1.1], 1.1)),
        Pair("e", "surface", "hole pin", bore, upright(0, 1.0)),
        Pair("e", "surface", "pin hole", upright(0, 1.0), bore),
        Pair("f", "line", "side by side", upright(0, 1.0), upright(1.5, 0.5, v=(0, 4))),
        Pair("f", "line", "pin in wide hole", bore, upright(0.2, 0.8)),
        Pair("f", "line", "wide hole on pin", upright(0, 0.8), upright(0.2, 1.0, -1, (0, 3))),
        Pair("g", "point", "crossed", full, patch(Cylinder(1.5 * Z, g, 0.5, 1), TURN, (-1, 2))),
        Pair("h", "line", "side by side", full, cone([0, 0, 1], lying, al, 1, (0.5, 2))),
        Pair(
            "h",
            "line",
            "cone in hole",
            patch(Cylinder(ORIGIN, X, 3.0, -1), TURN, (-3, 3)),
            cone([0, 0, -3], lying, al, 1, (0.5, 2)),
        ),
        Pair(
            "h",
            "line",
            "pin in cone",
            patch(Cylinder(ORIGIN, X, 0.2, 1), TURN, (-1, 2)),
            cone([-1, 0, -0.2], lying, al, -1, (1, 3)),
        ),
        Pair("i", "point", "crossed", full, cone(Z - 1.7 * g, crossing, al, 1, (0.5, 3))),
        Pair("j", "circle", "ball fills bore", bore, ball([0, 0, 1.3], 1.0)),
        Pair("j", "point", "ball outside", full, ball([0.3, 0, 1.5], 0.5)),
        Pair("j", "point", "ball in wide bore", bore, ball([0.6, 0, 1.3], 0.4)),
        Pair("k", "surface", "seat plug", seat, cone(ORIGIN, Z, 0.5, 1, (0, 2))),
        Pair("k", "surface", "plug seat", cone(ORIGIN, Z, 0.5, 1, (1, 2)), seat),
        Pair(
            "l",
            "line",
            "side by side",
            cone(ORIGIN, below, 0.5, 1, (0.5, 3)),
            cone([2.6, 0, 0], -lying * [1, 1, -1], al, 1, (0.2, 2)),
        ),
        Pair("l", "line", "same way", cone(ORIGIN, below, 0.5, 1, (0.5, 3)), cone([0.6, 0, 0], lying, al, 1, (0.2, 2))),
        Pair(
            "l",
            "line",
            "plug in wide seat",
            cone(ORIGIN, lying, al, -1, (1, 3)),
            cone([0.5, 0, 0], np.cos(be) * X + np.sin(be) * Z, be, 1, (0.2, 2)),
        ),
        Pair(
            "m", "point", "crossed", cone(ORIGIN, below, 0.5, 1, (0.3, 3)), cone(X - 0.8 * g, crossing, al, 1, (0.2, 2))
        ),
        Pair("n", "circle", "ball in seat", seat, ball([0, 0, 0.6 / np.sin(0.5)], 0.6)),
        Pair("n", "point", "ball outside", cone(ORIGIN, Z, 0.5, 1, (0.2, 3)), ball(1.5 * ruling - 0.6 * inward, 0.6)),
        Pair("n", "point", "ball in wide seat", seat, ball(1.5 * ruling + 0.3 * inward, 0.3)),
        Pair("o", "surface", "socket ball", patch(Sphere(Z, 1.0, -1), TURN, (-1.5, 0.3)), ball(Z, 1.0)),
        Pair("o", "surface", "ball socket", ball(Z, 1.0), patch(Sphere(Z, 1.0, -1), TURN, (0.1, 0.5))),
        Pair("p", "point", "outside", ball(ORIGIN, 1.0), ball([1.2, 0.9, 0], 0.5)),
        Pair("p", "point", "ball in wide socket", ball(ORIGIN, 1.0, -1), ball([0.3, 0.4, 0], 0.5)),
    ]


PAIRS = _pairs()


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test that asks for `pair` on every pair."""
    if "pair" in metafunc.fixturenames:
        metafunc.parametrize("pair", PAIRS, ids=str)


@pytest.fixture(scope="session")
def solids() -> SimpleNamespace:
    """The functions of this file, for the tests beside it."""
    return SimpleNamespace(patch=patch, moved=moved, part=part, random_displacement=random_displacement, pairs=PAIRS)
