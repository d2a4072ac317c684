"""Points inside of solids, held to the solid angle under which the surface is seen from them."""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry.enclosed import may_be_inside
from jaxkin.geometry.triangle_tree import triangle_tree


def solid_angles(triangles, points):
    """Solid angles of a closed surface, over a full one: 1 inside, 0 outside (van Oosterom and Strackee)."""
    a, b, c = np.moveaxis(triangles[None] - points[:, None, None], 2, 0)
    la, lb, lc = (np.linalg.norm(each, axis=-1) for each in (a, b, c))
    volume = np.sum(a * np.cross(b, c), axis=-1)
    dots = [np.sum(one * other, axis=-1) * length for one, other, length in ((a, b, lc), (b, c, la), (c, a, lb))]
    return np.sum(2 * np.arctan2(volume, la * lb * lc + sum(dots)), axis=1) / (4 * np.pi)


def tree_of(triangles):
    return triangle_tree(np.array(triangles), np.zeros(len(triangles), int))


def hollow_box():
    """A box with a void in it, whose surface is wound towards the void."""
    inner = trimesh.creation.box([1, 1, 1])
    inner.invert()
    return trimesh.util.concatenate([trimesh.creation.box([2, 3, 2]), inner])


@pytest.mark.parametrize(
    "mesh",
    [
        trimesh.creation.annulus(1.0, 2.0, 3.0, sections=24),
        trimesh.creation.icosphere(3),
        trimesh.creation.torus(2.0, 0.5),
        hollow_box(),
    ],
    ids=["annulus", "ball", "torus", "hollow box"],
)
def test_rays_tell_what_solid_angles_tell(mesh):
    triangles = np.array(mesh.triangles)
    low, high = mesh.bounds
    points = low - 0.1 + (high - low + 0.2) * np.random.default_rng(0).random((500, 3))
    inside = solid_angles(triangles, points) > 0.5
    assert 50 < inside.sum() < 450
    np.testing.assert_array_equal(may_be_inside(tree_of(triangles), points), inside)


def test_what_rays_through_edges_do_not_tell_is_left_open():
    """Points on the faces of a box and below its edges may be inside; those beside and above it are not."""
    tree = tree_of(trimesh.creation.box([2, 2, 2]).triangles)
    on_edges = np.array([[1, 0, 0], [1, 1, 0], [0, 0, 1], [0, 0, -1], [1, 1, 1], [0.5, 0.5, 0]], float)
    assert may_be_inside(tree, on_edges).all()
    outside = np.array([[1.1, 0, 0], [0, 0, 1.1], [1.1, 1.1, 1.1], [0, -1.1, -5]])
    assert not may_be_inside(tree, outside).any()
    assert may_be_inside(tree, np.array([[0.3, 0.4, 0.2], [0.0, 0.0, 0.0]])).all()


def test_rays_through_an_open_surface_tell_nothing():
    triangles = np.array(trimesh.creation.box([2, 2, 2]).triangles)[:-1]
    assert may_be_inside(tree_of(triangles), np.array([[0, 0, 5.0], [9.0, 9.0, 9.0]])).all()
