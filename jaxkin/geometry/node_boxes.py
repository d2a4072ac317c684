"""Boxes of pairs of nodes of two trees, one displaced relative to the other, within intervals of displacements.

An item is an interval, a node of tree 1 and a node of tree 2, as indices (items, 3). Items are split level by level, in
space or in time; what is left of all intervals is split in one array.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose_intervals import PoseIntervals
from jaxkin.geometry.triangle_tree import TriangleTree

START = ((0, 0, 0),)
"""The item that holds all displacements and all triangles."""


class NodeBoxes(NamedTuple):
    """Boxes of items, with the items as last axis: contiguous rows are several times faster to work with."""

    turn: Float[np.ndarray, "3 3 items"]
    """Rotation of box 2, in the middle of the interval."""
    between: Float[np.ndarray, "3 items"]
    """From the middle of box 1 to that of box 2, along the axes of tree 1."""
    half1: Float[np.ndarray, "3 items"]
    """Half the size of box 1, along the axes of tree 1."""
    half2: Float[np.ndarray, "3 items"]
    """Half the size of box 2, along the axes of tree 2."""
    swept1: Float[np.ndarray, "3 items"]
    """How far box 2 may be from there within the interval, along the axes of tree 1."""
    swept2: Float[np.ndarray, "3 items"]
    """The same of box 1, along the axes of tree 2."""

    @staticmethod
    def of(one: TriangleTree, other: TriangleTree, intervals: PoseIntervals, items: np.ndarray) -> NodeBoxes:
        """Gather the boxes of items."""
        which, node1, node2 = np.ascontiguousarray(items.T)
        turn, shift = intervals.turn[:, :, which], intervals.shift[:, which]
        middle1, half1 = one.middles[:, node1], one.halves[:, node1]
        middle2, half2 = other.middles[:, node2], other.halves[:, node2]
        between = _times(turn, middle2) + shift - middle1
        swept1, swept2 = np.zeros_like(between), np.zeros_like(between)
        (several,) = np.nonzero(~intervals.is_one[which])
        if len(several):
            which = which[several]
            turning = intervals.turning[:, :, which]
            arm2 = np.abs(middle2[:, several] - intervals.point[:, None]) + half2[:, several]
            arm1 = np.abs(middle1[:, several] - intervals.place[:, which]) + half1[:, several]
            swept1[:, several] = _times(turning, arm2) + intervals.shifting[:, which]
            swept2[:, several] = _times(turning.swapaxes(0, 1), arm1) + intervals.back_shifting[:, which]
        return NodeBoxes(turn, between, half1, half2, swept1, swept2)

    def along1(self) -> Float[np.ndarray, "3 items"]:
        """Measure by how much the boxes are apart along the axes of tree 1, in the middle of the interval.

        Negative where they overlap: by the length that the one would have to move to be outside of the other. At other
        displacements of the interval it is up to `swept1` less.
        """
        return np.abs(self.between) - self.half1 - _times(np.abs(self.turn), self.half2)

    def along2(self) -> Float[np.ndarray, "3 items"]:
        """Compute the same lengths along the axes of tree 2, and up to `swept2`."""
        back = self.turn.swapaxes(0, 1)
        return np.abs(_times(back, self.between)) - self.half2 - _times(np.abs(back), self.half1)

    def distances(self) -> Float[np.ndarray, "2 items"]:
        """Bound the distance of the triangles of two nodes from below: at all displacements, and at the middle one."""
        both = [(self.along1(), self.swept1), (self.along2(), self.swept2)]
        found = [
            [np.sum(np.maximum(along - room * swept, 0.0) ** 2, axis=0) for along, swept in both] for room in (1, 0)
        ]
        return np.sqrt(np.max(found, axis=1))

    def at(self, some: np.ndarray) -> NodeBoxes:
        """Choose some of the items."""
        return NodeBoxes(*(each[..., some] for each in self))

    def swept(self) -> Float[np.ndarray, " items"]:
        """Find the largest length by which the boxes may move within the interval."""
        return np.maximum(self.swept1.max(axis=0), self.swept2.max(axis=0))

    def size(self) -> Float[np.ndarray, " items"]:
        """Find half the size of the larger box."""
        return np.maximum(self.half1.max(axis=0), self.half2.max(axis=0))


def _times(turn: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Multiply matrices (3, 3, _) with vectors (3, _)."""
    return np.stack([row[0] * vectors[0] + row[1] * vectors[1] + row[2] * vectors[2] for row in turn])


def split(
    one: TriangleTree, other: TriangleTree, intervals: PoseIntervals, items: np.ndarray, in_time: np.ndarray
) -> np.ndarray:
    """Replace each item by those of the halves of its interval, or else by the pairs of children of its nodes.

    Leaves and single displacements stay as they are.
    """
    halves = intervals.children[items[in_time, 0]]
    found = [np.column_stack([half, items[in_time, 1:]]) for half in halves.T]
    items = items[~in_time]
    first, second = one.children[items[:, 1]], other.children[items[:, 2]]
    split1, split2 = ~one.is_leaf[items[:, 1]], ~other.is_leaf[items[:, 2]]
    for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)):
        keep = (split1 | (i == 0)) & (split2 | (j == 0))
        found.append(np.column_stack([items[keep, 0], first[keep, i], second[keep, j]]))
    return np.concatenate(found)
