"""Bounds over intervals of poses held to all poses of them, and distances and crossings to those of each pose alone."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.node_boxes import NodeBoxes
from jaxkin.geometry.pose_intervals import pose_intervals
from jaxkin.geometry.solid_pairs import SolidPairs, forest
from jaxkin.geometry.tree_crossings import Slack, crossings, may_overlap
from jaxkin.geometry.tree_distances import distances
from jaxkin.geometry.triangle_distance import triangle_distances
from jaxkin.geometry.triangle_tree import triangle_tree


def tree(mesh):
    return triangle_tree(np.array(mesh.triangles), np.zeros(len(mesh.triangles), int))


ONE = tree(trimesh.creation.box(extents=(3.0, 2.0, 1.0)))
OTHER = tree(trimesh.creation.icosphere(2, radius=0.8))


NONE = Slack(0.0, np.zeros(1), np.zeros(1), np.zeros((1, 1), bool))


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


@pytest.mark.parametrize("counts", [(1,), (2,), (7,), (16,), (3, 1, 8)])
def test_intervals_hold_all_poses_of_a_pair_once_a_level(counts):
    moved = path(sum(counts), 0, 2.0)
    first = np.cumsum([0, *counts])[:-1]
    intervals = pose_intervals(moved, first, np.zeros((len(counts), 3)))
    assert [*intervals.begin[: len(counts)]] == [*first] and intervals.end[len(counts) - 1] == sum(counts)
    assert [*intervals.pair[: len(counts)]] == [*range(len(counts))]
    for k in np.flatnonzero(~intervals.is_one):
        left, right = intervals.children[k]
        assert intervals.begin[left] == intervals.begin[k] and intervals.end[right] == intervals.end[k]
        assert intervals.end[left] == intervals.begin[right]
        assert intervals.pair[left] == intervals.pair[right] == intervals.pair[k]
    ones = np.flatnonzero(intervals.is_one)
    np.testing.assert_array_equal(np.sort(intervals.begin[ones]), np.arange(sum(counts)))
    np.testing.assert_array_equal(intervals.begin[intervals.alone], np.arange(sum(counts)))
    assert not intervals.turning[..., ones].any() and not intervals.shifting[:, ones].any()


def test_boxes_of_an_interval_are_no_farther_apart_than_at_any_of_its_poses():
    moved = path(16, 1, 3.0)
    pairs = SolidPairs.one(ONE, OTHER, moved)
    intervals = pairs.intervals
    generator = np.random.default_rng(2)
    nodes1 = generator.integers(0, len(ONE.low), 40)
    nodes2 = len(ONE.low) + generator.integers(0, len(OTHER.low), 40)
    direction = generator.normal(size=(3, 40))
    for k in np.flatnonzero(~intervals.is_one):
        items = np.stack([np.full(40, k), nodes1, nodes2], axis=-1)
        of = NodeBoxes.of(pairs, items)
        ahead, room = of.along(direction, pairs, items)
        for pose in range(intervals.begin[k], intervals.end[k]):
            single = np.stack([np.full(40, intervals.alone[pose]), nodes1, nodes2], axis=-1)
            own = NodeBoxes.of(pairs, single)
            # rounding of sums of a few lengths near 1
            assert np.all(of.along1() - of.swept1 <= own.along1() + 1e-12)
            assert np.all(of.along2() - of.swept2 <= own.along2() + 1e-12)
            for (apart, swept), (alone, _) in zip(
                of.along_own(pairs, items), own.along_own(pairs, single), strict=True
            ):
                assert np.all(apart - swept <= alone + 1e-12)
            # no triangle of the one node is nearer along a direction than the boxes are
            first, second = (pairs.tree.triangles[pairs.tree.triangle[node]] for node in (nodes1, nodes2))
            second = moved.of(np.full(40, pose), second)
            least = np.einsum("nci,in->nc", second, direction).min(axis=1)
            least -= np.einsum("nci,in->nc", first, direction).max(axis=1)
            assert np.all(ahead - room <= least + 1e-12)


def test_triangles_are_in_the_boxes_of_their_nodes():
    """Each node's own axes are perpendicular, and its box along them holds the triangles of its children."""
    for each in (ONE, OTHER):
        axes = np.moveaxis(each.own_axes, -1, 0)
        np.testing.assert_allclose(axes @ axes.swapaxes(1, 2), np.tile(np.eye(3), (len(axes), 1, 1)), atol=1e-12)
        held = {node: [each.triangle[node]] for node in np.flatnonzero(each.is_leaf)}
        for node in range(len(each.low) - 1, -1, -1):  # children come after their parents
            if not each.is_leaf[node]:
                held[node] = [triangle for child in each.children[node] for triangle in held[child]]
            off = each.triangles[held[node]].reshape(-1, 3) - each.middles[:, node]
            from_middle = off @ axes[node].T - each.own_middles[:, node]
            assert np.all(np.abs(from_middle) <= each.own_halves[:, node] + 1e-12)


@pytest.mark.parametrize("seed", [3, 4])
def test_distances_and_crossings_are_those_of_all_pairs_of_triangles(seed):
    moved = path(21, seed, 4.0)
    expected = brute(moved)
    assert (expected == 0).any() and (expected > 1.0).any()
    pairs = SolidPairs.one(ONE, OTHER, moved)
    np.testing.assert_allclose(distances(pairs, 10.0), expected, atol=1e-12)
    near = distances(pairs, 0.5)
    np.testing.assert_allclose(near, np.where(expected <= 0.5, expected, np.inf), atol=1e-12)
    found = crossings(pairs, [NONE])
    np.testing.assert_array_equal(np.unique(found.place), np.flatnonzero(expected == 0))
    assert np.all(may_overlap(pairs, 0.0)[found.place])


def test_many_pairs_are_as_each_alone():
    """Pairs of either order, at several numbers of displacements, with what is ignored of one and not of another."""
    one, two, three = path(21, 3, 4.0), path(1, 4, 0.1), path(9, 5, 2.0)
    all_of_it = NONE._replace(ignored=np.ones((1, 1), bool))
    given = [((0, 1), one, NONE), ((0, 1), two, all_of_it), ((1, 0), three.inverse(), NONE), ((0, 0), three, NONE)]
    trees = ONE, OTHER
    pairs = SolidPairs.of(forest(trees), [each[0] for each in given], [each[1] for each in given])
    together, crossed = distances(pairs, 3.0), crossings(pairs, [each[2] for each in given])
    counts = np.bincount(crossed.place, minlength=len(together))
    for k, ((first, second), moved, slack) in enumerate(given):
        alone = SolidPairs.one(trees[first], trees[second], moved)
        (own,) = np.nonzero(pairs.pair == k)
        np.testing.assert_allclose(together[own], distances(alone, 3.0), atol=1e-12)
        np.testing.assert_array_equal(counts[own], np.bincount(crossings(alone, [slack]).place, minlength=len(own)))
    assert counts[pairs.pair == 0].any() and not counts[pairs.pair == 1].any() and counts[pairs.pair == 2].any()
    some = np.array([1, 4, 22, 30])
    np.testing.assert_allclose(distances(pairs.at(some), 3.0), together[some], atol=1e-12)


def test_what_is_split_piece_by_piece_is_the_same(monkeypatch):
    pairs = SolidPairs.one(ONE, OTHER, path(21, 3, 4.0))
    whole = crossings(pairs, [NONE])
    monkeypatch.setattr("jaxkin.geometry.tree_crossings._MAX_ITEMS", 64)
    pieces = crossings(pairs, [NONE])
    assert len(whole.place) > 100
    assert sorted(zip(*whole, strict=True)) == sorted(zip(*pieces, strict=True))
