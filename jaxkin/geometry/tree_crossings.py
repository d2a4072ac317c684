"""Find the crossing triangles of pairs of solids for many displacements at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.geometry.node_boxes import NodeBoxes, split
from jaxkin.geometry.solid_pairs import SolidPairs
from jaxkin.geometry.triangle_distance import triangle_depths

_MAX_ITEMS = 1 << 18
"""Items that are split at once: their arrays, some 100 numbers an item, then take 200 MB."""


class Crossings(NamedTuple):
    """Triangles that cross."""

    place: Int[np.ndarray, " _"]
    """Place of the displacement among those of all pairs."""
    first: Int[np.ndarray, " _"]
    """Triangle of solid 1, in the forest."""
    second: Int[np.ndarray, " _"]
    """Triangle of solid 2."""


class Slack(NamedTuple):
    """What two solids may overlap without crossing."""

    least: float
    """Length by which any two triangles may overlap."""
    first: Float[np.ndarray, " labels"]
    """Length by which triangles of each label of solid 1 may overlap in addition."""
    second: Float[np.ndarray, " labels"]
    """The same of solid 2."""
    ignored: Bool[np.ndarray, "labels labels"]
    """Pairs of labels, of solid 1 and of solid 2, whose triangles are not compared."""

    def exchanged(self) -> Slack:
        """Say the same with solid 2 first."""
        return Slack(self.least, self.second, self.first, self.ignored.T)


class _Slacks:
    """The slacks of many pairs: rows of labels, and matrices of those that ignore some, one behind the other."""

    def __init__(self, slacks: Sequence[Slack]):
        rows = [row for slack in slacks for row in (slack.first, slack.second)]
        self.length = np.concatenate(rows)
        self.begin = np.cumsum([0, *map(len, rows)])[:-1].reshape(-1, 2)
        some = [slack.ignored for slack in slacks if slack.ignored.any()]
        self.width = np.array([len(slack.second) for slack in slacks])
        self.ignores = np.array([bool(slack.ignored.any()) for slack in slacks])
        self.ignored = np.concatenate([np.zeros(0, bool), *(each.ravel() for each in some)])
        self.matrix = np.zeros(len(slacks), int)
        self.matrix[self.ignores] = np.cumsum([0, *(each.size for each in some)])[:-1]
        self.alone = np.zeros(len(self.length), bool)
        for pair in np.flatnonzero(self.ignores).tolist():
            for side, row in enumerate((np.all(slacks[pair].ignored, axis=1), np.all(slacks[pair].ignored, axis=0))):
                self.alone[self.begin[pair, side] : self.begin[pair, side] + len(row)] = row

    def compared(self, pair: np.ndarray, labels: np.ndarray) -> Bool[np.ndarray, " items"]:
        """Tell which nodes are compared, by pairs and by the labels (items, 2) of their triangles, -1 where several."""
        found = np.ones(len(pair), bool)
        (some,) = np.nonzero(self.ignores[pair])
        pair, labels = pair[some], labels[some]
        known = labels >= 0
        alone = np.any(self.alone[self.begin[pair] + labels] & known, axis=1)
        both = np.flatnonzero(known.all(axis=1) & ~alone)
        alone[both] = self.ignored[self.matrix[pair[both]] + labels[both, 0] * self.width[pair[both]] + labels[both, 1]]
        found[some] = ~alone
        return found


def crossings(pairs: SolidPairs, slacks: Sequence[Slack]) -> Crossings:
    """Find the triangles that cross by more than the slack of their pair, for all displacements.

    The least overlap is the same for all pairs.
    """
    tree, intervals, tables, least = pairs.tree, pairs.intervals, _Slacks(slacks), slacks[0].least
    stack, found = [pairs.start()], [np.zeros((0, 3), int)]
    while stack:
        items = stack.pop()
        if len(items) > _MAX_ITEMS:
            stack += np.array_split(items, len(items) // _MAX_ITEMS + 1)
            continue
        items = items[tables.compared(intervals.pair[items[:, 0]], tree.label[items[:, 1:]])]
        items, in_time = _overlap(pairs, items, least)
        done = intervals.is_one[items[:, 0]] & np.all(tree.is_leaf[items[:, 1:]], axis=1)
        found.append(_crossing(pairs, items[done], tables, least))
        if not done.all():
            stack.append(split(pairs, items[~done], in_time[~done]))
    return Crossings(*np.concatenate(found).T)


def _crossing(pairs: SolidPairs, leaves: np.ndarray, slacks: _Slacks, least: float) -> np.ndarray:
    """Keep the items of single triangles that cross, as places and triangles."""
    if not len(leaves):
        return leaves
    tree, pair = pairs.tree, pairs.intervals.pair[leaves[:, 0]]
    place, (first, second) = pairs.intervals.middle[leaves[:, 0]], tree.triangle[leaves[:, 1:]].T
    allowed = slacks.length[slacks.begin[pair] + tree.label[leaves[:, 1:]]].sum(axis=1)
    found = triangle_depths(tree.triangles[first], pairs.displaced.of(place, tree.triangles[second]))
    return np.stack([place, first, second], axis=-1)[found > least + allowed]


def _overlap(pairs: SolidPairs, items: np.ndarray, depth: float) -> tuple[np.ndarray, np.ndarray]:
    """Keep the items whose boxes may overlap by more than a depth along all axes; whether to go on in time."""
    boxes = NodeBoxes.of(pairs, items)
    along1 = boxes.along1()
    near = np.all(along1 - boxes.swept1 < -depth, axis=0)
    boxes, items, along1 = boxes.at(near), items[near], along1[:, near]
    along2 = boxes.along2()
    near = np.all(along2 - boxes.swept2 < -depth, axis=0)
    boxes, items = boxes.at(near), items[near]
    off = ~np.all((along1[:, near] < -depth) & (along2[:, near] < -depth), axis=0)
    own = boxes.along_own(pairs, items)
    near = np.all([apart - swept < -depth for apart, swept in own], axis=(0, 1))
    off = (off | ~np.all([apart < -depth for apart, _ in own], axis=(0, 1)))[near]
    boxes, items = boxes.at(near), items[near]
    # what the middle displacement leaves out is only let in by the width of the interval
    leaves = np.all(pairs.tree.is_leaf[items[:, 1:]], axis=1)
    return items, ~pairs.intervals.is_one[items[:, 0]] & (leaves | off | (boxes.swept() > boxes.size()))


def may_overlap(pairs: SolidPairs, depth: float) -> Bool[np.ndarray, " places"]:
    """Tell at which displacements the boxes of two solids overlap by more than a depth along all their axes."""
    places = np.arange(len(pairs.pair))
    boxes = NodeBoxes.of(pairs, pairs.alone(places))
    return np.all((boxes.along1() < -depth) & (boxes.along2() < -depth), axis=0)
