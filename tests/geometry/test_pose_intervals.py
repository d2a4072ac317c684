"""Bounds over intervals of poses held to all poses of them, and distances and crossings to those of each pose alone."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.node_boxes import NodeBoxes
from jaxkin.geometry.pose_intervals import pose_intervals
from jaxkin.geometry.tree_crossings import Slack, crossings
from jaxkin.geometry.tree_distances import distances
from jaxkin.geometry.triangle_distance import triangle_distances
from jaxkin.geometry.triangle_tree import triangle_tree


def tree(mesh):
    return triangle_tree(np.array(mesh.triangles), np.zeros(len(mesh.triangles), int))


ONE = tree(trimesh.creation.box(extents=(3.0, 2.0, 1.0)))
OTHER = tree(trimesh.creation.icosphere(2, radius=0.8))


def path(count, seed, far):
    """A smooth path of displacements with all rotations, which begins and ends `far` away and passes solid 1."""
    generator = np.random.default_rng(seed)
    t = np.linspace(-1, 1, count)
    turn = Rotation.from_rotvec(t[:, None] * generator.normal(size=3) * 1.5).as_matrix()
    shift = np.outer(t, far * np.array([1.0, 0.3, 0.1])) + generator.normal(size=3) * 0.3 + [0, 0.8, 0.7]
    return Displaced(turn, shift)


def brute(moved):
    """Distances of all triangles of one solid from all of the other at each pose."""
    i, j = (each.ravel() for each in np.indices((len(ONE.triangles), len(OTHER.triangles))))
    return np.array(
        [
            triangle_distances(ONE.triangles[i], moved.of(np.full(len(j), p), OTHER.triangles[j])).min()
            for p in range(len(moved.shift))
        ]
    )


@pytest.mark.parametrize("count", [1, 2, 7, 16])
def test_intervals_hold_all_poses_once_a_level(count):
    moved = path(count, 0, 2.0)
    intervals = pose_intervals(moved, np.zeros(3))
    assert intervals.begin[0] == 0 and intervals.end[0] == count
    for k in np.flatnonzero(~intervals.is_one):
        left, right = intervals.children[k]
        assert intervals.begin[left] == intervals.begin[k] and intervals.end[right] == intervals.end[k]
        assert intervals.end[left] == intervals.begin[right]
    ones = np.flatnonzero(intervals.is_one)
    assert set(intervals.begin[ones]) == set(range(count))
    assert not intervals.turning[..., ones].any() and not intervals.shifting[:, ones].any()


def test_boxes_of_an_interval_are_no_farther_apart_than_at_any_of_its_poses():
    moved = path(16, 1, 3.0)
    intervals = pose_intervals(moved, np.zeros(3))
    generator = np.random.default_rng(2)
    nodes1, nodes2 = (generator.integers(0, len(each.low), 40) for each in (ONE, OTHER))
    single = {int(intervals.begin[k]): int(k) for k in np.flatnonzero(intervals.is_one)}
    for k in np.flatnonzero(~intervals.is_one):
        of = NodeBoxes.of(ONE, OTHER, intervals, np.stack([np.full(40, k), nodes1, nodes2], axis=-1))
        for pose in range(intervals.begin[k], intervals.end[k]):
            own = NodeBoxes.of(ONE, OTHER, intervals, np.stack([np.full(40, single[pose]), nodes1, nodes2], axis=-1))
            # rounding of sums of a few lengths near 1
            assert np.all(of.along1() - of.swept1 <= own.along1() + 1e-12)
            assert np.all(of.along2() - of.swept2 <= own.along2() + 1e-12)


@pytest.mark.parametrize("seed", [3, 4])
def test_distances_and_crossings_are_those_of_all_pairs_of_triangles(seed):
    moved = path(21, seed, 4.0)
    expected = brute(moved)
    assert (expected == 0).any() and (expected > 1.0).any()
    np.testing.assert_allclose(distances(ONE, OTHER, moved, 10.0), expected, atol=1e-12)
    near = distances(ONE, OTHER, moved, 0.5)
    np.testing.assert_allclose(near, np.where(expected <= 0.5, expected, np.inf), atol=1e-12)
    none = [np.zeros(len(each.triangles)) for each in (ONE, OTHER)]
    found = crossings(ONE, OTHER, moved, Slack(0.0, *none, np.zeros((1, 1), bool)))
    np.testing.assert_array_equal(np.unique(found.pose), np.flatnonzero(expected == 0))


def test_what_is_split_piece_by_piece_is_the_same(monkeypatch):
    moved, none = path(21, 3, 4.0), [np.zeros(len(each.triangles)) for each in (ONE, OTHER)]
    slack = Slack(0.0, *none, np.zeros((1, 1), bool))
    whole = crossings(ONE, OTHER, moved, slack)
    monkeypatch.setattr("jaxkin.geometry.tree_crossings._MAX_ITEMS", 64)
    pieces = crossings(ONE, OTHER, moved, slack)
    assert len(whole.pose) > 100
    assert sorted(zip(*whole, strict=True)) == sorted(zip(*pieces, strict=True))
