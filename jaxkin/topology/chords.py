"""Fundamental loops of a spanning tree given by its chords (Eq. 3), oriented in one direction (Section 4.1).

A chord is a joint that the spanning tree leaves out; together with the tree it closes one loop.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Sequence

from jaxkin.topology.graph import Circuit, Graph, WalkStep


def fundamental_circuits(graph: Graph, chords: Sequence[int]) -> tuple[Circuit, ...]:
    """Find the loop of each chord: the rows of L = [-S2^T (S1^T)^-1 I] (Eq. 3).

    A loop travels its chord from part 1 to part 2, then leads back through the tree. Raises ValueError where the other
    joints are no spanning tree.
    """
    left = set(range(len(graph.ends))) - set(chords)
    came: dict[int, WalkStep] = {}
    depth = {0: 0}
    queue = deque([0])
    while queue:
        row = queue.popleft()
        for step, other in graph.around[row]:
            if step.joint in left and other not in depth:
                came[other], depth[other] = step, depth[row] + 1
                queue.append(other)
    loops = len(graph.ends) - graph.rows + 1
    if len(chords) != loops:
        raise ValueError(f"there must be one chord for each independent loop, {loops} in all, not {len(chords)}")
    if len(depth) < graph.rows:
        raise ValueError("without them some parts hang on nothing while a loop remains; every loop must lose one joint")

    def through_tree(start: int, end: int) -> Circuit:
        up: list[WalkStep] = []
        down: list[WalkStep] = []
        while start != end:
            higher = depth[start] >= depth[end]
            step = came[start if higher else end]
            if higher:
                up.append(WalkStep(step.joint, -step.sign))
                start = graph.tail(step)
            else:
                down.append(step)
                end = graph.tail(step)
        return (*up, *reversed(down))

    return tuple((WalkStep(chord, 1), *through_tree(graph.ends[chord][1], graph.ends[chord][0])) for chord in chords)


def oriented(circuits: Sequence[Circuit]) -> tuple[Circuit, ...]:
    """Reverse some circuits so that all circuits travel each joint in one direction: operation (a) of Section 4.1.

    The first circuit stays as it is. The circuits must be connected through shared joints. Raises ValueError where no
    reversal does it, so that other combinations of the loops would be needed: operation (b).
    """
    through: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for number, circuit in enumerate(circuits):
        for joint, sign in circuit:
            through[joint].append((number, sign))
    turn = {0: 1}
    queue = deque([0] if circuits else [])
    while queue:
        number = queue.popleft()
        for joint, sign in circuits[number]:
            direction = turn[number] * sign
            for other, other_sign in through.pop(joint, ()):
                if other not in turn:
                    turn[other] = direction * other_sign
                    queue.append(other)
                elif turn[other] != direction * other_sign:
                    raise ValueError("no one direction suits their loops; name other chords, or none for short loops")
    return tuple(circuit if turn[number] > 0 else reversed_circuit(circuit) for number, circuit in enumerate(circuits))


def reversed_circuit(circuit: Circuit) -> Circuit:
    """Reverse the direction of travel of a circuit."""
    return tuple(WalkStep(joint, -sign) for joint, sign in reversed(circuit))
