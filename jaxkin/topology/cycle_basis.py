"""Find a basis of short loops in which any two loops travel a common joint in the same direction.

The construction replaces the trial of loop directions in Section 4.1 of the paper. The graph of a loop group has no
bridge, so each joint can be given one direction such that the directed graph is strongly connected (Robbins 1939).

The directions come from an ear decomposition. An ear is a path of joints without a direction whose two end rows, and no
rows between, lie on joints that have one; the first ear is a circuit. The joints of an ear take the direction of travel
along it, and a directed path between its end rows closes it to a circuit of the basis. Of the two directions of travel,
the one with the shorter circuit is taken. Every circuit has a joint that no earlier one has, so the circuits are
independent; the ears use up all joints, so the circuits are a basis. The search takes polynomial time.
"""

from __future__ import annotations

from collections import deque
from heapq import heappop, heappush

from jaxkin.topology.chords import reversed_circuit
from jaxkin.topology.graph import Circuit, Graph, WalkStep

_MAX_TRIALS = 1000
"""Upper bound on (number of starting rows tried) x (number of joints of the loop group); one row is always tried.

Bounds the time that a large group takes; in a group of up to some 30 joints every row is tried."""


def directed_circuits(graph: Graph, loop_group: tuple[int, ...], upper: int) -> tuple[Circuit, ...]:
    """Find a cycle basis of short loops for a loop group, such that each joint is travelled in one direction only.

    `loop_group` holds the columns of the joints, rising. The ear decomposition is tried from the row `upper`, then from
    other rows of the group (see `_MAX_TRIALS`); the basis with the fewest joints summed over its loops is returned, the
    shortest loop first. As the chords of Eq. (3) do, the last joint of the group fixes the sign: it is travelled from
    part 1 to part 2.
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
    """Build an ear decomposition greedily from the row `start`, and return the circuit that closes each ear.

    Each round takes the candidate circuit of least priority: (length of the circuit, length of its ear, `order` of the
    row at which it starts), lengths in joints. `around` gives for each row the steps that leave it, each with the row
    that it leads to.

    A candidate is queued as its first step, from a row that is on directed joints along a joint without a direction.
    The priority in the queue may be out of date: with more joints directed, a circuit can become longer (it must
    follow their directions) or shorter (its ear ends sooner). So a candidate is searched anew when it is popped, and
    goes back unless it still comes first; and the steps from all rows of a new circuit are queued again ahead of
    all others, so that they are searched anew too.
    """
    leaving: dict[int, list[tuple[WalkStep, int]]] = {start: []}  # directed steps out of each row that has any
    directed: set[int] = set()
    order = {start: 0}  # rows on directed joints -> how many came before
    queue = [(0, 0, 0, step) for step, _ in around[start]]
    circuits: list[Circuit] = []
    while queue:
        _, _, rank, step = heappop(queue)
        if step.joint in directed:
            continue
        circuit = _shortest(graph, around, leaving, step)
        priority = (len(circuit), sum(joint not in directed for joint, _ in circuit), rank)
        if queue and priority > queue[0][:3]:
            heappush(queue, (*priority, step))
            continue
        circuits.append(circuit)
        for step in circuit:
            if step.joint not in directed:
                directed.add(step.joint)
                leaving.setdefault(graph.tail(step), []).append((step, graph.head(step)))
                order.setdefault(graph.tail(step), len(order))
        for step in circuit:
            row = graph.tail(step)
            for other, _ in around[row]:
                if other.joint not in directed:
                    heappush(queue, (0, 0, order[row], other))
    return circuits


def _shortest(
    graph: Graph,
    around: dict[int, list[tuple[WalkStep, int]]],
    leaving: dict[int, list[tuple[WalkStep, int]]],
    first: WalkStep,
) -> Circuit:
    """Find the shortest circuit that begins with the step `first`, by breadth-first search.

    The step `first` takes a joint without a direction. From a row on directed joints the circuit follows these in their
    direction (`leaving`), from other rows it may take any step (`around`). Both give for a row the steps that leave it,
    each with the row that it leads to.
    """
    start, row = graph.tail(first), graph.head(first)
    arrived_by = {row: first}
    queue: deque[int] = deque()
    onward = leaving[row] if row in leaving else around[row]
    onward = [(step, other) for step, other in onward if step.joint != first.joint]  # not straight back along `first`
    while True:
        for step, other in onward:
            if other not in arrived_by:
                arrived_by[other] = step
                queue.append(other)
        if start in arrived_by:
            break
        row = queue.popleft()
        onward = leaving[row] if row in leaving else around[row]
    steps = [arrived_by[start]]
    while steps[-1] != first:
        steps.append(arrived_by[graph.tail(steps[-1])])
    return tuple(reversed(steps))
