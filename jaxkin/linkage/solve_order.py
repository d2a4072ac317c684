"""The order in which the loops of a structure element can be solved, for given driven coordinates.

In place of a block-triangular form of loops x unknowns, which depends on the choice of loops, parts are merged: those
whose place to each other is given (by a drive) or solved count as one part from then on. A group is a set of loops of
what remains that can be solved alone: the motions that it allows by itself are all left to it by the loops around it.
In planar linkages with one drive these are the Assur groups; idle freedoms, redundant loops and loops in which only
some joints are known are covered as well, since ranks are counted and not joints.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from jaxkin.joints.screws import Screws
from jaxkin.linkage.contracted_graph import Ends, Merged
from jaxkin.linkage.first_order import Columns, Noise, independent, loop_jacobian, null_space, without

_EFFORT = 2000
"""Sets of loops that are tried at most before the rest of the loops is taken as one group."""


@dataclass(frozen=True)
class Group:
    """Loops that are solved together."""

    joints: tuple[int, ...]
    """The joints whose unknown coordinates are solved here."""
    unknowns: tuple[int, ...]
    """Their columns."""
    passed: tuple[int, ...]
    """Joints that are known by now and that the loops pass through."""
    loops: int
    rank: int
    """Independent equations."""
    after: tuple[int, ...]
    """Numbers of the groups that must be solved before."""

    @property
    def free(self) -> int:
        """Unknowns that the loops do not settle: the solver leaves them as near to rest as it can."""
        return len(self.unknowns) - self.rank


def solve_order(
    ends: Ends, columns: Columns, screws: Screws, driven: Collection[int], noise: Noise
) -> tuple[Group, ...]:
    """The groups of one structure element, each as small as was found, every one after those that it needs.

    `ends` are the parts of its joints by number, `screws` those of its coordinates at a closed pose in world
    coordinates, `driven` the columns that are given. Single loops that can be solved alone are always found; of larger
    sets the first few thousand are tried.
    """
    unknown = {joint: tuple(c for c, (owner, _) in enumerate(columns) if owner == joint) for joint in ends}
    unknown = {joint: tuple(c for c in found if c not in driven) for joint, found in unknown.items()}
    order = _Order(ends, columns, screws, unknown, noise)
    while order.remaining:
        order.solve(order.next())
    return tuple(order.groups)


class _Order:
    """What is known so far."""

    def __init__(
        self, ends: Ends, columns: Columns, screws: Screws, unknown: Mapping[int, tuple[int, ...]], noise: Noise
    ) -> None:
        self.columns, self.screws, self.unknown, self.noise = columns, screws, unknown, noise
        self.groups: list[Group] = []
        self.graph = Merged(ends)
        self.remaining = [joint for joint, found in unknown.items() if found]
        for joint, found in unknown.items():
            if not found:
                self.graph.merge(joint, None)
        self.open = [column for joint in self.remaining for column in unknown[joint]]
        """Columns that are not known."""
        jacobian = loop_jacobian(self.graph.circuits(self.remaining), columns, screws)
        self.motions = np.zeros((0, len(columns)))
        """Rates that the loops leave to the open columns."""
        if self.open:
            _, motions = null_space(jacobian[:, self.open], noise)
            self.motions = np.zeros((len(motions), len(columns)))
            self.motions[:, self.open] = motions
        self.effort = 0

    def next(self) -> list[int]:
        """The lightest set of joints found that can be solved alone; else all that hang together with the first.

        If that cannot either (circuits that share parts, but no joints, may need each other) all that is left.
        """
        weights = {joint: len(self.unknown[joint]) for joint in self.remaining}
        circuits = sorted(self.graph.lightest(weights), key=self._weight)
        for joints in self._unions(circuits):
            if self._solvable(sorted(joints)):
                return sorted(joints)
        together = circuits[0]
        while more := [circuit for circuit in circuits if circuit & together and not circuit <= together]:
            together = together.union(*more)
        return sorted(together if self._solvable(sorted(together)) else frozenset().union(*circuits))

    def _unions(self, circuits: list[frozenset[int]]) -> Iterator[frozenset[int]]:
        """The circuits, then unions of two that share joints, of three, and so on, the lightest of a kind first."""
        tried, level = set(circuits), circuits
        yield from circuits
        while level and self.effort <= _EFFORT:
            larger: list[frozenset[int]] = []
            for one in level:
                for circuit in circuits:
                    union = one | circuit
                    if one & circuit and union not in tried and self.effort <= _EFFORT:
                        self.effort += 1
                        tried.add(union)
                        larger.append(union)
            level = sorted(larger, key=self._weight)
            yield from level

    def _solvable(self, joints: Sequence[int]) -> bool:
        """Whether every motion that these loops allow alone is left to them by all others."""
        unknowns = [column for joint in joints for column in self.unknown[joint]]
        alone = len(unknowns) - self._rank(joints, unknowns)
        return alone == independent(self.motions, unknowns, self.noise)

    def _rank(self, joints: Sequence[int], unknowns: Sequence[int]) -> int:
        jacobian = loop_jacobian(self.graph.circuits(joints), self.columns, self.screws)
        return null_space(jacobian[:, list(unknowns)], self.noise)[0]

    def solve(self, joints: Sequence[int]) -> None:
        """Add the group of these joints, and merge its parts."""
        unknowns = tuple(column for joint in joints for column in self.unknown[joint])
        passed = self.graph.passed(joints)
        after = {number for number in passed.values() if number is not None}
        implied = {earlier for number in after for earlier in self._before(number)}
        number = len(self.groups)
        needed = tuple(sorted(after - implied))
        loops, rank = len(self.graph.circuits(joints)), self._rank(joints, unknowns)
        self.groups.append(Group(tuple(joints), unknowns, tuple(sorted(passed)), loops, rank, needed))
        for joint in joints:
            self.graph.merge(joint, number)
        self.remaining = [joint for joint in self.remaining if joint not in set(joints)]
        self.motions = without(self.motions, unknowns, self.noise)

    def _before(self, group: int) -> set[int]:
        """All groups that a group needs, directly or not."""
        return {number for other in self.groups[group].after for number in (other, *self._before(other))}

    def _weight(self, joints: Collection[int]) -> tuple[int, list[int]]:
        return sum(len(self.unknown[joint]) for joint in joints), sorted(joints)
