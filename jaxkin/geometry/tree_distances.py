"""Measure the distances of pairs of solids for many displacements at once."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.node_boxes import NodeBoxes, lengths, split
from jaxkin.geometry.solid_pairs import SolidPairs
from jaxkin.geometry.triangle_distance import directions, triangle_distances

_STRIDE = 8
"""Of so many successive displacements one is searched alone; its nearest triangles are nearly so at the others."""
_BEAM = 16
"""Items that are followed at first for each of these displacements, those of least bounds: from 4 on they lead to the
nearest triangles of most poses, and 16 cost little beside what a loose limit costs."""
_SWEPT = 0.01
"""Share of the limit of a distance that boxes may sweep within an interval: wider intervals are halved first. What
boxes sweep is taken off the bound of every pair of boxes below. For 361 poses of `benchmarks/clashes.py` a tenth took
45 s of a processor, 0.03 took 18 and 0.01 took 13; for a four-bar 0.03 and less took a quarter of what a tenth did."""
_AT_ONCE = 1 << 13
"""Items whose boxes are gathered at once: their arrays stay in the cache of a core."""
_MAX_ITEMS = 1 << 16
"""Items that are split at once, where all are followed: solids with faces in a small distance all over, as a rod in a
tube, have tens of millions."""
_NEARER = 1e-9
"""Share of a distance by which a pair of triangles must be nearer to be worth looking at: many pairs of two parallel
faces are equally near."""


def distances(pairs: SolidPairs, within: float) -> Float[np.ndarray, " places"]:
    """Measure the distance of the surfaces of two solids, 0 where they cross; infinite where it exceeds `within`.

    Where the nearest points of the convex hulls are points of the solids, the distance is that of the hulls. Else, at
    some of the displacements, few items, those whose boxes are nearest, lead to triangles that are nearly the nearest
    ones. They bound the distance there and at the displacements between; then all are searched that may be nearer,
    along the direction in which those triangles are from each other, too.
    """
    search = _Search(pairs, within)
    places = np.arange(len(pairs.pair))
    begin = pairs.begin[pairs.pair]
    before = places - (places - begin) % _STRIDE
    search.compare_hulls()
    sampled = np.unique(before)
    search.follow(pairs.alone(sampled[search.limit[sampled] > 0]), _BEAM)
    nearest = search.nearest.copy()
    last = np.append(pairs.begin[1:], len(places))[pairs.pair] - 1
    for of in (before, np.where(before + _STRIDE > last, before, before + _STRIDE)):
        (known,) = np.nonzero((nearest[of, 0] >= 0) & (search.limit > 0))
        search.measure(known, *nearest[of[known]].T)
    search.aim()
    search.follow(pairs.alone(np.flatnonzero(search.limit)), _BEAM)
    search.aim()
    search.follow(pairs.start(), None)
    return search.found


class _Search:
    """The least distance of each displacement that has been found so far."""

    def __init__(self, pairs: SolidPairs, within: float):
        self.pairs = pairs
        count = len(pairs.pair)
        self.found = np.full(count, np.inf)
        """Infinite where it is more than the limit that was asked for."""
        self.limit = np.full(count, np.nextafter(within, np.inf))
        """What a distance must be below; 0 where the distance is known."""
        self.nearest = np.full((count, 2), -1)
        """The triangles that are nearest; -1 where none is near."""
        self.direction = np.zeros((3, count))
        """A direction from solid 1 to solid 2, in the axes of solid 1, along which they are apart; 0 where none is
        known."""

    def compare_hulls(self) -> None:
        """Leave out what is farther apart than its convex hulls are, and measure the triangles at the nearest points of
        the hulls: where these are points of both solids, nothing is nearer.
        """
        points = self.pairs.nearest_of_hulls()
        gap = self.pairs.displaced.of(np.arange(len(points)), points[:, 1]) - points[:, 0]
        length = np.linalg.norm(gap, axis=1)
        self.direction = (gap / np.where(length > 0, length, 1.0)[:, None]).T
        ahead = self.pairs.ahead(self.direction)
        self.limit[ahead >= self.limit] = 0.0
        (near,) = np.nonzero((self.limit > 0) & (length > 0))
        if len(near):
            self.measure(near, *self.pairs.at(near).nearest_triangles(points[near]).T)
        self.limit[ahead >= self.limit * (1 - _NEARER)] = 0.0

    def aim(self) -> None:
        """Take the directions between the nearest triangles so far.

        Where solids are far from each other for the size of their features, such as two rounded edges across a hole,
        nothing tells as well as this direction which of their triangles are not nearer. Where all of the one solid is
        behind those of its triangles that are found, and all of the other ahead, the search is at its end.
        """
        (known,) = np.nonzero((self.nearest[:, 0] >= 0) & (self.limit > 0))
        triangles, (first, second) = self.pairs.tree.triangles, self.nearest[known].T
        found = directions(triangles[first], self.pairs.displaced.of(known, triangles[second]))
        self.direction[:, known] = found.T
        self.limit[self.pairs.ahead(self.direction) >= self.limit * (1 - _NEARER)] = 0.0

    def follow(self, items: np.ndarray, beam: int | None) -> None:
        """Split items until they are single triangles that may be nearer, and measure these.

        Of too many items those of least bounds are followed to their triangles before the others: what these measure
        leaves fewer of the others.
        """
        tree, intervals = self.pairs.tree, self.pairs.intervals
        stack = [items]
        while stack:
            items = stack.pop()
            limit = intervals.largest(self.limit) * (1 - _NEARER)
            pieces = np.array_split(items, len(items) // _AT_ONCE + 1)
            bound, in_time = np.concatenate([self._bounds(piece, limit) for piece in pieces], axis=1)
            near = bound < limit[items[:, 0]]
            if beam is not None:
                near[near] = _rank(items[near, 0], bound[near]) < beam
            items, bound, in_time = items[near], bound[near], in_time[near] > 0
            leaves, single = np.all(tree.is_leaf[items[:, 1:]], axis=1), intervals.is_one[items[:, 0]]
            done = leaves & single
            self._measure_leaves(items[done], bound[done])
            items, bound, in_time = items[~done], bound[~done], (~single & (leaves | in_time))[~done]
            count = 1 if beam is not None else len(items) // _MAX_ITEMS + 1
            if count > 1:
                order = np.argsort(-bound, kind="stable")
                items, in_time = items[order], in_time[order]
            for some, halved in zip(np.array_split(items, count), np.array_split(in_time, count), strict=True):
                if len(some):
                    stack.append(split(self.pairs, some, halved))

    def _measure_leaves(self, leaves: np.ndarray, bound: np.ndarray) -> None:
        """Measure single triangles at single displacements, items with their bounds, that may be nearer."""
        place = self.pairs.intervals.middle[leaves[:, 0]]
        first, second = self.pairs.tree.triangle[leaves[:, 1:]].T
        bound = np.maximum(bound, self._ahead(place, first, second))
        near = bound < self.limit[place] * (1 - _NEARER)
        place, first, second, bound = place[near], first[near], second[near], bound[near]
        rank = _rank(place, bound)
        begin, size = 0, 1
        # the most promising of each displacement first: they lower the limit for the others
        while begin <= rank.max(initial=-1):
            now = (rank >= begin) & (rank < begin + size) & (bound < self.limit[place] * (1 - _NEARER))
            self.measure(place[now], first[now], second[now])
            begin, size = begin + size, 4 * size

    def _ahead(self, place: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        """Measure how far triangles of solid 2 are ahead of triangles of solid 1 along the direction of each place."""
        triangles, direction = self.pairs.tree.triangles, self.direction.T[place, :, None]
        other = self.pairs.displaced.of(place, triangles[second])
        return (other @ direction).min(axis=(1, 2)) - (triangles[first] @ direction).max(axis=(1, 2))

    def _bounds(self, items: np.ndarray, limit: np.ndarray) -> Float[np.ndarray, "2 items"]:
        """Bound the distances of items from below; and tell, by 1, which to halve in time rather than in space."""
        boxes = NodeBoxes.of(self.pairs, items)
        bounds = boxes.distances()
        most = limit[items[:, 0]]
        (near,) = np.nonzero(bounds[0] < most)
        some, few = items[near], boxes.at(near)
        ahead, room = few.along(self.direction[:, self.pairs.intervals.middle[some[:, 0]]], self.pairs, some)
        bounds[:, near] = np.maximum(bounds[:, near], [ahead - room, ahead])
        still = bounds[0, near] < most[near]
        near, some, few = near[still], some[still], few.at(still)
        bounds[:, near] = np.maximum(bounds[:, near], lengths(few.along_own(self.pairs, some)))
        # what the middle displacement leaves out is only let in by the width of the interval
        return np.stack([bounds[0], (bounds[1] >= most) | (boxes.swept() > _SWEPT * most)])

    def measure(self, place: np.ndarray, first: np.ndarray, second: np.ndarray) -> None:
        """Measure pairs of triangles, and keep the nearest of each displacement."""
        triangles = self.pairs.tree.triangles
        apart = triangle_distances(triangles[first], self.pairs.displaced.of(place, triangles[second]))
        order = np.lexsort((apart, place))
        order = order[np.diff(place[order], prepend=-1) > 0]
        order = order[apart[order] < self.limit[place[order]]]
        place = place[order]
        self.found[place] = self.limit[place] = apart[order]
        self.nearest[place] = np.stack([first[order], second[order]], axis=-1)


def _rank(groups: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Find the place of each item among those of its group, by its bound."""
    order = np.lexsort((bound, groups))
    first = np.flatnonzero(np.diff(groups[order], prepend=-1))
    found = np.empty(len(groups), int)
    found[order] = np.arange(len(groups)) - np.repeat(first, np.diff(np.append(first, len(groups))))
    return found
