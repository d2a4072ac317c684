"""Nearest points of convex hulls, held to what makes them nearest: a plane across their gap holds the hulls apart."""

import numpy as np
import trimesh

from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.pose import rotation
from jaxkin.geometry.solid_pairs import SolidPairs
from jaxkin.geometry.triangle_tree import triangle_tree

ROUNDING = 1e-9
"""Of distances of a few units: corners that are nearer by less than 1e-10 of a square are not looked for."""


def tree_of(mesh):
    return triangle_tree(np.array(mesh.triangles), np.zeros(len(mesh.triangles), int))


def placed(count, least, most):
    """Displacements by random turns, and by random shifts of some lengths."""
    random = np.random.default_rng(0)
    turns = np.stack([rotation(axis / np.linalg.norm(axis), angle) for axis, angle in _turns(random, count)])
    shift = random.normal(size=(count, 3))
    shift *= random.uniform(least, most, (count, 1)) / np.linalg.norm(shift, axis=1, keepdims=True)
    return Displaced(turns, shift)


def _turns(random, count):
    return [(random.normal(size=3), random.uniform(0, 6)) for _ in range(count)]


def gaps_of(one, other, displaced):
    pairs = SolidPairs.one(tree_of(one), tree_of(other), displaced)
    points = pairs.nearest_of_hulls()
    return pairs, points, displaced.of(np.arange(len(points)), points[:, 1]) - points[:, 0]


def test_a_plane_across_the_gap_holds_hulls_apart():
    """What is found is no less than the distance, as its ends are in the hulls; the plane shows that it is no more."""
    one, other = trimesh.creation.box([2, 3, 1]), trimesh.creation.annulus(0.5, 1.0, 2.0, sections=16)
    pairs, points, gap = gaps_of(one, other, placed(200, 4.0, 9.0))
    length = np.linalg.norm(gap, axis=1)
    assert length.min() > 0.1
    np.testing.assert_allclose(pairs.ahead((gap / length[:, None]).T), length, atol=ROUNDING)
    assert np.all(np.abs(points[:, 0]) <= np.array([1, 1.5, 0.5]) + ROUNDING)
    assert np.linalg.norm(points[:, 1, :2], axis=1).max() <= 1 + ROUNDING


def test_balls_have_the_distance_of_their_centres():
    """Facets of balls are up to 0.6 % of the radius inside of them."""
    ball = trimesh.creation.icosphere(3)
    displaced = placed(50, 2.5, 4.0)
    _, _, gap = gaps_of(ball, ball, displaced)
    clear = np.linalg.norm(displaced.shift, axis=1) - 2
    length = np.linalg.norm(gap, axis=1)
    assert np.all((length >= clear - ROUNDING) & (length <= clear + 2 * 0.006))


def test_hulls_that_overlap_have_no_gap():
    """A ring has the hull of a disc: what is in its hole is in its hull."""
    ring = trimesh.creation.annulus(3.0, 4.0, 1.0, sections=32)
    _, _, gap = gaps_of(ring, trimesh.creation.box([1, 1, 0.5]), placed(50, 0.0, 1.0))
    np.testing.assert_allclose(gap, 0.0, atol=1e-12)
