"""Find the crossing triangles of two solids for many displacements at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.node_boxes import START, NodeBoxes, split
from jaxkin.geometry.pose_intervals import PoseIntervals, pose_intervals
from jaxkin.geometry.triangle_distance import triangle_depths
from jaxkin.geometry.triangle_tree import TriangleTree

_MAX_ITEMS = 1 << 18
"""Items that are split at once: their arrays, some 100 numbers an item, then take 200 MB."""


class Crossings(NamedTuple):
    """Triangles that cross."""

    pose: Int[np.ndarray, " _"]
    """Index of the displacement."""
    first: Int[np.ndarray, " _"]
    """Triangle of solid 1."""
    second: Int[np.ndarray, " _"]
    """Triangle of solid 2."""


class Slack(NamedTuple):
    """What two solids may overlap without crossing."""

    least: float
    """Length by which any two triangles may overlap."""
    first: Float[np.ndarray, " triangles"]
    """Length by which each triangle of solid 1 may overlap in addition."""
    second: Float[np.ndarray, " triangles"]
    """The same of solid 2."""
    ignored: Bool[np.ndarray, "labels labels"]
    """Pairs of labels, of solid 1 and of solid 2, whose triangles are not compared."""


def crossings(one: TriangleTree, other: TriangleTree, displaced: Displaced, slack: Slack) -> Crossings:
    """Find the pairs of triangles that cross by more than a slack, for all displacements."""
    intervals = pose_intervals(displaced, (other.low[0] + other.high[0]) / 2)
    alone1, alone2 = (np.asarray(np.all(slack.ignored, axis=axis)) for axis in (1, 0))
    stack, found = [np.array(START)], [np.zeros((0, 3), int)]
    while stack:
        items = stack.pop()
        if len(items) > _MAX_ITEMS:
            stack += np.array_split(items, len(items) // _MAX_ITEMS + 1)
            continue
        label1, label2 = one.label[items[:, 1]], other.label[items[:, 2]]
        known1, known2 = label1 >= 0, label2 >= 0
        ignored = slack.ignored[label1, label2] & known1 & known2
        items = items[~(ignored | (alone1[label1] & known1) | (alone2[label2] & known2))]
        items, in_time = _overlap(one, other, intervals, items, slack.least)
        done = intervals.is_one[items[:, 0]] & one.is_leaf[items[:, 1]] & other.is_leaf[items[:, 2]]
        pairs = items[done]
        pairs[:, 0] = intervals.middle[pairs[:, 0]]
        found.append(_crossing(one, other, displaced, pairs, slack))
        if not done.all():
            stack.append(split(one, other, intervals, items[~done], in_time[~done]))
    return Crossings(*np.concatenate(found).T)


def _crossing(
    one: TriangleTree, other: TriangleTree, displaced: Displaced, pairs: np.ndarray, slack: Slack
) -> np.ndarray:
    """Keep the pairs of leaves whose triangles cross; leaves are replaced by triangles."""
    pose, first, second = pairs[:, 0], one.triangle[pairs[:, 1]], other.triangle[pairs[:, 2]]
    if not len(pose):
        return pairs
    depth = slack.least + slack.first[first] + slack.second[second]
    found = triangle_depths(one.triangles[first], displaced.of(pose, other.triangles[second]))
    return np.stack([pose, first, second], axis=-1)[found > depth]


def _overlap(
    one: TriangleTree, other: TriangleTree, intervals: PoseIntervals, items: np.ndarray, depth: float
) -> tuple[np.ndarray, np.ndarray]:
    """Keep the items whose boxes may overlap by more than a depth along all axes; whether to go on in time."""
    boxes = NodeBoxes.of(one, other, intervals, items)
    along1 = boxes.along1()
    near = np.all(along1 - boxes.swept1 < -depth, axis=0)
    boxes, items, along1 = boxes.at(near), items[near], along1[:, near]
    along2 = boxes.along2()
    near = np.all(along2 - boxes.swept2 < -depth, axis=0)
    boxes, items = boxes.at(near), items[near]
    # what the middle displacement leaves out is only let in by the width of the interval
    off = ~np.all((along1[:, near] < -depth) & (along2[:, near] < -depth), axis=0)
    leaves = one.is_leaf[items[:, 1]] & other.is_leaf[items[:, 2]]
    return items, ~intervals.is_one[items[:, 0]] & (leaves | off | (boxes.swept() > boxes.size()))
