"""Short loops in one direction, for any mechanism: an ear decomposition in place of the search of Section 4.1.

Loops that share joints are strongly orientable (Robbins 1939): start with a short circuit and add ears, paths that
leave the joints directed so far and come back to them. Each ear takes the direction in which the directed joints close
it to the shorter circuit. Every circuit brings a joint of its own, so they are independent; an ear can always be found
and closed, so they are a basis, in polynomial time, whatever the mechanism.
"""

from __future__ import annotations

from collections import deque
from heapq import heappop, heappush

from jaxkin.topology.chords import turned
from jaxkin.topology.graph import Circuit, Graph, WalkStep

_MAX_TRIALS = 1000
"""Joints times starting parts that are tried for the fewest joints in all: every part of small mechanisms, one part of
large ones, so that none takes long."""


def directed_circuits(graph: Graph, loop_group: tuple[int, ...], upper: int) -> tuple[Circuit, ...]:
    """A basis of the loops through the joints of a loop group, all in one direction, short, the shortest first.

    As for the chords of Eq. (3), the last joint is travelled from part 1 to part 2. `upper` is a row of the loop group.
    """
    around: dict[int, list[tuple[WalkStep, int]]] = {}
    for joint in loop_group:
        row1, row2 = graph.ends[joint]
        around.setdefault(row1, []).append((WalkStep(joint, 1), row2))
        around.setdefault(row2, []).append((WalkStep(joint, -1), row1))
    others = sorted(around.keys() - {upper})
    starts = [upper, *others][: max(1, _MAX_TRIALS // len(loop_group))]
    circuits = min((_ears(graph, around, start) for start in starts), key=lambda found: sum(map(len, found)))
    if any(WalkStep(loop_group[-1], -1) in circuit for circuit in circuits):
        circuits = list(map(turned, circuits))
    return tuple(sorted(circuits, key=lambda circuit: (len(circuit), sorted(circuit))))


def _ears(graph: Graph, around: dict[int, list[tuple[WalkStep, int]]], start: int) -> list[Circuit]:
    """Circuits of an ear decomposition, the shortest first at each stage, of equal ones that with the shorter ear.

    Lengths in the queue are those of an earlier stage: a step is measured again when it comes up, and when a new
    circuit passes its row, since that may have shortened it.
    """
    leaving: dict[int, list[tuple[WalkStep, int]]] = {start: []}
    directed: set[int] = set()
    reached = {start: 0}
    queue = [(0, 0, 0, step) for step, _ in around[start]]
    circuits: list[Circuit] = []
    while queue:
        _, _, age, step = heappop(queue)
        if step.joint in directed:
            continue
        circuit = _shortest(graph, around, leaving, step)
        measure = (len(circuit), sum(joint not in directed for joint, _ in circuit), age)
        if queue and measure > queue[0][:3]:
            heappush(queue, (*measure, step))
            continue
        circuits.append(circuit)
        for step in circuit:
            if step.joint not in directed:
                directed.add(step.joint)
                leaving.setdefault(graph.tail(step), []).append((step, graph.head(step)))
                reached.setdefault(graph.tail(step), len(reached))
        for step in circuit:
            row = graph.tail(step)
            for other, _ in around[row]:
                if other.joint not in directed:
                    heappush(queue, (0, 0, reached[row], other))
    return circuits


def _shortest(
    graph: Graph,
    around: dict[int, list[tuple[WalkStep, int]]],
    leaving: dict[int, list[tuple[WalkStep, int]]],
    first: WalkStep,
) -> Circuit:
    """The shortest circuit that begins with a step out of the directed joints and, once back, keeps their direction."""
    start, row = graph.tail(first), graph.head(first)
    came = {row: first}
    queue: deque[int] = deque()
    ways = [way for way in (leaving[row] if row in leaving else around[row]) if way[0].joint != first.joint]
    while True:  # out of the first row any way but back
        for step, other in ways:
            if other not in came:
                came[other] = step
                queue.append(other)
        if start in came:
            break
        row = queue.popleft()
        ways = leaving[row] if row in leaving else around[row]
    steps = [came[start]]
    while steps[-1] != first:
        steps.append(came[graph.tail(steps[-1])])
    return tuple(reversed(steps))
