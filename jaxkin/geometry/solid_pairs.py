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
from jaxtyping import Int

from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.pose_intervals import PoseIntervals, pose_intervals
from jaxkin.geometry.triangle_tree import TriangleTree


class Forest(NamedTuple):
    """The trees of several solids in one."""

    tree: TriangleTree
    """The nodes, triangles and children of all, one solid after the other; labels are those of each solid."""
    roots: Int[np.ndarray, " solids"]
    """The node that holds each solid."""
    first: Int[np.ndarray, " solids"]
    """The first triangle of each solid."""


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
    return Forest(joined, roots, first)


@dataclass(frozen=True, eq=False)
class SolidPairs:
    """Pairs of solids, with the displacements of the second of each relative to the first, one pair after the other.

    What is found for them is in the order of all these displacements; a *place* is an index of that order.
    """

    tree: TriangleTree
    """The solids, a forest."""
    roots: Int[np.ndarray, "pairs 2"]
    """The nodes that hold the two solids of each pair."""
    displaced: Displaced
    begin: Int[np.ndarray, " pairs"]
    """The place of the first displacement of each pair, which has one at least."""

    @staticmethod
    def of(solids: Forest, pairs: Sequence[tuple[int, int]], displaced: Sequence[Displaced]) -> SolidPairs:
        """Join pairs of solids, given by their numbers in a forest."""
        counts = [len(each.shift) for each in displaced]
        rotation, shift = (np.concatenate(rows) for rows in zip(*displaced, strict=True))
        begin = np.cumsum([0, *counts])[:-1]
        return SolidPairs(solids.tree, solids.roots[np.asarray(pairs)], Displaced(rotation, shift), begin)

    @staticmethod
    def one(first: TriangleTree, second: TriangleTree, displaced: Displaced) -> SolidPairs:
        """Make a list of a single pair."""
        return SolidPairs.of(forest([first, second]), [(0, 1)], [displaced])

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
        return SolidPairs(self.tree, self.roots[pairs], self.displaced.at(places), begin)
