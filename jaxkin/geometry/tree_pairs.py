"""Find the crossing triangles of two solids, and the distance of two solids, for many displacements at once.

Pairs of nodes of the two trees are split level by level. A pair is left out as soon as its boxes tell enough; what is
left of all displacements is split in one array.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.geometry.triangle_distance import triangle_depths, triangle_distances
from jaxkin.geometry.triangle_tree import TriangleTree

_MAX_PAIRS = 1 << 18
"""Pairs of nodes that are split at once: their arrays, some 100 numbers a pair, then take 200 MB."""
_POSES = 64
"""Displacements whose distances are searched at once: bounds the memory."""
_BEAM = 16
"""Pairs of nodes that are followed at first for each displacement, those of least bounds: from 4 on they lead to the
nearest triangles of most poses, and 16 cost little beside what a loose limit costs."""
_NEARER = 1e-9
"""Share of a distance by which a pair of triangles must be nearer to be worth looking at: many pairs of two parallel
faces are equally near."""


class Displaced(NamedTuple):
    """Displacements of solid 2 relative to solid 1: x -> rotation x + shift, in the axes of the two trees."""

    rotation: Float[np.ndarray, "poses 3 3"]
    shift: Float[np.ndarray, "poses 3"]

    def of(self, pose: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Displace points (_, ..., 3), each by the displacement at its place in `pose`."""
        flat = points.reshape(len(points), int(np.prod(points.shape[1:-1])), 3)
        return (flat @ self.rotation[pose].swapaxes(1, 2) + self.shift[pose, None]).reshape(points.shape)

    def at(self, poses: np.ndarray) -> Displaced:
        """Choose some of the displacements."""
        return Displaced(self.rotation[poses], self.shift[poses])


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
    count = len(displaced.shift)
    stack = [np.stack([np.arange(count), np.zeros(count, int), np.zeros(count, int)], axis=-1)]
    found = [np.zeros((0, 3), int)]
    while stack:
        pairs = stack.pop()
        if len(pairs) > _MAX_PAIRS:
            stack += np.array_split(pairs, len(pairs) // _MAX_PAIRS + 1)
            continue
        pairs = _overlap(one, other, displaced, pairs, slack.least)
        label1, label2 = one.label[pairs[:, 1]], other.label[pairs[:, 2]]
        pairs = pairs[~(slack.ignored[label1, label2] & (label1 >= 0) & (label2 >= 0))]
        done = one.is_leaf[pairs[:, 1]] & other.is_leaf[pairs[:, 2]]
        found.append(_crossing(one, other, displaced, pairs[done], slack))
        if not done.all():
            stack.append(_split(one, other, pairs[~done]))
    return Crossings(*np.concatenate(found).T)


def distances(
    one: TriangleTree, other: TriangleTree, displaced: Displaced, within: float
) -> Float[np.ndarray, " poses"]:
    """Measure the distance of the surfaces of two solids, 0 where they cross; infinite where it exceeds `within`.

    Few pairs of nodes, those whose boxes are nearest, lead to triangles that are nearly the nearest ones; then all are
    searched that may be nearer.
    """
    count = len(displaced.shift)
    limit, found = np.full(count, np.nextafter(within, np.inf)), np.full(count, np.inf)
    for some in np.array_split(np.arange(count), count // _POSES + 1):
        for beam in (_BEAM, None):
            pairs = np.stack([some, np.zeros_like(some), np.zeros_like(some)], axis=-1)
            bound = _box_distance(one, other, displaced, pairs)
            while True:
                near = bound < limit[pairs[:, 0]] * (1 - _NEARER)
                pairs, bound, rank = _ranked(pairs[near], bound[near])
                if beam is not None:
                    pairs, bound, rank = pairs[rank < beam], bound[rank < beam], rank[rank < beam]
                if np.all(one.is_leaf[pairs[:, 1]] & other.is_leaf[pairs[:, 2]]):
                    break
                pairs = _split(one, other, pairs)
                bound = _box_distance(one, other, displaced, pairs)
            _measure(one, other, displaced, pairs, bound, rank, limit, found)
    return found


def _ranked(pairs: np.ndarray, bound: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sort pairs by displacement and bound; returns also the place of each pair among those of its displacement."""
    order = np.lexsort((bound, pairs[:, 0]))
    pairs, bound = pairs[order], bound[order]
    first = np.flatnonzero(np.diff(pairs[:, 0], prepend=-1))
    return pairs, bound, np.arange(len(pairs)) - np.repeat(first, np.diff(np.append(first, len(pairs))))


def _measure(
    one: TriangleTree,
    other: TriangleTree,
    displaced: Displaced,
    pairs: np.ndarray,
    bound: np.ndarray,
    rank: np.ndarray,
    limit: np.ndarray,
    found: np.ndarray,
) -> None:
    """Measure pairs of leaves, the nearest of each displacement first, and lower `limit` and `found` to what they are.

    The arrays are those of `_ranked`. Pairs whose bound is not below the limit any more are left out.
    """
    begin, size = 0, 1
    while begin <= rank.max(initial=-1):
        now = (rank >= begin) & (rank < begin + size) & (bound < limit[pairs[:, 0]] * (1 - _NEARER))
        pose, first, second = pairs[now, 0], one.triangle[pairs[now, 1]], other.triangle[pairs[now, 2]]
        apart = triangle_distances(one.triangles[first], displaced.of(pose, other.triangles[second]))
        nearer = apart < limit[pose]
        np.minimum.at(found, pose[nearer], apart[nearer])
        np.minimum.at(limit, pose[nearer], apart[nearer])
        begin, size = begin + size, 4 * size


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


def _split(one: TriangleTree, other: TriangleTree, pairs: np.ndarray) -> np.ndarray:
    """Replace each pair of nodes by the pairs of their children; leaves stay as they are."""
    found = []
    first, second = one.children[pairs[:, 1]], other.children[pairs[:, 2]]
    for i in (0, 1):
        for j in (0, 1):
            new = np.stack([pairs[:, 0], first[:, i], second[:, j]], axis=-1)
            keep = np.ones(len(pairs), bool)
            if i:
                keep &= ~one.is_leaf[pairs[:, 1]]
            if j:
                keep &= ~other.is_leaf[pairs[:, 2]]
            found.append(new[keep])
    return np.concatenate(found)


class _Boxes(NamedTuple):
    """Boxes of pairs of nodes, with the pairs as last axis: contiguous rows are several times faster to work with."""

    turn: Float[np.ndarray, "3 3 pairs"]
    """Rotation of box 2."""
    between: Float[np.ndarray, "3 pairs"]
    """From the middle of box 1 to that of box 2, along the axes of tree 1."""
    half1: Float[np.ndarray, "3 pairs"]
    """Half the size of box 1, along the axes of tree 1."""
    half2: Float[np.ndarray, "3 pairs"]
    """Half the size of box 2, along the axes of tree 2."""

    @staticmethod
    def of(one: TriangleTree, other: TriangleTree, displaced: Displaced, pairs: np.ndarray) -> _Boxes:
        """Gather the boxes of pairs of nodes."""
        pose, node1, node2 = np.ascontiguousarray(pairs.T)
        turn = displaced.rotation.transpose(1, 2, 0)[:, :, pose]
        middle1, half1 = ((one.high + sign * one.low).T[:, node1] / 2 for sign in (1, -1))
        middle2, half2 = ((other.high + sign * other.low).T[:, node2] / 2 for sign in (1, -1))
        between = _times(turn, middle2) + displaced.shift.T[:, pose] - middle1
        return _Boxes(turn, between, half1, half2)

    def along1(self) -> Float[np.ndarray, "3 pairs"]:
        """Measure by how much the boxes are apart along the axes of tree 1.

        Negative where they overlap: by the length that the one would have to move to be outside of the other.
        """
        return np.abs(self.between) - self.half1 - _times(np.abs(self.turn), self.half2)

    def along2(self) -> Float[np.ndarray, "3 pairs"]:
        """Compute the same lengths along the axes of tree 2."""
        back = self.turn.swapaxes(0, 1)
        return np.abs(_times(back, self.between)) - self.half2 - _times(np.abs(back), self.half1)


def _times(turn: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Multiply matrices (3, 3, _) with vectors (3, _)."""
    return np.stack([row[0] * vectors[0] + row[1] * vectors[1] + row[2] * vectors[2] for row in turn])


def _overlap(
    one: TriangleTree, other: TriangleTree, displaced: Displaced, pairs: np.ndarray, depth: float
) -> np.ndarray:
    """Keep the pairs of nodes whose boxes overlap by more than a depth along all axes."""
    boxes = _Boxes.of(one, other, displaced, pairs)
    near = np.all(boxes.along1() < -depth, axis=0)
    boxes, pairs = _Boxes(*(each[..., near] for each in boxes)), pairs[near]
    return pairs[np.all(boxes.along2() < -depth, axis=0)]


def _box_distance(one: TriangleTree, other: TriangleTree, displaced: Displaced, pairs: np.ndarray) -> np.ndarray:
    """Bound the distance of the triangles of pairs of nodes from below."""
    boxes = _Boxes.of(one, other, displaced, pairs)
    return np.maximum(*(np.linalg.norm(np.maximum(along, 0.0), axis=0) for along in (boxes.along1(), boxes.along2())))
