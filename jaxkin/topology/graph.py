"""The graph of a mechanism: parts are the rows, joints the columns of the incidence matrix (Eq. 2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from jaxkin.topology.components import biconnected


class WalkStep(NamedTuple):
    """One step of a walk through the graph: a joint, and the direction in which it is travelled."""

    joint: int
    sign: int
    """+1 from part 1 to part 2, -1 against it."""


Circuit = tuple[WalkStep, ...]
"""A closed walk through the graph that meets no part twice."""


@dataclass(frozen=True)
class Graph:
    """Parts (rows) and joints by their indices; all fixed parts are one row."""

    rows: int
    """Number of rows."""
    ends: tuple[tuple[int, int], ...]
    """For each joint the rows of part 1 and part 2; the same row twice for a joint between two fixed parts."""

    @cached_property
    def around(self) -> tuple[tuple[tuple[WalkStep, int], ...], ...]:
        """For each row the steps that leave it, each with the row that it leads to."""
        around: list[list[tuple[WalkStep, int]]] = [[] for _ in range(self.rows)]
        for joint, (row1, row2) in enumerate(self.ends):
            around[row1].append((WalkStep(joint, 1), row2))
            around[row2].append((WalkStep(joint, -1), row1))
        return tuple(map(tuple, around))

    def tail(self, step: WalkStep) -> int:
        """Return the row that a step leaves."""
        return self.ends[step.joint][0 if step.sign > 0 else 1]

    def head(self, step: WalkStep) -> int:
        """Return the row that a step leads to."""
        return self.ends[step.joint][1 if step.sign > 0 else 0]

    @cached_property
    def loop_groups(self) -> tuple[tuple[int, ...], ...]:
        """The joints, rising, of each set of loops that share joints, directly or through other loops of the set.

        These are the biconnected components without the bridges. Loops that share a part but no joint are in different
        groups.
        """
        looped = [
            joints
            for joints in biconnected(self.rows, self.ends)
            if len(joints) > 1 or len(set(self.ends[joints[0]])) == 1
        ]
        return tuple(map(tuple, sorted(looped)))
