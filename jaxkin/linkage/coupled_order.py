"""Find the order in which the loops and couplings of a loop group are solved.

A coupling in which one coordinate is unknown is solved for it, before the loops if all others are given, and after them
if its unknown is in no loop. So a gear train in front of a linkage or behind it leaves the order of the loops as it is.
Loops and couplings that need each other are one group.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

from jaxkin.linkage.first_order import Columns
from jaxkin.linkage.solve_order import Group
from jaxkin.topology.graph import Circuit

OrderOfLoops = Callable[[Collection[int]], tuple[Group, ...]]
"""Finds the groups of the loops alone, for the columns that are known."""


def order_with_couplings(
    loops: Sequence[Circuit],
    couplings: Mapping[int, Collection[int]],
    columns: Columns,
    driven: Collection[int],
    order_of_loops: OrderOfLoops,
) -> tuple[Group, ...]:
    """Find the groups of a loop group with couplings, every group after those that it needs.

    `couplings` maps the number of each coupling to the columns that it ties; `columns` are (joint, coordinate);
    `driven` are the columns that are given.
    """
    owner = [joint for joint, _ in columns]
    in_loops = {column for loop in loops for joint, _ in loop for column, of in enumerate(owner) if of == joint}
    known, left, first = set(driven), dict(couplings), list[tuple[int, int]]()
    while found := next(((k, c) for k in left for c in _only(left[k], known)), None):
        first.append(found)
        del left[found[0]]
        known.add(found[1])
    last, behind = list[tuple[int, int]](), set[int]()
    while found := next(((k, c) for k in left for c in _alone(k, left, in_loops | known)), None):
        last.append(found)
        del left[found[0]]
        behind.add(found[1])
    checks = [k for k in left if known.issuperset(left[k])]
    left = {k: tied for k, tied in left.items() if k not in checks}
    middle = order_of_loops(known) if loops and not left else ()
    if left or any(group.free for group in middle):
        return (_together(loops, couplings, columns, driven),)
    groups = [_of_coupling(k, column, owner) for k, column in first]
    leading = len(groups)
    for group in middle:
        after = {leading + k for k in group.after} | set(_solving(groups[:leading], group.known_joints))
        groups.append(replace(group, after=tuple(sorted(after))))
    for k, column in last[::-1]:
        groups.append(_of_coupling(k, column, owner))
    if checks:
        groups.append(Group((), (), (), (), 0, tuple(range(len(groups))), couplings=tuple(checks)))
    for number, group in enumerate(groups):
        if group.couplings and group.unknowns:
            tied = {owner[column] for column in couplings[group.couplings[0]]} - set(group.joints)
            groups[number] = replace(
                group, known_joints=tuple(sorted(tied)), after=tuple(_solving(groups[:number], tied))
            )
    return tuple(groups)


def _only(tied: Collection[int], known: Collection[int]) -> list[int]:
    """Find the one column of a coupling that is not known; empty if there are none or several."""
    unknown = [column for column in tied if column not in known]
    return unknown if len(unknown) == 1 else []


def _alone(number: int, couplings: Mapping[int, Collection[int]], held: Collection[int]) -> list[int]:
    """Find the first column of coupling `number` that is not `held` (in a loop, or known), nor in another coupling."""
    others = {column for k, tied in couplings.items() if k != number for column in tied}
    return [column for column in couplings[number] if column not in held and column not in others][:1]


def _of_coupling(number: int, column: int, owner: Sequence[int]) -> Group:
    """Make the group of a coupling that is solved by itself, for one column."""
    return Group((owner[column],), (column,), (), (), 1, (), couplings=(number,))


def _solving(groups: Sequence[Group], joints: Collection[int]) -> list[int]:
    """List the numbers of the groups in which some of these joints are solved."""
    return [number for number, group in enumerate(groups) if set(group.joints) & set(joints)]


def _together(
    loops: Sequence[Circuit], couplings: Mapping[int, Collection[int]], columns: Columns, driven: Collection[int]
) -> Group:
    """Make one group of all loops and couplings; its rank is taken to be the number of its unknowns."""
    unknowns = tuple(column for column in range(len(columns)) if column not in driven)
    joints = tuple(dict.fromkeys(columns[column][0] for column in unknowns))
    known = tuple(dict.fromkeys(joint for joint, _ in columns if joint not in joints))
    return Group(joints, unknowns, known, tuple(loops), len(unknowns), (), couplings=tuple(couplings))
