"""Surfaces recovered from points that went through float32, against the surfaces that the points were made on."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaxkin.geometry.fit import fit_surface, flipped, rounding
from jaxkin.geometry.pose import perpendicular, rotation, unit
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere

ANGLE = 1e-2


def samples(surface, turn=2 * np.pi, steps=24):
    """Points of a tessellation, only on the two ends of cylinders and cones, and the normals of the surface there."""
    match surface:
        case Plane(point=point, normal=axis):
            origin, heights, radii = point, [0.0, 0.0], [1.0, 3.0]
        case Cylinder(point=origin, axis=axis, radius=radius):
            heights, radii = [-1.0, 2.0], [radius, radius]
        case Cone(apex=origin, axis=axis, half_angle=half_angle):
            heights = [1.0, 3.0]
            radii = [height * np.tan(half_angle) for height in heights]
        case Sphere(centre=origin, radius=radius):
            axis = np.array([0.6, 0.0, 0.8])
            latitudes = np.linspace(-0.9, 1.2, 8)
            heights, radii = radius * np.sin(latitudes), radius * np.cos(latitudes)
    x = perpendicular(axis)
    y = np.cross(axis, x)
    angles = np.linspace(0, turn, steps)[:, None]
    rings = [
        origin + h * axis + r * (np.cos(angles) * x + np.sin(angles) * y) for h, r in zip(heights, radii, strict=True)
    ]
    points = np.concatenate(rings)
    normals = surface.normals(points)
    return points.astype(np.float32).astype(float), normals.astype(np.float32).astype(float)


def placed(kind, turn, shift, scale=1.0):
    axis = rotation(unit(np.array([1.0, 2.0, 3.0])), turn) @ np.array([0.0, 0.6, 0.8])
    shift = np.array(shift) * scale
    return {
        "plane": Plane(shift, axis),
        "cylinder": Cylinder(shift, axis, 1.5 * scale, -1),
        "cone": Cone(shift, axis, 0.4, 1),
        "sphere": Sphere(shift, 1.5 * scale, -1),
    }[kind]


@pytest.mark.parametrize("kind", ["plane", "cylinder", "cone", "sphere"])
@given(turn=st.floats(-3, 3), shift=st.tuples(*[st.floats(-5, 5)] * 3), part=st.floats(0.15, 1.0))
@settings(max_examples=15, deadline=None)
def test_surfaces_come_back(kind, turn, shift, part):
    """Whole turns and parts of them: an arc of a sixth of a turn magnifies the rounding by some tens."""
    surface = placed(kind, turn, shift)
    points, normals = samples(surface, 2 * np.pi * part)
    tolerance = rounding(points)
    found = fit_surface(points, normals, 5 * tolerance, ANGLE)
    assert type(found) is type(surface)
    assert np.abs(found.distance(points)).max() <= 5 * tolerance
    near = 200 * tolerance  # 1 / (1 - cos(a sixth of a turn / 2)) = 7.5; least squares over two rings of 24 points
    match found:
        case Plane():
            assert found.normal @ surface.normal == pytest.approx(1, abs=1e-9)
        case Cylinder():
            assert (found.radius, found.side) == (pytest.approx(1.5, abs=near), -1)
            assert np.linalg.norm(np.cross(found.axis, surface.axis)) < near
            assert np.linalg.norm(np.cross(found.point - surface.point, surface.axis)) < near
        case Cone():
            assert (found.half_angle, found.side) == (pytest.approx(0.4, abs=near), 1)
            assert found.axis @ surface.axis == pytest.approx(1, abs=near)
            assert np.linalg.norm(found.apex - surface.apex) < 10 * near
        case Sphere():
            assert (found.radius, found.side) == (pytest.approx(1.5, abs=near), -1)
            assert np.linalg.norm(found.centre - surface.centre) < near


@pytest.mark.parametrize("kind", ["plane", "cylinder", "cone", "sphere"])
@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_unit_does_not_matter(kind, scale):
    points, normals = samples(placed(kind, 0.7, (2.0, -1.0, 0.5)))
    points = points * scale
    found = fit_surface(points, normals, 5 * rounding(points), ANGLE)
    assert found.kind == kind


def test_normals_tell_a_cone_from_a_sphere_through_the_same_two_circles():
    cone = Cone(np.zeros(3), np.array([0.0, 0.0, 1.0]), 0.4, 1)
    points, normals = samples(cone)
    middle = (3 + 1) / 2 / np.cos(0.4) ** 2  # on the axis, as far from both circles
    sphere = Sphere(np.array([0.0, 0.0, middle]), float(np.linalg.norm(points[0] - [0, 0, middle])), 1)
    assert np.abs(sphere.distance(points)).max() < 1e-6
    assert fit_surface(points, normals, 1e-5, ANGLE).kind == "cone"
    found = fit_surface(points, sphere.normals(points), 1e-5, ANGLE)
    assert found.kind == "sphere"
    assert found.radius == pytest.approx(sphere.radius, rel=1e-6)


def test_a_torus_is_none_of_the_four():
    u, v = np.meshgrid(np.linspace(0, 1.5, 12), np.linspace(0, 1.5, 12))
    radial = np.stack([np.cos(u), np.sin(u), 0 * u], -1)
    normals = (np.cos(v)[..., None] * radial + np.sin(v)[..., None] * [0, 0, 1]).reshape(-1, 3)
    points = (5 * radial).reshape(-1, 3) + 2 * normals
    assert fit_surface(points, normals, 5 * rounding(points), ANGLE) is None
    assert fit_surface(points, normals, 5.0, ANGLE) is None  # near to a plane, but with other normals


def test_too_few_points_fit_nothing_but_a_plane():
    points, normals = samples(placed("cylinder", 0.7, (2.0, -1.0, 0.5)), np.pi / 2, steps=2)
    assert len(points) == 4
    assert fit_surface(points, normals, 5 * rounding(points), ANGLE) is None
    corner = np.eye(3)
    plane = fit_surface(corner, np.full((3, 3), -np.sqrt(1 / 3)), 1e-9, ANGLE)
    assert plane.normal == pytest.approx(np.full(3, -np.sqrt(1 / 3)), abs=1e-12)


def test_one_wrong_normal_does_not_matter():
    """The apex of a cone has all normals, and the writer of the file chose one."""
    points, normals = samples(placed("cone", 0.7, (2.0, -1.0, 0.5)))
    cone = placed("cone", 0.7, (2.0, -1.0, 0.5))
    found = fit_surface(np.vstack([points, cone.apex]), np.vstack([normals, cone.axis]), 5e-5, ANGLE)
    assert found.half_angle == pytest.approx(0.4, abs=1e-5)


@pytest.mark.parametrize("kind", ["plane", "cylinder", "cone", "sphere"])
def test_flipped_turns_the_normals_round(kind):
    surface = placed(kind, 0.7, (2.0, -1.0, 0.5))
    points, normals = samples(surface)
    assert flipped(surface).normals(points) == pytest.approx(-surface.normals(points))
    assert flipped(surface).distance(points + 0.1 * normals) == pytest.approx(np.full(len(points), -0.1), abs=1e-2)


def test_rounding_is_that_of_float32():
    """The noise of rounding stays below it, near the origin and far from it."""
    rng = np.random.default_rng(0)
    for shift in (0.0, 1.0, 1000.0):
        points = rng.uniform(-1, 1, (1000, 3)) + shift
        noise = np.linalg.norm(points.astype(np.float32) - points, axis=-1).max()
        assert noise < rounding(points) < 100 * max(noise, 1e-7)
