"""The independent loops of all structure elements, and the part where each loop starts (Tables 3, 5 and 7)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

from jaxkin.topology.chords import fundamental_circuits, oriented
from jaxkin.topology.cycle_basis import directed_circuits
from jaxkin.topology.elements import ElementNode
from jaxkin.topology.graph import Circuit, Graph, WalkStep


@dataclass(frozen=True)
class Loop:
    """A closed loop in its direction of travel."""

    path: tuple[str, ...]
    """Names of parts and joints in turn, from the first part to the joint that leads back to it."""
    joints: tuple[WalkStep, ...]
    """Column and sign of each joint in the order of the path: +1 where travelled from part 1 to part 2, else -1."""

    def __str__(self) -> str:
        return " - ".join((*self.path, self.path[0]))


def loop_data(
    graph: Graph, nodes: Sequence[ElementNode], chords: Sequence[int] | None
) -> tuple[tuple[Circuit, ...], ...]:
    """Find the independent loops of each element, all in one direction, in the order of Section 4.2.

    Each loop starts at the part that Section 4.2 says. With `chords`, the loops are those of Eq. 3, some reversed so
    that all have one direction. Raises ValueError where the chords are not those of a spanning tree, or where no
    reversal gives the loops one direction.
    """
    if chords is None:
        found = [directed_circuits(graph, node.joints, node.rows[0]) if node.joints else () for node in nodes]
    else:
        through = dict(zip(chords, fundamental_circuits(graph, chords), strict=True))
        found = [oriented([through[chord] for chord in chords if chord in node.joints]) for node in nodes]
    return tuple(_from_known_parts(graph, circuits, node.rows[0]) for circuits, node in zip(found, nodes, strict=True))


def _from_known_parts(graph: Graph, circuits: Sequence[Circuit], upper: int) -> tuple[Circuit, ...]:
    """Order and rotate circuits so that each starts at a part whose pose is known when its turn comes (Section 4.2).

    The first circuit contains the upper adjacent part, the row `upper`; every other circuit contains a part of an
    earlier one. A circuit starts at the row `upper` if it contains that row, else at the first of its rows that an
    earlier circuit passes. Of the circuits that can come next, the one given first is taken.
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
