"""On which side of a face the material is, whatever the winding of its triangles."""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry.surfaces import Sphere
from jaxkin.io.step_side import _crossings, _near, points_outwards


@pytest.mark.parametrize("hollow", [False, True])
def test_the_side_of_a_sphere_is_that_of_the_solid(hollow: bool) -> None:
    ball = trimesh.creation.icosphere(subdivisions=2, radius=1.0).triangles.view(np.ndarray)
    outer = trimesh.creation.box(extents=(4, 4, 4)).triangles.view(np.ndarray)
    solid = np.concatenate([ball, outer]) if hollow else ball
    assert points_outwards(Sphere(np.zeros(3), 1.0, 1), ball, solid) is not hollow


def test_triangles_left_out_by_their_balls_are_none_that_a_ray_crosses() -> None:
    """Independent truth: the same count with all triangles."""
    solid = trimesh.creation.torus(3.0, 1.0).triangles.view(np.ndarray)
    centres = solid.mean(axis=1)
    radii = np.max(np.sum((solid - centres[:, None]) ** 2, axis=-1), axis=-1)
    random = np.random.default_rng(1)
    left_out = 0
    for start, direction in random.normal(size=(50, 2, 3)):
        near = _near(start, direction, centres, radii)
        left_out += np.sum(~near)
        assert _crossings(start, direction, solid[near]) == _crossings(start, direction, solid)
    assert left_out > 0.8 * 50 * len(solid)
