"""Join solids to a forest, and pairs of them to one list, each pair at displacements of its own: searched together.

What a search costs is, for most pairs, not what it looks at but that it is begun: of thousands of pairs at once every
step of it works on long arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.hull_distance import nearest_of_hulls
from jaxkin.geometry.part import outermost
from jaxkin.geometry.pose_intervals import PoseIntervals, pose_intervals
from jaxkin.geometry.triangle_distance import Points
from jaxkin.geometry.triangle_tree import TriangleTree

_AT_ONCE = 1 << 22
"""Coordinates of corners along directions that are held at once."""


class Forest(NamedTuple):
    """The trees of several solids in one."""

    tree: TriangleTree
    """The nodes, triangles and children of all, one solid after the other; labels are those of each solid."""
    roots: Int[np.ndarray, " solids"]
    """The node that holds each solid."""
    first: Int[np.ndarray, " solids"]
    """The first triangle of each solid."""
    corners: tuple[Points, ...]
    """Of each solid the corners of its convex hull."""
    trees: tuple[TriangleTree, ...]
    """Each solid by itself."""


def forest(trees: Sequence[TriangleTree]) -> Forest:
    """Put trees behind one another."""
    roots = np.cumsum([0, *(len(each.low) for each in trees)])[:-1]
    first = np.cumsum([0, *(len(each.triangles) for each in trees)])[:-1]
    rows = zip(trees, roots, first, strict=True)
    moved = [(each.children + root, each.triangle + begin) for each, root, begin in rows]
    joined = TriangleTree(
        np.concatenate([each.triangles for each in trees]),
        np.concatenate([each.low for each in trees]),
        np.concatenate([each.high for each in trees]),
        np.concatenate([children for children, _ in moved]),
        np.concatenate([triangle for _, triangle in moved]),
        np.concatenate([each.label for each in trees]),
        np.concatenate([each.own_axes for each in trees], axis=-1),
        np.concatenate([each.own_middles for each in trees], axis=-1),
        np.concatenate([each.own_halves for each in trees], axis=-1),
    )
    corners = tuple(outermost(each.triangles.reshape(-1, 3)) for each in trees)
    return Forest(joined, roots, first, corners, tuple(trees))


@dataclass(frozen=True, eq=False)
class SolidPairs:
    """Pairs of solids, with the displacements of the second of each relative to the first, one pair after the other.

    What is found for them is in the order of all these displacements; a *place* is an index of that order.
    """

    solids: Forest
    numbers: Int[np.ndarray, "pairs 2"]
    """The two solids of each pair."""
    displaced: Displaced
    begin: Int[np.ndarray, " pairs"]
    """The place of the first displacement of each pair, which has one at least."""

    @staticmethod
    def of(solids: Forest, pairs: Sequence[tuple[int, int]], displaced: Sequence[Displaced]) -> SolidPairs:
        """Join pairs of solids, given by their numbers in a forest."""
        counts = [len(each.shift) for each in displaced]
        rotation, shift = (np.concatenate(rows) for rows in zip(*displaced, strict=True))
        begin = np.cumsum([0, *counts])[:-1]
        return SolidPairs(solids, np.asarray(pairs), Displaced(rotation, shift), begin)

    @staticmethod
    def one(first: TriangleTree, second: TriangleTree, displaced: Displaced) -> SolidPairs:
        """Make a list of a single pair."""
        return SolidPairs.of(forest([first, second]), [(0, 1)], [displaced])

    @property
    def tree(self) -> TriangleTree:
        """The tree of all solids."""
        return self.solids.tree

    @cached_property
    def roots(self) -> Int[np.ndarray, "pairs 2"]:
        """The nodes that hold the two solids of each pair."""
        return self.solids.roots[self.numbers]

    @cached_property
    def pair(self) -> Int[np.ndarray, " places"]:
        """The pair of each place."""
        counts = np.diff(self.begin, append=len(self.displaced.shift))
        return np.repeat(np.arange(len(self.begin)), counts)

    @cached_property
    def intervals(self) -> PoseIntervals:
        """Intervals of the displacements of each pair; those that hold all of a pair come first."""
        return pose_intervals(self.displaced, self.begin, self.tree.middles[:, self.roots[:, 1]].T)

    def start(self) -> Int[np.ndarray, "pairs 3"]:
        """Make the items that hold all displacements and all triangles of each pair."""
        return np.column_stack([np.arange(len(self.roots)), self.roots])

    def alone(self, places: Int[np.ndarray, " _"]) -> Int[np.ndarray, "_ 3"]:
        """Make items of all triangles at single displacements."""
        return np.column_stack([self.intervals.alone[places], self.roots[self.pair[places]]])

    def at(self, places: Int[np.ndarray, " _"]) -> SolidPairs:
        """Choose some of the displacements, in order; a pair that has none of them is left out."""
        pairs, begin = np.unique(self.pair[places], return_index=True)
        return SolidPairs(self.solids, self.numbers[pairs], self.displaced.at(places), begin)

    def nearest_of_hulls(self) -> Float[np.ndarray, "places 2 3"]:
        """Find the nearest points of the convex hulls of both solids at each place, in the axes of each solid."""
        rotation, shift = self.displaced
        numbers, corners = self.numbers[self.pair], self.solids.corners

        def support(places: np.ndarray, direction: np.ndarray) -> np.ndarray:
            back = np.einsum("pij,pi->pj", rotation[places], direction)
            one = _least(corners, numbers[places, 0], -direction)[1]
            other = _least(corners, numbers[places, 1], back)[1]
            return np.stack([one, self.displaced.of(places, other)], axis=1)

        every = np.arange(len(shift))
        found = nearest_of_hulls(support(every, np.tile(np.eye(3)[0], (len(shift), 1))), support)
        found[:, 1] = np.einsum("pij,pi->pj", rotation, found[:, 1] - shift)
        return found

    def ahead(self, direction: Float[np.ndarray, "3 places"]) -> Float[np.ndarray, " places"]:
        """Measure how far all of the second solid is ahead of all of the first, along a direction at each place in the
        axes of the first: less than 0 where they overlap along it. Their distance is no less."""
        turned = np.einsum("pij,ip->pj", self.displaced.rotation, direction)
        found = np.einsum("pi,ip->p", self.displaced.shift, direction)
        found += _least(self.solids.corners, self.numbers[self.pair, 1], turned)[0]
        return found + _least(self.solids.corners, self.numbers[self.pair, 0], -direction.T)[0]

    def nearest_triangles(self, points: Float[np.ndarray, "places 2 3"]) -> Int[np.ndarray, "places 2"]:
        """Find the triangle of each solid that is nearest to a point in its axes, at each place."""
        found, numbers = np.zeros((len(points), 2), int), self.numbers[self.pair]
        for side in (0, 1):
            for number in np.unique(numbers[:, side]):
                (own,) = np.nonzero(numbers[:, side] == number)
                nearest = self.solids.trees[number].signed_distances(points[own, side])[1]
                found[own, side] = nearest + self.solids.first[number]
        return found


def _least(corners: Sequence[Points], solid: np.ndarray, direction: Points) -> tuple[np.ndarray, Points]:
    """Find which corner of a solid is least along each direction, and how far along it that is."""
    found, least = np.zeros((len(solid), 3)), np.zeros(len(solid))
    for number in np.unique(solid):
        (own,) = np.nonzero(solid == number)
        for some in np.array_split(own, len(own) * len(corners[number]) // _AT_ONCE + 1):
            along = direction[some] @ corners[number].T
            index = np.argmin(along, axis=1)
            found[some], least[some] = corners[number][index], along[np.arange(len(some)), index]
    return least, found
