"""Loops of all structure elements, and where each starts (loop data, Tables 3, 5 and 7)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

from jaxkin.topology.chords import aligned, fundamental_circuits
from jaxkin.topology.cycle_basis import directed_circuits
from jaxkin.topology.elements import ElementNode
from jaxkin.topology.graph import Circuit, Graph, WalkStep


@dataclass(frozen=True)
class Loop:
    """A closed loop in its direction of travel."""

    path: tuple[str, ...]
    """Names of parts and joints in turn, from the first part to the joint that leads back to it."""
    joints: tuple[WalkStep, ...]
    """(joint, sign) in the order of the path: the joint's column, +1 where travelled from part 1 to part 2, else -1."""

    def __str__(self) -> str:
        return " - ".join((*self.path, self.path[0]))


def loop_data(
    graph: Graph, nodes: Sequence[ElementNode], chords: Sequence[int] | None
) -> tuple[tuple[Circuit, ...], ...]:
    """For each element its independent loops: all in one direction, in the order and from the parts of Section 4.2.

    With chords, their loops (Eq. 3), turned where one direction asks for it. Raises ValueError where the chords are not
    those of a spanning tree, or where turning is not enough.
    """
    if chords is None:
        found = [directed_circuits(graph, node.joints, node.rows[0]) if node.joints else () for node in nodes]
    else:
        through = dict(zip(chords, fundamental_circuits(graph, chords), strict=True))
        found = [aligned([through[chord] for chord in chords if chord in node.joints]) for node in nodes]
    return tuple(_from_known_parts(graph, circuits, node.rows[0]) for circuits, node in zip(found, nodes, strict=True))


def _from_known_parts(graph: Graph, circuits: Sequence[Circuit], upper: int) -> tuple[Circuit, ...]:
    """The first loop holds the upper adjacent part, every other one a part of a loop before it; there they start.

    They start at the upper adjacent part where they hold it, else at that part which was met first. Of the loops that
    can come next, the first as given is taken.
    """
    through: dict[int, list[int]] = defaultdict(list)
    for number, circuit in enumerate(circuits):
        for step in circuit:
            through[graph.tail(step)].append(number)
    met = {upper: 0}
    ready = through.pop(upper, [])
    heapify(ready)
    ordered: dict[int, Circuit] = {}
    while ready:
        number = heappop(ready)
        if number in ordered:
            continue
        rows = [graph.tail(step) for step in circuits[number]]
        first = min(range(len(rows)), key=lambda place: met.get(rows[place], len(met)))
        ordered[number] = circuits[number][first:] + circuits[number][:first]
        for row in rows[first:] + rows[:first]:
            met.setdefault(row, len(met))
            for other in through.pop(row, ()):
                heappush(ready, other)
    return tuple(ordered.values())
