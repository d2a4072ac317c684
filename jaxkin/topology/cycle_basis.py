"""A cycle basis of short loops that all travel each joint in one direction: replaces the search of Section 4.1.

Loops that share joints are strongly orientable (Robbins 1939), by an ear decomposition: start with a short circuit and
add ears. An ear is a path of new joints that leaves the joints directed so far and comes back to them. Of the two
directions of an ear, it takes that in which the directed joints close it to the shorter circuit. Every circuit has at
least one joint that no earlier circuit has, so the circuits are independent; an ear can always be found and closed, so
they are a basis. The search takes polynomial time for every mechanism.
"""

from __future__ import annotations

from collections import deque
from heapq import heappop, heappush

from jaxkin.topology.chords import reversed_circuit
from jaxkin.topology.graph import Circuit, Graph, WalkStep

_MAX_TRIALS = 1000
"""Bounds the number of starting parts tried, times the number of joints of the loop group. All parts of a small group
are tried, one part of a large one; the basis with the fewest joints in all its loops is taken."""


def directed_circuits(graph: Graph, loop_group: tuple[int, ...], upper: int) -> tuple[Circuit, ...]:
    """Find a cycle basis of a loop group: short loops, all in one direction, the shortest first.

    As for the chords of Eq. (3), the last joint of the group is travelled from part 1 to part 2. `loop_group` holds
    joints; `upper` is the row at which the search starts first.
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
        circuits = list(map(reversed_circuit, circuits))
    return tuple(sorted(circuits, key=lambda circuit: (len(circuit), sorted(circuit))))


def _ears(graph: Graph, around: dict[int, list[tuple[WalkStep, int]]], start: int) -> list[Circuit]:
    """Find the circuits of an ear decomposition: at each stage the shortest, of equally short the one of shortest ear.

    The queue holds the steps out of the directed joints, each with the length of the circuit that it begins, as
    measured at an earlier stage. A step is measured again when it comes up, and is queued anew when a new circuit
    passes the row that it leaves, since its own circuit may be shorter then.
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
    """Find the shortest circuit that begins with the step `first` out of the directed joints (breadth-first search).

    Where it meets a directed joint again, it follows the direction of that joint. `around` holds all steps that leave a
    row, `leaving` the directed ones; each step comes with the row that it leads to.
    """
    start, row = graph.tail(first), graph.head(first)
    came = {row: first}
    queue: deque[int] = deque()
    ways = [way for way in (leaving[row] if row in leaving else around[row]) if way[0].joint != first.joint]
    while True:  # from the first row any step but the one back
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
