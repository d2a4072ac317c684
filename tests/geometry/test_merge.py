"""Faces on one surface are united; faces on other surfaces, or with the material on the other side, are not."""

import numpy as np
import pytest

from jaxkin.geometry.merge import merge_faces
from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import frame
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere

POSE = frame(np.array([3.0, -2.0, 5.0]), np.array([0.3, -0.5, 0.8]))
X, Y, Z = POSE[:3, :3].T
ORIGIN = POSE[:3, 3]


def at(x, y, z):
    return ORIGIN + x * X + y * Y + z * Z


def strip(name, surface, radius, start, stop, low, high):
    """Triangles between two arcs about z: their radii, angles and heights; radius is (at low, at high)."""
    angles = np.linspace(start, stop, 9)
    below, above = (
        np.stack([at(r * np.cos(a), r * np.sin(a), h) for a in angles])
        for r, h in zip(radius, (low, high), strict=True)
    )
    triangles = [np.stack([below[:-1], below[1:], above[1:]], 1), np.stack([below[:-1], above[1:], above[:-1]], 1)]
    return Face(name, surface, np.concatenate(triangles))


def pin(name, start=0.0, stop=np.pi, low=0.0, high=4.0, radius=2.0, side=1, axis=Z, point=ORIGIN):
    return strip(name, Cylinder(point, axis, radius, side), (radius, radius), start, stop, low, high)


def rectangle(name, x, height, normal=Z):
    low, high = x
    corners = [at(low, 0, height), at(high, 0, height), at(high, 1, height), at(low, 1, height)]
    return Face(name, Plane(corners[0], normal), np.array([corners[:3], [corners[0], corners[2], corners[3]]]))


def names(faces, tolerance=1e-6):
    return [face.name for face in merge_faces(faces, tolerance)]


def test_half_cylinders_become_one():
    """Each half has its own axis direction and its own point of the axis."""
    halves = [pin("face 2"), pin("face 5", np.pi, 2 * np.pi, axis=-Z, point=at(0, 0, 30))]
    (whole,) = merge_faces(halves, 1e-6)
    assert whole.name == "face 2, 5"
    assert whole.area == pytest.approx(halves[0].area + halves[1].area, rel=1e-12)
    assert np.abs(whole.surface.distance(whole.triangles)).max() < 1e-12


def test_knuckles_of_a_hinge_become_one():
    assert names([pin("face 1", low=0, high=1), pin("face 2", low=5, high=6), pin("face 3", low=9, high=10)]) == [
        "face 1, 2, 3"
    ]


def test_order_is_that_of_the_first_members():
    faces = [
        pin("face 1"),
        rectangle("face 2", (0, 1), 0),
        pin("face 3", np.pi, 2 * np.pi),
        rectangle("face 4", (3, 9), 0),
    ]
    merged = merge_faces(faces, 1e-6)
    assert [face.name for face in merged] == ["face 1, 3", "face 2, 4"]
    assert merged[1].surface is faces[3].surface  # that of the largest member


@pytest.mark.parametrize(
    "other",
    [
        pin("face 2", side=-1),
        pin("face 2", radius=2.001),
        strip("face 2", Cylinder(at(1e-3, 0, 0), Z, 2.0, 1), (2.0, 2.0), 1, 2, 0, 4),
        strip("face 2", Cone(at(0, 0, -20), Z, np.arctan(0.1), 1), (2.0, 2.4), 0, np.pi, 0, 4),
    ],
    ids=["hole", "wider", "beside", "cone"],
)
def test_other_surfaces_stay_apart_from_a_cylinder(other):
    assert names([pin("face 1"), other]) == ["face 1", "face 2"]


def test_small_patches_of_other_radius_stay_apart():
    """So small that the corners of each lie on both surfaces; the corners alone would unite them."""
    first = pin("face 1", -1e-4, 1e-4)
    tiny = [first, Face("face 2", Cylinder(at(-0.01, 0, 0), Z, 2.01, 1), first.triangles)]
    assert np.abs(tiny[1].surface.distance(tiny[0].triangles)).max() < 1e-6
    assert names(tiny, 1e-3) == ["face 1", "face 2"]


def test_planes():
    same, lifted, below = (
        rectangle("face 2", (5, 6), 0),
        rectangle("face 2", (5, 6), 1e-4),
        rectangle("face 2", (5, 6), 0, -Z),
    )
    first = rectangle("face 1", (0, 1), 0)
    assert names([first, same]) == ["face 1, 2"]
    assert names([first, lifted]) == ["face 1", "face 2"]
    assert names([first, below]) == ["face 1", "face 2"]


def test_cones_need_one_apex_and_one_half_of_the_double_cone():
    slope = 0.5

    def cone(name, low, high, start=0.0, axis=Z, side=1):
        surface = Cone(ORIGIN, axis, float(np.arctan(slope)), side)
        return strip(name, surface, (slope * abs(low), slope * abs(high)), start, start + np.pi, low, high)

    assert names([cone("face 1", 1, 3), cone("face 2", 2, 5, np.pi)]) == ["face 1, 2"]
    assert names([cone("face 1", 1, 3), cone("face 2", -3, -1, axis=-Z)]) == ["face 1", "face 2"]
    assert names([cone("face 1", 1, 3), cone("face 2", 1, 3, side=-1)]) == ["face 1", "face 2"]


def test_spheres():
    def zone(name, start, low, high, radius=3.0):
        surface = Sphere(ORIGIN, radius, 1)
        radii = tuple(np.sqrt(radius**2 - height**2) for height in (low, high))
        return strip(name, surface, radii, start, start + 2, low, high)

    assert names([zone("face 1", 0, 0, 1), zone("face 2", 3, -2, 1)]) == ["face 1, 2"]
    assert names([zone("face 1", 0, 0, 1), zone("face 2", 3, 0, 1, radius=3.01)]) == ["face 1", "face 2"]


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_the_unit_does_not_matter(scale):
    halves = [pin("face 1"), pin("face 2", np.pi, 2 * np.pi), pin("face 3", radius=2.001)]
    scaled = [
        Face(
            face.name,
            Cylinder(face.surface.point * scale, face.surface.axis, face.surface.radius * scale, 1),
            face.triangles * scale,
        )
        for face in halves
    ]
    assert names(scaled, 1e-6 * scale) == ["face 1, 2", "face 3"]


def test_a_face_whose_triangles_are_off_stays_as_it_is():
    off = Face("face 1", Plane(ORIGIN, Z), rectangle("", (0, 1), 0.5).triangles)
    assert merge_faces([off], 1e-6) == (off,)
