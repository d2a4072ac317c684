"""Circuits of a graph of which some edges are contracted, and their independence."""

import numpy as np
import pytest

from jaxkin.linkage.contracted_graph import ContractedGraph, CycleSpace
from jaxkin.linkage.solve_order import order_by_counting
from jaxkin.topology.graph import WalkStep

CUBE = {
    number: (f"{a:03b}", f"{b:03b}")
    for number, (a, b) in enumerate((a, a | bit) for a in range(8) for bit in (1, 2, 4) if not a & bit)
}
"""The twelve edges of a cube: five independent circuits."""


def travelled(circuit):
    """The parts that a circuit passes, one after another."""
    pairs = [CUBE[joint][::sign] for joint, sign in circuit]
    assert all(one[1] == other[0] for one, other in zip(pairs, [*pairs[1:], pairs[0]], strict=True))
    return [first for first, _ in pairs]


@pytest.mark.parametrize("known", [(), (0,), (0, 3, 5), (0, 1, 2, 4, 7, 10), tuple(range(1, 12, 2))])
def test_closed_circuits_are_independent_and_meet_no_part_twice(known):
    graph = ContractedGraph(CUBE)
    for joint in known:
        graph.contract(joint, None)
    unknown = [joint for joint in CUBE if joint not in known]
    circuits = [graph.closed(circuit) for circuit in graph.circuits(unknown)]
    rows = np.zeros((len(circuits), len(CUBE)))
    for row, circuit in zip(rows, circuits, strict=True):
        parts = travelled(circuit)
        assert len(set(parts)) == len(parts)
        for joint, sign in circuit:
            row[joint] = sign
    assert np.linalg.matrix_rank(rows) == len(circuits)
    assert set(graph.known_joints(circuits)) <= set(known)
    # Euler: edges less parts that are left, plus one for each component, here one
    assert len(circuits) == len(unknown) - len(set(graph.representative.values())) + 1


def test_a_sum_of_circuits_is_told():
    graph = ContractedGraph(CUBE)
    space = CycleSpace()
    circuits = graph.circuits(list(CUBE))
    assert all(space.add(circuit) for circuit in circuits)
    assert not any(space.add(circuit) for circuit in circuits)


def test_loops_by_counting():
    """A chain of three loops: the last is given first, and each brings three unknowns besides those before it."""
    loops = [tuple(WalkStep(joint, 1) for joint in loop) for loop in ((4, 5, 6, 7), (0, 1, 2, 3), (3, 8, 9, 4))]
    unknown = {joint: [joint - 1] if joint else [] for joint in range(10)}
    groups = order_by_counting(loops, unknown, [3, 3, 3])
    assert [group.joints for group in groups] == [(1, 2, 3), (4, 8, 9), (5, 6, 7)]
    assert [group.after for group in groups] == [(), (0,), (1,)]
    assert all(group.free == 0 for group in groups)
    together = order_by_counting(loops, unknown, [None, None, None])
    assert [len(group.loops) for group in together] == [3]
