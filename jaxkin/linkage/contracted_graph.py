"""The graph of a mechanism in which parts whose place to each other is known count as one."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from heapq import heappop, heappush

Ends = Mapping[int, tuple[str, str]]
"""For each joint its two parts."""


class Merged:
    """Parts and joints, some of them known."""

    def __init__(self, ends: Ends) -> None:
        self.ends = ends
        self.stands = {part: part for pair in ends.values() for part in pair}
        """For each part the one that stands for all that are known relative to it."""
        self.known: dict[str, list[tuple[int, str, int | None]]] = {part: [] for part in self.stands}
        """The joints that are known: (joint, other part, number of the group that gave it; None for a drive)."""

    def merge(self, joint: int, group: int | None) -> None:
        """A joint is known: its parts count as one."""
        part1, part2 = self.ends[joint]
        self.known[part1].append((joint, part2, group))
        self.known[part2].append((joint, part1, group))
        kept, gone = self.stands[part1], self.stands[part2]
        if kept != gone:
            self.stands = {part: kept if stands == gone else stands for part, stands in self.stands.items()}

    def passed(self, joints: Sequence[int]) -> dict[int, int | None]:
        """The known joints that loops through these joints pass, with the groups that gave them."""
        met: dict[str, str] = {}
        found: dict[int, int | None] = {}
        for joint in joints:
            for part in self.ends[joint]:
                found |= self._path(met.setdefault(self.stands[part], part), part)
        return found

    def _path(self, start: str, end: str) -> dict[int, int | None]:
        """The fewest known joints between two merged parts, with the groups that gave them."""
        came: dict[str, tuple[int, str, int | None] | None] = {start: None}
        queue = deque([start])
        while end not in came:
            part = queue.popleft()
            for joint, other, group in self.known[part]:
                if other not in came:
                    came[other] = joint, part, group
                    queue.append(other)
        path: dict[int, int | None] = {}
        while (step := came[end]) is not None:
            path[step[0]], end = step[2], step[1]
        return path

    def _around(self, joints: Sequence[int]) -> dict[str, list[tuple[int, int, str]]]:
        """For each merged part its (joint, sign, other part)."""
        around: dict[str, list[tuple[int, int, str]]] = {}
        for joint in joints:
            part1, part2 = (self.stands[part] for part in self.ends[joint])
            around.setdefault(part1, []).append((joint, 1, part2))
            around.setdefault(part2, []).append((joint, -1, part1))
        return around

    def lightest(self, weights: Mapping[int, int]) -> set[frozenset[int]]:
        """The lightest circuit through each of some joints with weights; it alone where its parts are merged."""
        around = self._around(list(weights))
        return {self._lightest(around, weights, joint) for joint in weights}

    def _lightest(
        self, around: Mapping[str, Sequence[tuple[int, int, str]]], weights: Mapping[int, int], joint: int
    ) -> frozenset[int]:
        start, end = (self.stands[part] for part in self.ends[joint])
        queue: list[tuple[int, str, tuple[int, ...]]] = [(0, start, ())]
        done: set[str] = set()
        while queue:
            weight, part, path = heappop(queue)
            if part == end:
                return frozenset((joint, *path))
            if part in done:
                continue
            done.add(part)
            for other, _, to in around[part]:
                if other != joint and to not in done:
                    heappush(queue, (weight + weights[other], to, (*path, other)))
        raise AssertionError("every joint of an element with loops lies in a circuit")

    def circuits(self, joints: Sequence[int]) -> list[list[tuple[int, int]]]:
        """Independent circuits of the merged parts through these joints: one for each that closes a tree of the others.

        Known joints on the way are left out: their rates are given.
        """
        around = self._around(joints)
        came: dict[str, tuple[int, int, str] | None] = {}
        closing = set(joints)
        for root in around:
            stack = [] if root in came else [root]
            came.setdefault(root, None)
            while stack:
                part = stack.pop()
                for joint, sign, other in around[part]:
                    if other not in came:
                        came[other] = joint, sign, part
                        closing.discard(joint)
                        stack.append(other)

        def to_root(part: str) -> dict[int, int]:
            signs = {}
            while (step := came[part]) is not None:
                signs[step[0]], part = step[1], step[2]
            return signs

        circuits = []
        for joint in sorted(closing):
            there, back = (to_root(self.stands[part]) for part in self.ends[joint])
            signs = {j: there.get(j, 0) - back.get(j, 0) for j in {**there, **back}}
            circuits.append([(joint, 1), *((j, sign) for j, sign in signs.items() if sign)])
        return circuits
