"""The order in which the loops of a structure element are solved, for given driven coordinates.

Parts whose place to each other is given by the drive, or solved, are contracted to one (`contracted_graph`), so that
the order does not depend on a choice of loops. A group is a set of loops of the contracted graph that can be solved
alone: the motions that it allows by itself are all left to it by the loops around it. In planar linkages with one drive
the groups are the Assur groups. Ranks are counted, not joints, so that idle freedoms, redundant loops and loops in
which only some joints are known are covered as well. The closure Jacobian, groups in order, is block lower triangular.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from jaxkin.joints.screws import Screws
from jaxkin.linkage.contracted_graph import ContractedGraph, CycleSpace, Ends
from jaxkin.linkage.first_order import EQUATIONS, Columns, Thresholds, independent, loop_jacobian, null_space, without
from jaxkin.topology.graph import Circuit

_MAX_SETS = 2000
"""Sets of loops that are tried at most before the rest of the loops is taken as one group. Elements of up to some ten
loops need fewer than a hundred; the limit keeps a mesh of fifty loops below a second."""


@dataclass(frozen=True)
class Group:
    """Loops that are solved together."""

    joints: tuple[int, ...]
    """The joints whose unknown coordinates are solved here."""
    unknowns: tuple[int, ...]
    """Their columns."""
    known_joints: tuple[int, ...]
    """Joints on the loops whose coordinates are all known before."""
    loops: tuple[Circuit, ...]
    """Closed circuits of joints, in order of travel: loops of the structure where these will do."""
    rank: int
    """Number of independent equations among those of the loops."""
    after: tuple[int, ...]
    """Numbers of the groups that must be solved before; of these only the ones that none of the others needs."""
    merged: int = 1
    """Number of groups that this one was made of, where they share freedoms: see `keep_freedoms_together`."""

    @property
    def free(self) -> int:
        """Number of unknown coordinates that the loops do not determine: least-norm steps move them least."""
        return len(self.unknowns) - self.rank


def solve_order(
    ends: Ends,
    loops: Sequence[Circuit],
    columns: Columns,
    screws: Screws,
    driven: Collection[int],
    thresholds: Thresholds,
) -> tuple[Group, ...]:
    """Find the groups of one structure element, each as small as was found, every group after those that it needs.

    `ends` are the parts of the joints by number, `loops` those of the structure, `screws` (6, columns) those of the
    coordinates at a closed pose in world coordinates, `driven` the columns that are given. Single loops that can be
    solved alone are always found; of larger sets at most `_MAX_SETS` are tried. The Jacobian is block lower triangular,
    but for least-norm solutions of coordinates that are not determined: see `keep_freedoms_together`.
    """
    unknown = {joint: tuple(c for c, (owner, _) in enumerate(columns) if owner == joint) for joint in ends}
    unknown = {joint: tuple(c for c in found if c not in driven) for joint, found in unknown.items()}
    order = _Order(ends, loops, columns, screws, unknown, thresholds)
    while order.remaining:
        order.solve(order.next())
    return (*order.groups, *order.rest())


def keep_freedoms_together(
    groups: Sequence[Group], columns: Columns, screws: Screws, thresholds: Thresholds
) -> tuple[Group, ...]:
    """Merge a group that leaves coordinates undetermined with the later groups that these coordinates move.

    Undetermined coordinates take the values of least norm. Solved group by group, these are the values of least norm
    over the whole element only if no later group moves with the coordinates that an earlier group leaves undetermined
    (to first order, at the pose of `screws`). Groups that need the earlier group and that the later group needs are
    merged as well.
    """
    found = list(groups)
    number = 0
    while number < len(found):
        feeling = _feels(found, number, columns, screws, thresholds)
        if feeling is None:
            number += 1
            continue
        chosen = {number, feeling}
        chosen |= {k for k in range(number, feeling) if number in _needed(found, k) and k in _needed(found, feeling)}
        found, number = _merged(found, sorted(chosen), columns, screws, thresholds), 0
    return tuple(found)


def _feels(
    groups: Sequence[Group], number: int, columns: Columns, screws: Screws, thresholds: Thresholds
) -> int | None:
    """Find the first later group whose loops open while a group moves as its loops allow; None if all stay closed."""
    group = groups[number]
    if not group.free or number + 1 == len(groups):
        return None
    own = list(group.unknowns)
    free = null_space(loop_jacobian(group.loops, columns, screws)[:, own], thresholds.rank)[1]
    for later in range(number + 1, len(groups)):
        misfit = loop_jacobian(groups[later].loops, columns, screws)[:, own] @ free.T
        if np.abs(misfit).max(initial=0.0) > thresholds.rate:
            return later
    return None


def _needed(groups: Sequence[Group], number: int) -> set[int]:
    """Numbers of all groups that must be solved before one, directly or not."""
    return {k for other in groups[number].after for k in (other, *_needed(groups, other))}


def _merged(
    groups: Sequence[Group], chosen: Sequence[int], columns: Columns, screws: Screws, thresholds: Thresholds
) -> list[Group]:
    """Merge the chosen groups into one; in the order that is returned every group still follows those that it needs."""
    first = [k for k in range(len(groups)) if k not in chosen]
    parts = [groups[k] for k in chosen]
    joints = tuple(sorted(joint for part in parts for joint in part.joints))
    unknowns = tuple(sorted(column for part in parts for column in part.unknowns))
    loops = tuple(loop for part in parts for loop in part.loops)
    known = {joint for part in parts for joint in part.known_joints} - set(joints)
    rank = null_space(loop_jacobian(loops, columns, screws)[:, list(unknowns)], thresholds.rank)[0]
    after = {other for part in parts for other in part.after} - set(chosen)
    one = Group(joints, unknowns, tuple(sorted(known)), loops, rank, tuple(after), sum(p.merged for p in parts))
    # what the merged group needs comes first, then the merged group, then all that needs it or comes later
    needed = {k for other in after for k in (other, *_needed(groups, other))}
    before = [k for k in first if k in needed or k < chosen[0]]
    behind = [k for k in first if k not in before]
    place = {k: i for i, k in enumerate(before)} | dict.fromkeys(chosen, len(before))
    place |= {k: len(before) + 1 + i for i, k in enumerate(behind)}
    ordered = [*(groups[k] for k in before), one, *(groups[k] for k in behind)]
    renumbered = [replace(group, after=tuple(sorted({place[k] for k in group.after}))) for group in ordered]
    return [replace(group, after=_direct(renumbered, group.after)) for group in renumbered]


def _direct(groups: Sequence[Group], after: Sequence[int]) -> tuple[int, ...]:
    """Of the groups that one needs those that none of the others needs."""
    implied = {k for other in after for k in _needed(groups, other)}
    return tuple(sorted(set(after) - implied))


def order_by_counting(
    loops: Sequence[Circuit], unknown: Mapping[int, Sequence[int]], equations: Sequence[int | None]
) -> tuple[Group, ...]:
    """Find the groups of one structure element by counting, for joint frames whose numbers are not there.

    `unknown` are the unknown columns of each joint. A loop follows from the loops before it where it brings as many
    unknown coordinates as it has `equations`; None where counting says nothing, as in space, where equations that seem
    to fit are often redundant. All loops that follow from no others are one group, the last one. Ranks are those of
    equations that are independent as far as they can be.
    """
    left, known, found = list(range(len(loops))), dict[int, int](), list[Group]()
    while left:
        new = {k: {joint for joint, _ in loops[k] if unknown[joint] and joint not in known} for k in left}
        count = {k: sum(len(unknown[joint]) for joint in joints) for k, joints in new.items()}
        chosen = next(([k] for k in left if count[k] == equations[k]), left)
        joints = tuple(sorted(set[int]().union(*(new[k] for k in chosen))))
        passed = {joint for k in chosen for joint, _ in loops[k]}.difference(joints)
        columns = tuple(column for joint in joints for column in unknown[joint])
        rank = min(len(columns), sum(equations[k] or EQUATIONS for k in chosen))
        after = _direct(found, sorted({known[joint] for joint in passed if joint in known}))
        found.append(Group(joints, columns, tuple(sorted(passed)), tuple(loops[k] for k in chosen), rank, after))
        known |= dict.fromkeys(joints, len(found) - 1)
        left = [k for k in left if k not in chosen]
    return tuple(found)


class _Order:
    """What is known so far."""

    def __init__(
        self,
        ends: Ends,
        loops: Sequence[Circuit],
        columns: Columns,
        screws: Screws,
        unknown: Mapping[int, tuple[int, ...]],
        thresholds: Thresholds,
    ) -> None:
        self.columns, self.screws, self.unknown, self.thresholds = columns, screws, unknown, thresholds
        self.groups: list[Group] = []
        self.graph = ContractedGraph(ends)
        self.remaining = [joint for joint, found in unknown.items() if found]
        for joint, found in unknown.items():
            if not found:
                self.graph.contract(joint, None)
        self.open = [column for joint in self.remaining for column in unknown[joint]]
        """Columns that are not known."""
        self.motions = self._open_motions()
        """Rates that the loops leave to the open columns."""
        self.sets_tried = 0
        self.loops, self.basis = loops, CycleSpace()
        self.given = [loop for loop in loops if not any(unknown[joint] for joint, _ in loop)]
        """Loops of the structure in which all coordinates are given."""
        for loop in self.given:
            self.basis.add(loop)

    def _open_motions(self) -> Float[np.ndarray, "motions columns"]:
        """A basis of the rates that keep all remaining loops closed while the known coordinates rest."""
        if not self.open:
            return np.zeros((0, len(self.columns)))
        jacobian = loop_jacobian(self.graph.circuits(self.remaining), self.columns, self.screws)
        _, motions = null_space(jacobian[:, self.open], self.thresholds.rank)
        found = np.zeros((len(motions), len(self.columns)))
        found[:, self.open] = motions
        return found

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
        while level and self.sets_tried <= _MAX_SETS:
            larger: list[frozenset[int]] = []
            for one in level:
                for circuit in circuits:
                    union = one | circuit
                    if one & circuit and union not in tried and self.sets_tried <= _MAX_SETS:
                        self.sets_tried += 1
                        tried.add(union)
                        larger.append(union)
            level = sorted(larger, key=self._weight)
            yield from level

    def _solvable(self, joints: Sequence[int]) -> bool:
        """Whether every motion that these loops allow alone is left to them by all others."""
        unknowns = [column for joint in joints for column in self.unknown[joint]]
        alone = len(unknowns) - self._rank(self.graph.circuits(joints), unknowns)
        return alone == independent(self.motions, unknowns, self.thresholds)

    def _rank(self, circuits: Sequence[Circuit], unknowns: Sequence[int]) -> int:
        jacobian = loop_jacobian(circuits, self.columns, self.screws)
        return null_space(jacobian[:, list(unknowns)], self.thresholds.rank)[0]

    def solve(self, joints: Sequence[int]) -> None:
        """Add the group of these joints, and contract them."""
        unknowns = tuple(column for joint in joints for column in self.unknown[joint])
        circuits = self.graph.circuits(joints)
        loops = self._closed(joints, circuits)
        known = self.graph.known_joints(loops)
        number = len(self.groups)
        needed = _direct(self.groups, sorted({group for group in known.values() if group is not None}))
        rank = self._rank(circuits, unknowns)
        self.groups.append(Group(tuple(joints), unknowns, tuple(sorted(known)), loops, rank, needed))
        for joint in joints:
            self.graph.contract(joint, number)
        self.remaining = [joint for joint in self.remaining if joint not in set(joints)]
        self.motions = without(self.motions, unknowns, self.thresholds)

    def rest(self) -> list[Group]:
        """The loops of the structure that the groups do not imply, as a group without unknowns: all is given there."""
        loops = (*self.given, *(loop for loop in self.loops if self.basis.add(loop)))
        known = sorted({joint for loop in loops for joint, _ in loop})
        return [Group((), (), tuple(known), loops, 0, tuple(range(len(self.groups))))] if loops else []

    def _closed(self, joints: Sequence[int], circuits: Sequence[Circuit]) -> tuple[Circuit, ...]:
        """As many independent closed circuits as a group has: loops of the structure first, which are short and whose
        residual users know, then circuits of the group with the known joints that they pass."""
        ready = {joint for joint, found in self.unknown.items() if not found or joint not in self.remaining}
        ready.update(joints)
        whole = (loop for loop in self.loops if all(joint in ready for joint, _ in loop))
        found: list[Circuit] = []
        for loop in (*whole, *map(self.graph.closed, circuits)):
            if len(found) < len(circuits) and self.basis.add(loop):
                found.append(loop)
        return tuple(found)

    def _weight(self, joints: Collection[int]) -> tuple[int, list[int]]:
        return sum(len(self.unknown[joint]) for joint in joints), sorted(joints)
