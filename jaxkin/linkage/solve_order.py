"""Find the order in which the loops of a loop group are solved, for given driven coordinates.

Parts whose displacements relative to each other are driven, or solved already, are contracted to one
(`contracted_graph`), so that the order does not depend on the choice of loops. A group is a set of loops of the
contracted graph that can be solved alone: every motion that its own loops allow is also allowed by all other loops. In
planar linkages with one drive the groups are the Assur groups. The test is on ranks and not on numbers of joints, so
that it covers idle freedoms, redundant loops, and loops in which only some coordinates of a joint are known. With the
groups in order, the closure Jacobian is block lower triangular.
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
"""Largest number of sets of loops that are tried before all remaining loops are taken as one group. Loop groups of up
to ten loops need fewer than a hundred; the limit keeps a mesh of fifty loops below a second."""


@dataclass(frozen=True)
class Group:
    """Loops that are solved together."""

    joints: tuple[int, ...]
    """The joints whose unknown coordinates are solved here."""
    unknowns: tuple[int, ...]
    """Columns of these coordinates."""
    known_joints: tuple[int, ...]
    """Joints on the loops whose coordinates are all known before this group is solved."""
    loops: tuple[Circuit, ...]
    """Closed circuits of joints, in order of travel: loops of the structure as far as these are independent."""
    rank: int
    """Number of independent equations of the loops for the unknowns."""
    after: tuple[int, ...]
    """Numbers of the groups that must be solved directly before: without those that another of these groups needs."""
    merged: int = 1
    """Number of groups that were merged into this one, because they share freedoms: see `keep_freedoms_together`."""
    couplings: tuple[int, ...] = ()
    """Numbers of the couplings that are solved with the loops."""

    @property
    def free(self) -> int:
        """Number of freedoms that the loops of the group leave undetermined: least-norm steps keep them small."""
        return len(self.unknowns) - self.rank


def solve_order(
    ends: Ends,
    loops: Sequence[Circuit],
    columns: Columns,
    screws: Screws,
    driven: Collection[int],
    thresholds: Thresholds,
) -> tuple[Group, ...]:
    """Find the groups of a loop group, each as small as was found, every group after those that it needs.

    `ends` maps each joint to its two parts; `loops` are the loops of the structure; `columns` are (joint, coordinate);
    `screws` (6, columns) are the twists of the coordinates at a closed pose, in world coordinates, angular velocity
    first; `driven` are the columns that are given. Single loops that can be solved alone are always found; of larger
    sets at most `_MAX_SETS` are tried. Solving group by group gives the solution of all equations at once, except where
    coordinates stay undetermined: see `keep_freedoms_together`.
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
    over the whole loop group only if no later group moves with the coordinates that an earlier one leaves undetermined
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
    """Find the first later group whose loops open when this group moves within its own freedoms; None if none does."""
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
    """List the numbers of all groups that must be solved before one, directly or not."""
    return {k for other in groups[number].after for k in (other, *_needed(groups, other))}


def _merged(
    groups: Sequence[Group], chosen: Sequence[int], columns: Columns, screws: Screws, thresholds: Thresholds
) -> list[Group]:
    """Merge the chosen groups into one, and order the groups so that each follows those that it needs."""
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
    """Drop from the groups `after` those that another of them needs, directly or not."""
    implied = {k for other in after for k in _needed(groups, other)}
    return tuple(sorted(set(after) - implied))


def order_by_counting(
    loops: Sequence[Circuit], unknown: Mapping[int, Sequence[int]], equations: Sequence[int | None]
) -> tuple[Group, ...]:
    """Find the groups of a loop group by counting, for joint frames whose numbers JAX traces.

    `unknown` maps each joint to its unknown columns. A loop is a group of its own if it brings as many unknown
    coordinates as it has `equations`. For loops in space `equations` is None: counting cannot tell there, because
    equations are often redundant. All loops that are no groups of their own are the last group. The ranks assume that
    the equations are independent.
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
    """The state of the search for groups: which coordinates are known, and the groups found so far."""

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
        """Columns of the undriven coordinates."""
        self.motions = self._open_motions()
        """Basis of the rates (motions, columns) that keep the loops closed while all known coordinates rest."""
        self.sets_tried = 0
        self.loops, self.basis = loops, CycleSpace()
        self.given = [loop for loop in loops if not any(unknown[joint] for joint, _ in loop)]
        """Loops of the structure in which all coordinates are given."""
        for loop in self.given:
            self.basis.add(loop)

    def _open_motions(self) -> Float[np.ndarray, "motions columns"]:
        """Compute a basis of the rates that keep all remaining loops closed while the known coordinates rest."""
        if not self.open:
            return np.zeros((0, len(self.columns)))
        jacobian = loop_jacobian(self.graph.circuits(self.remaining), self.columns, self.screws)
        _, motions = null_space(jacobian[:, self.open], self.thresholds.rank)
        found = np.zeros((len(motions), len(self.columns)))
        found[:, self.open] = motions
        return found

    def next(self) -> list[int]:
        """Choose the joints of the next group: the set with the fewest unknowns that was found to be solvable alone.

        If no set that was tried is solvable, the group is all circuits that are connected with the first one through
        shared joints. If these are not solvable either (circuits that share parts, but no joints, may need each other),
        it is all that is left.
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
        """Yield the circuits, then unions of two that share joints, of three, and so on, fewest unknowns first."""
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
        """Tell whether the loops through these joints allow as many motions alone as with all other loops."""
        unknowns = [column for joint in joints for column in self.unknown[joint]]
        alone = len(unknowns) - self._rank(self.graph.circuits(joints), unknowns)
        return alone == independent(self.motions, unknowns, self.thresholds)

    def _rank(self, circuits: Sequence[Circuit], unknowns: Sequence[int]) -> int:
        jacobian = loop_jacobian(circuits, self.columns, self.screws)
        return null_space(jacobian[:, list(unknowns)], self.thresholds.rank)[0]

    def solve(self, joints: Sequence[int]) -> None:
        """Add the group of these joints, and contract the joints in the graph."""
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
        """Collect the loops of the structure that no group implies in a group without unknowns."""
        loops = (*self.given, *(loop for loop in self.loops if self.basis.add(loop)))
        known = sorted({joint for loop in loops for joint, _ in loop})
        return [Group((), (), tuple(known), loops, 0, tuple(range(len(self.groups))))] if loops else []

    def _closed(self, joints: Sequence[int], circuits: Sequence[Circuit]) -> tuple[Circuit, ...]:
        """Choose as many independent closed circuits as the group has.

        Loops of the structure come first, because they are short and users know their residuals; then circuits of the
        contracted graph, closed by the known joints that they pass.
        """
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
