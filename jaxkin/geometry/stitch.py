"""Stitch a surface where a corner of one triangle lies in the middle of an edge of another: a T-junction.

Programs that refine, reduce or repair a mesh on one side of an edge only leave such corners. The triangles on the two
sides then share no edge, and a face falls apart, though there is no hole.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.triangles import double_areas

Triples = Int[np.ndarray, "_ 3"]
"""Triangles by the indices of their corners."""


def stitched(
    points: Float[np.ndarray, "points 3"], triangles: Triples, open_edges: Int[np.ndarray, "edges 2"], tolerance: float
) -> Triples:
    """Make triangles whose T-junctions are gone; `open_edges` are those of one triangle only, in its direction.

    A corner in the middle of a straight piece of a rim, within `tolerance` (a length), is moved along it to the next
    corner where all its triangles lie in one plane: nothing else then changes. The triangle of an edge is divided at
    the corners that are left on it.
    """
    work = _Stitching(points, triangles, open_edges, tolerance)
    todo = [*work.next]
    while todo:
        todo += work.straighten(todo.pop())  # what was beside the corner may now be in the middle of a straight piece
    for start, end in [(start, end) for start, ends in work.next.items() for end in ends]:
        if between := work.between(start, end):
            work.divide(start, end, between)
    return np.array([rows for rows in work.triangles if len({*rows}) == 3], int).reshape(-1, 3)


class _Stitching:
    """Triangles that change, by number, and which of them are at each corner of an open edge."""

    def __init__(self, points: np.ndarray, triangles: Triples, open_edges: np.ndarray, tolerance: float) -> None:
        self.points = points
        self.triangles: list[list[int]] = triangles.tolist()
        self.tolerance = tolerance
        self.next: dict[int, list[int]] = {}
        """For each corner of a rim the ends of the open edges that begin there."""
        self.before: dict[int, list[int]] = {}
        """And the starts of those that end there."""
        for start, end in open_edges.tolist():
            self.next.setdefault(start, []).append(end)
            self.before.setdefault(end, []).append(start)
        self.at: dict[int, set[int]] = {corner: set() for corner in np.unique(open_edges).tolist()}
        for number in np.flatnonzero(np.isin(triangles, [*self.at]).any(axis=1)).tolist():
            for corner in self.triangles[number]:
                if corner in self.at:
                    self.at[corner].add(number)

    def straighten(self, corner: int) -> list[int]:
        """Take a corner out of the rim where this runs straight through it and its triangles allow it; returns the
        corners beside it then."""
        if len(self.next.get(corner, ())) != 1 or len(self.before.get(corner, ())) != 1:
            return []
        (start,), (end,) = self.before[corner], self.next[corner]
        along, offset = self.points[end] - self.points[start], self.points[corner] - self.points[start]
        length = float(np.linalg.norm(along))
        ahead = float(offset @ along) / length if length > 0 else 0.0
        if not 0 < ahead < length or np.linalg.norm(offset - ahead / length * along) > self.tolerance:
            return []
        if not (self.moved(corner, start) or self.moved(corner, end)):
            return []
        del self.next[corner], self.before[corner]
        self.next[start].remove(corner)
        self.before[end].remove(corner)
        if start in self.next.get(end, ()):  # the other side of the edge: it is open no more
            self.next[end].remove(start)
            self.before[start].remove(end)
        else:
            self.next[start].append(end)
            self.before[end].append(start)
        return [start, end]

    def between(self, start: int, end: int) -> list[int]:
        """Find the corners of open edges that run from the end of an edge straight back to its start; none if they do
        not."""
        along = self.points[start] - self.points[end]
        length = float(np.linalg.norm(along))
        found, here, reached = [], end, 0.0
        while here != start and length > 0:
            for corner in self.next.get(here, ()):
                offset = self.points[corner] - self.points[end]
                ahead = float(offset @ along) / length
                off = float(np.linalg.norm(offset - ahead / length * along))
                if reached < ahead <= length * (1 + 1e-12) and off <= self.tolerance:
                    here, reached = corner, ahead
                    found.append(corner)
                    break
            else:
                return []
        return found[:-1][::-1]  # from the start to the end

    def moved(self, corner: int, to: int) -> bool:
        """Move a corner along its edge to an end of it, if its triangles lie in one plane and none turns over."""
        numbers = [number for number in self.at[corner] if len({*self.triangles[number]}) == 3]
        if not numbers:
            return False
        old = self.points[[self.triangles[number] for number in numbers]]
        new_rows = [[to if each == corner else each for each in self.triangles[number]] for number in numbers]
        areas, new_areas = double_areas(old), double_areas(self.points[new_rows])
        normal = areas[int(np.argmax(np.linalg.norm(areas, axis=-1)))]
        normal = normal / (float(np.linalg.norm(normal)) or 1.0)
        flat = np.abs((old - self.points[corner]) @ normal).max() <= self.tolerance
        whole = [len({*rows}) == 3 for rows in new_rows]
        longest = np.linalg.norm(np.ptp(old, axis=1), axis=-1)
        if not flat or (new_areas @ normal <= self.tolerance * longest)[whole].any():
            return False
        for number, rows in zip(numbers, new_rows, strict=True):
            self.triangles[number] = rows
            self.at[to].add(number)
        self.at[corner] = set()
        return True

    def divide(self, start: int, end: int, corners: list[int]) -> None:
        """Divide the triangle with the edge from `start` to `end` at corners on it, in this order."""
        if not corners:
            return
        for number in self.at[start] & self.at[end]:
            rows = self.triangles[number]
            for k in range(3):
                if (rows[k], rows[(k + 1) % 3]) == (start, end):
                    opposite = rows[(k + 2) % 3]
                    ends = [start, *corners, end]
                    pieces = [[one, other, opposite] for one, other in pairwise(ends)]
                    self.triangles[number] = pieces[-1]
                    fresh = range(len(self.triangles), len(self.triangles) + len(pieces) - 1)
                    self.triangles += pieces[:-1]
                    for each, piece in zip((*fresh, number), pieces, strict=True):
                        for corner in piece:
                            if corner in self.at:
                                self.at[corner].add(each)
                    if start in self.at and len(pieces) > 1:
                        self.at[start].discard(number)
                    return
