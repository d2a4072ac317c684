"""The graph of a mechanism: parts are its rows, joints its columns (Eq. 2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from jaxkin.topology.components import biconnected


class WalkStep(NamedTuple):
    """A joint as travelled in a circuit."""

    joint: int
    sign: int
    """+1 from part 1 to part 2, -1 against it."""


Circuit = tuple[WalkStep, ...]
"""A closed walk that meets no part twice."""


@dataclass(frozen=True)
class Graph:
    """Parts and joints as numbers; the fixed parts are one row."""

    rows: int
    ends: tuple[tuple[int, int], ...]
    """For each joint the rows of part 1 and part 2; the same row twice for a joint between two fixed parts."""

    @cached_property
    def around(self) -> tuple[tuple[tuple[WalkStep, int], ...], ...]:
        """For each row the steps that leave it, with the row that each leads to."""
        around: list[list[tuple[WalkStep, int]]] = [[] for _ in range(self.rows)]
        for joint, (row1, row2) in enumerate(self.ends):
            around[row1].append((WalkStep(joint, 1), row2))
            around[row2].append((WalkStep(joint, -1), row1))
        return tuple(map(tuple, around))

    def tail(self, step: WalkStep) -> int:
        """The row that a step leaves."""
        return self.ends[step.joint][0 if step.sign > 0 else 1]

    def head(self, step: WalkStep) -> int:
        """The row that a step leads to."""
        return self.ends[step.joint][1 if step.sign > 0 else 0]

    @cached_property
    def loop_groups(self) -> tuple[tuple[int, ...], ...]:
        """Joints of each single or multiple closed loop, in rising order: loops that share joints, over any chain.

        These are the biconnected components without the bridges. Loops that share a part but no joint are separate.
        """
        looped = [
            joints
            for joints in biconnected(self.rows, self.ends)
            if len(joints) > 1 or len(set(self.ends[joints[0]])) == 1
        ]
        return tuple(map(tuple, sorted(looped)))
