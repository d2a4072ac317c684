"""Distances of solids that are near each other all over: right, and found with few items at once."""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry import tree_distances
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.solid_pairs import SolidPairs
from jaxkin.geometry.tree_distances import distances
from jaxkin.geometry.triangle_distance import triangle_distances
from jaxkin.geometry.triangle_tree import triangle_tree

SECTIONS, STACKS, GAP = 12, 6, 0.01


def wall(radius):
    """The wall of a prism about z, in many triangles: every one of a rod is as near to its tube as the others."""
    heights = np.linspace(0.0, 4.0, STACKS)
    mesh = trimesh.creation.revolve(np.stack([np.full(STACKS, radius), heights], axis=-1), sections=SECTIONS)
    return triangle_tree(np.array(mesh.triangles), np.zeros(len(mesh.triangles), int))


@pytest.fixture(scope="module")
def solids():
    return wall(1.0), wall(1.0 + GAP)


def slid(solids, at_once, monkeypatch):
    """The distances of a rod that slides in its tube, and the largest number of items that were split at once."""
    largest = [0]

    def split(pairs, items, in_time):
        largest[0] = max(largest[0], len(items))
        return original(pairs, items, in_time)

    original = tree_distances.split
    monkeypatch.setattr(tree_distances, "_MAX_ITEMS", at_once)
    monkeypatch.setattr(tree_distances, "split", split)
    shift = np.outer(np.linspace(-0.5, 0.5, 3), [0.0, 0.0, 1.0])
    pairs = SolidPairs.one(*solids, Displaced(np.tile(np.eye(3), (3, 1, 1)), shift))
    return distances(pairs, 0.5), largest[0]


def test_a_rod_in_a_tube_is_as_near_all_over(solids, monkeypatch):
    """Sides of two prisms with the same number of sides are parallel: the gap times the cosine of half a section."""
    expected = GAP * np.cos(np.pi / SECTIONS)
    found, most = slid(solids, 1 << 30, monkeypatch)
    np.testing.assert_allclose(found, expected, rtol=1e-8)  # pairs nearer by less than 1e-9 of it are not looked for
    few, bounded = slid(solids, 200, monkeypatch)
    np.testing.assert_allclose(few, expected, rtol=1e-8)
    assert bounded <= 200 < most


def test_distances_are_those_of_all_triangles():
    """A bracket with two legs and a bar, apart, with overlapping hulls, and across each other, at poses far apart."""
    legs = [trimesh.creation.box([6, 1, 1]), trimesh.creation.box([1, 1, 4])]
    legs[1].apply_translation([2.5, 0, 2.5])
    bracket = trimesh.util.concatenate(legs)
    one, other = (
        triangle_tree(np.array(mesh.triangles), np.zeros(len(mesh.triangles), int))
        for mesh in (bracket, trimesh.creation.cylinder(0.4, 2.0, sections=12))
    )
    random = np.random.default_rng(0)
    turns = np.stack([trimesh.transformations.random_rotation_matrix(random.random(3))[:3, :3] for _ in range(60)])
    displaced = Displaced(turns, random.uniform([-4, -2, 0.5], [4, 2, 6], (60, 3)))
    rows = np.repeat(np.arange(len(one.triangles)), len(other.triangles))
    expected = []
    for pose in range(60):
        moved = displaced.of(np.full(len(other.triangles), pose), other.triangles)
        expected.append(triangle_distances(one.triangles[rows], np.tile(moved, (len(one.triangles), 1, 1))).min())
    expected = np.array(expected)
    assert np.sum(expected == 0) > 5 and np.sum((expected > 0) & (expected < 1)) > 20
    # pairs nearer by less than 1e-9 of the distance are not looked for
    found = distances(SolidPairs.one(one, other, displaced), 2.0)
    np.testing.assert_allclose(found, np.where(expected <= 2.0, expected, np.inf), rtol=2e-9)
