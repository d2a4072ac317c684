"""Boxes of two nodes of a forest, one displaced relative to the other, within intervals of displacements.

An item is an interval of a pair of solids, a node of solid 1 and a node of solid 2, as indices (items, 3). Items are
split level by level, in space or in time; what is left of all intervals of all pairs is split in one array.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.solid_pairs import SolidPairs


class NodeBoxes(NamedTuple):
    """Boxes of items, with the items as last axis: contiguous rows are several times faster to work with."""

    turn: Float[np.ndarray, "3 3 items"]
    """Rotation of box 2, in the middle of the interval."""
    between: Float[np.ndarray, "3 items"]
    """From the middle of box 1 to that of box 2, along the axes of solid 1."""
    half1: Float[np.ndarray, "3 items"]
    """Half the size of box 1, along the axes of solid 1."""
    half2: Float[np.ndarray, "3 items"]
    """Half the size of box 2, along the axes of solid 2."""
    swept1: Float[np.ndarray, "3 items"]
    """How far box 2 may be from there within the interval, along the axes of solid 1."""
    swept2: Float[np.ndarray, "3 items"]
    """The same of box 1, along the axes of solid 2."""

    @staticmethod
    def of(pairs: SolidPairs, items: np.ndarray) -> NodeBoxes:
        """Gather the boxes of items."""
        tree, intervals = pairs.tree, pairs.intervals
        which, node1, node2 = np.ascontiguousarray(items.T)
        turn, shift = intervals.turn[:, :, which], intervals.shift[:, which]
        middle1, half1 = tree.middles[:, node1], tree.halves[:, node1]
        middle2, half2 = tree.middles[:, node2], tree.halves[:, node2]
        between = _times(turn, middle2) + shift - middle1
        swept1, swept2 = np.zeros_like(between), np.zeros_like(between)
        (several,) = np.nonzero(~intervals.is_one[which])
        if len(several):
            which = which[several]
            turning = intervals.turning[:, :, which]
            arm2 = np.abs(middle2[:, several] - intervals.point[:, intervals.pair[which]]) + half2[:, several]
            arm1 = np.abs(middle1[:, several] - intervals.place[:, which]) + half1[:, several]
            swept1[:, several] = _times(turning, arm2) + intervals.shifting[:, which]
            swept2[:, several] = _times(turning.swapaxes(0, 1), arm1) + intervals.back_shifting[:, which]
        return NodeBoxes(turn, between, half1, half2, swept1, swept2)

    def along1(self) -> Float[np.ndarray, "3 items"]:
        """Measure by how much the boxes are apart along the axes of solid 1, in the middle of the interval.

        Negative where they overlap: by the length that the one would have to move to be outside of the other. At other
        displacements of the interval it is up to `swept1` less.
        """
        return np.abs(self.between) - self.half1 - _times(np.abs(self.turn), self.half2)

    def along2(self) -> Float[np.ndarray, "3 items"]:
        """Compute the same lengths along the axes of solid 2, and up to `swept2`."""
        back = self.turn.swapaxes(0, 1)
        return np.abs(_times(back, self.between)) - self.half2 - _times(np.abs(back), self.half1)

    def distances(self) -> Float[np.ndarray, "2 items"]:
        """Bound the distance of the triangles of two nodes from below: at all displacements, and at the middle one."""
        return lengths([(self.along1(), self.swept1), (self.along2(), self.swept2)])

    def along_own(self, pairs: SolidPairs, items: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Measure by how much the boxes are apart along the own axes of the nodes of solid 1, and of solid 2.

        Two arrays (3, items) for each of these: in the middle of the interval, and by how much less it may be within.
        """
        tree, back = pairs.tree, self.turn.swapaxes(0, 1)
        found = []
        for node, turn, between, half, swept in (
            (items[:, 1], back, self.between, self.half2, self.swept1),
            (items[:, 2], self.turn, -_times(back, self.between), self.half1, self.swept2),
        ):
            axes = tree.own_axes[:, :, node]
            apart = np.abs(_times(axes, between) - tree.own_middles[:, node]) - tree.own_halves[:, node]
            apart -= np.stack([_dot(np.abs(_times(turn, axis)), half) for axis in axes])
            found.append((apart, _times(np.abs(axes), swept)))
        return found

    def along(
        self, direction: Float[np.ndarray, "3 items"], pairs: SolidPairs, items: np.ndarray
    ) -> tuple[Float[np.ndarray, " items"], Float[np.ndarray, " items"]]:
        """Measure how far box 2 is ahead of box 1 along a direction in the axes of solid 1, by their own axes.

        Returns this in the middle of the interval, and by how much less it may be within.
        """
        tree, ahead = pairs.tree, _dot(direction, self.between)
        own = (items[:, 1], direction, -1.0), (items[:, 2], _times(self.turn.swapaxes(0, 1), direction), 1.0)
        for node, seen, sign in own:
            seen = _times(tree.own_axes[:, :, node], seen)
            ahead += sign * _dot(seen, tree.own_middles[:, node]) - _dot(np.abs(seen), tree.own_halves[:, node])
        return ahead, _dot(np.abs(direction), self.swept1)

    def at(self, some: np.ndarray) -> NodeBoxes:
        """Choose some of the items."""
        return NodeBoxes(*(each[..., some] for each in self))

    def swept(self) -> Float[np.ndarray, " items"]:
        """Find the largest length by which the boxes may move within the interval."""
        return np.maximum(self.swept1.max(axis=0), self.swept2.max(axis=0))

    def size(self) -> Float[np.ndarray, " items"]:
        """Find half the size of the larger box."""
        return np.maximum(self.half1.max(axis=0), self.half2.max(axis=0))


def lengths(apart: Sequence[tuple[np.ndarray, np.ndarray]]) -> Float[np.ndarray, "2 items"]:
    """Bound distances by how much boxes are apart along several axes, by several of these: the largest bound.

    Each is given with the room that it loses within an interval: bounds are at all displacements, and the middle one.
    """
    found = [[np.sum(np.maximum(along - room * swept, 0.0) ** 2, axis=0) for along, swept in apart] for room in (1, 0)]
    return np.sqrt(np.max(found, axis=1))


def _times(turn: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Multiply matrices (3, 3, _) with vectors (3, _)."""
    return np.stack([row[0] * vectors[0] + row[1] * vectors[1] + row[2] * vectors[2] for row in turn])


def _dot(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Multiply vectors (3, _) with vectors (3, _)."""
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def split(pairs: SolidPairs, items: np.ndarray, in_time: np.ndarray) -> np.ndarray:
    """Replace each item by those of the halves of its interval, or else by those of the children of its larger node.

    Nodes of one size at a time: many small ones of the one solid would each be compared with all of the other that is
    not split yet. Leaves and single displacements stay as they are.
    """
    tree = pairs.tree
    halves = pairs.intervals.children[items[in_time, 0]]
    found = [np.column_stack([half, items[in_time, 1:]]) for half in halves.T]
    items = items[~in_time]
    side = 1 + np.argmax(tree.sizes[items[:, 1:]], axis=1)
    rows = np.arange(len(items))
    node = items[rows, side]
    for k in (0, 1):
        some = slice(None) if k == 0 else ~tree.is_leaf[node]
        child = items[some].copy()
        child[np.arange(len(child)), side[some]] = tree.children[node[some], k]
        found.append(child)
    return np.concatenate(found)
