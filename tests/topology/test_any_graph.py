"""What holds for every mechanism: random multigraphs against the rules of Section 4, with networkx as the judge."""

from itertools import pairwise
from random import Random
from time import process_time

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaxkin.topology.structure import Structure, structure

Joints = list[tuple[str, str, str]]
SEEDS = st.integers(0, 2**32)  # hypothesis' own random numbers cost more than the structure


@st.composite
def rings_and_ears(draw: st.DrawFn, joints: int = 200) -> Joints:
    """A 2-edge-connected multigraph: paths of new parts between known ones (Robbins), joints turned and shuffled."""
    random = Random(draw(SEEDS))
    wanted = draw(st.integers(2, joints))
    longest = draw(st.integers(1, 8))
    known, pairs = 1, []
    while len(pairs) < wanted:
        start, end = random.randrange(known), random.randrange(known)
        new = random.randrange(1 if start == end else 0, longest + 1)
        rows = [start, *range(known, known + new), end]
        pairs += [random.sample(pair, 2) for pair in pairwise(rows)]
        known += new
    random.shuffle(pairs)
    return [(f"j{number}", f"p{part1}", f"p{part2}") for number, (part1, part2) in enumerate(pairs)]


@st.composite
def connected(draw: st.DrawFn) -> Joints:
    """Such multigraphs hung together by chains of joints."""
    random = Random(draw(SEEDS))
    joints: Joints = []
    for piece in range(draw(st.integers(1, 4))):
        here = [
            (f"{name}_{piece}", f"{part1}_{piece}", f"{part2}_{piece}")
            for name, part1, part2 in draw(rings_and_ears(20))
        ]
        if joints:
            above, below = random.choice(parts_of(joints)), random.choice(parts_of(here))
            chain = [above, *(f"q{i}_{piece}" for i in range(random.randrange(3))), below]
            joints += [(f"b{i}_{piece}", *random.sample(link, 2)) for i, link in enumerate(pairwise(chain))]
        joints += here
    random.shuffle(joints)
    return joints


def parts_of(joints: Joints) -> list[str]:
    return list(dict.fromkeys(part for _, *ends in joints for part in ends))


def multigraph(found: Structure) -> nx.MultiGraph:
    graph = nx.MultiGraph()
    graph.add_nodes_from(found.parts)
    for name, ends in zip(found.joints, found.joint_parts, strict=True):
        graph.add_edge(*(found.row_of[part] for part in ends), key=name)
    return graph


def rank_of_joints(found: Structure) -> int:
    """Rank of the loops as sets of joints, without signs (modulo 2): that with signs is no smaller."""
    pivots: dict[int, int] = {}
    for loop in found.loops:
        row = sum(1 << joint for joint, _ in loop.joints)
        while row and row.bit_length() in pivots:
            row ^= pivots[row.bit_length()]
        if row:
            pivots[row.bit_length()] = row
    return len(pivots)


def check_loops(found: Structure) -> None:
    cycles = found.cycles
    assert len(cycles) == len(found.joints) - len(found.parts) + 1
    assert not (found.incidence @ cycles.T).any()
    assert rank_of_joints(found) == len(cycles)
    assert not ((cycles > 0).any(axis=0) & (cycles < 0).any(axis=0)).any()
    for loop in found.loops:
        parts, joints = loop.path[::2], loop.path[1::2]
        assert len(set(parts)) == len(parts) == len(set(joints)) == len(joints) == len(loop.joints)
        for part, name, after, (joint, sign) in zip(parts, joints, (*parts[1:], parts[0]), loop.joints, strict=True):
            assert name == found.joints[joint]
            assert tuple(found.row_of[end] for end in found.joint_parts[joint][::sign]) == (part, after)


def check_elements(found: Structure) -> None:
    graph = multigraph(found)
    assert [number for element in found.elements for number in element.loops] == list(range(len(found.loops)))
    for element in found.elements:
        assert element.kind == ("part", "single loop", "multiple loop")[min(len(element.loops), 2)]
        assert element.upper == element.parts[0]
        met = {element.upper}
        for number in element.loops:
            path = found.loops[number].path
            assert path[0] in met
            assert path[0] == element.upper or element.upper not in path
            met.update(path[::2])
        assert met == set(element.parts)
        if element.above is not None:
            above = found.elements[element.above]
            ties = (
                set(found.row_of[part] for part in found.joint_parts[found.joints.index(element.joint)])
                if element.joint
                else {element.upper}
            )
            assert element.upper in ties
            assert ties & set(above.parts) & set(above.lower)
    for row in found.parts:
        assert sum(row in element.parts for element in found.elements) >= 1
    tied = [element.joint for element in found.elements if element.joint]
    simple = nx.Graph(graph)
    assert sorted(tied) == sorted(
        key for u, v in nx.bridges(simple) if graph.number_of_edges(u, v) == 1 for key in graph[u][v]
    )
    looped = [joint for block in found.loop_groups for joint in block.joints]
    assert sorted([*tied, *(found.joints[joint] for joint in looped)]) == sorted(found.joints)
    for one in found.loop_groups:
        for other in found.loop_groups:
            assert one is other or not set(one.joints) & set(other.joints)


def check_tree(found: Structure) -> None:
    placed = set(found.fixed)
    for part, parent, joint, sign in found.tree:
        assert part not in placed and parent in placed
        assert found.joint_parts[joint][::sign] == (parent, part)
        placed.add(part)
    assert placed == set(found.part_names)


@settings(max_examples=40, deadline=None)
@given(rings_and_ears())
def test_loops_of_two_edge_connected_multigraphs(joints: Joints) -> None:
    found = structure(parts_of(joints), joints, parts_of(joints)[:1])
    check_loops(found)
    check_elements(found)
    check_tree(found)
    assert sum(len(block.joints) for block in found.loop_groups) == len(joints)


@settings(max_examples=40, deadline=None)
@given(connected(), st.data())
def test_trees_of_loops_and_parts(joints: Joints, data: st.DataObject) -> None:
    parts = parts_of(joints)
    fixed = data.draw(st.lists(st.sampled_from(parts), min_size=1, max_size=3, unique=True))
    found = structure(parts, joints, fixed)
    check_loops(found)
    check_elements(found)
    check_tree(found)


@settings(max_examples=25, deadline=None)
@given(connected(), SEEDS)
def test_other_names_order_and_direction_give_the_same_structure(joints: Joints, seed: int) -> None:
    random = Random(seed)
    parts = parts_of(joints)
    fixed = random.sample(parts, random.randrange(1, 3))
    before = structure(parts, joints, fixed)
    turned = [(name, *random.sample(ends, 2)) for name, *ends in joints]
    same_order = structure(parts, turned, fixed)
    assert {frozenset(loop.path) for loop in same_order.loops} == {frozenset(loop.path) for loop in before.loops}

    renamed = dict(zip(parts, random.sample(parts, len(parts)), strict=True))
    shuffled = [
        (f"new {name}", *(renamed[part] for part in ends)) for name, *ends in random.sample(turned, len(turned))
    ]
    after = structure(random.sample(parts, len(parts)), shuffled, [renamed[part] for part in fixed])

    def shape(found: Structure, part_names: dict[str, str], prefix: str) -> set:
        def rows(names) -> frozenset:
            merged = {found.row_of[part]: "fixed" for part in found.fixed}
            return frozenset(merged.get(name) or part_names[name] for name in names)

        return {
            (e.kind, rows(e.parts), rows([e.upper]), rows(e.lower), e.joint and prefix + e.joint, len(e.loops))
            for e in found.elements
        }

    assert shape(after, {part: part for part in parts}, "") == shape(before, renamed, "new ")
    columns = [after.joints.index(f"new {name}") for name in before.joints]
    ends = [tuple(renamed[part] for part in pair) for pair in before.joint_parts]
    signs = [1 if after.joint_parts[column] == pair else -1 for column, pair in zip(columns, ends, strict=True)]
    together = np.vstack([before.cycles, after.cycles[:, columns] * signs])
    assert not len(together) or np.linalg.matrix_rank(together) == len(before.cycles)


@pytest.mark.parametrize(("rows", "columns"), [(2, 30), (4, 4), (5, 7)])
def test_loops_of_grids_are_their_cells(rows: int, columns: int) -> None:
    """Cells of a grid can all have one direction, alternately left and right, and nothing is shorter."""
    grid = nx.grid_2d_graph(rows, columns)
    joints = [(f"j{i}", str(a), str(b)) for i, (a, b) in enumerate(grid.edges)]
    found = structure([str(node) for node in grid], joints, [str((rows // 2, columns // 2))])
    assert {len(loop.joints) for loop in found.loops} == {4}


def test_where_the_shortest_loops_have_no_common_direction() -> None:
    """Of the three triangles of a tetrahedron two can be directed alike; then the third loop has four joints."""
    joints = [(f"j{a}{b}", f"p{a}", f"p{b}") for a in range(4) for b in range(a)]
    found = structure([f"p{i}" for i in range(4)], joints, ["p0"])
    check_loops(found)
    assert sorted(len(loop.joints) for loop in found.loops) == [3, 3, 4]
    with pytest.raises(ValueError, match=r"\['j21', 'j31', 'j32'\]: no one direction suits their loops"):
        structure([f"p{i}" for i in range(4)], joints, ["p0"], chords=["j21", "j31", "j32"])


@settings(max_examples=50, deadline=None)
@given(rings_and_ears(12))
def test_loops_are_hardly_longer_than_without_the_direction(joints: Joints) -> None:
    """A minimum cycle basis that may travel a joint both ways is the lower bound; 4000 such graphs were within 1.2."""
    found = structure(parts_of(joints), joints, parts_of(joints)[:1])
    graph = multigraph(found)
    simple = nx.Graph(graph)
    parallel = graph.number_of_edges() - simple.number_of_edges()
    shortest = 2 * parallel + sum(map(len, nx.minimum_cycle_basis(simple)))
    assert shortest <= sum(len(loop.joints) for loop in found.loops) <= 1.3 * shortest


def test_a_thousand_parts_and_fifteen_hundred_joints_take_less_than_two_seconds() -> None:
    """Of processor time. Chords between any parts of a ring: long loops that share most of their joints."""
    random = Random(0)
    pairs = [(part, (part + 1) % 1000) for part in range(1000)]
    pairs += [random.sample(range(1000), 2) for _ in range(500)]
    start = process_time()
    found = structure(
        [f"p{part}" for part in range(1000)], [(f"j{k}", f"p{a}", f"p{b}") for k, (a, b) in enumerate(pairs)], ["p0"]
    )
    assert len(found.tree) == 999 and len(found.cycles) == 501 and len(found.elements) == 1
    assert process_time() - start < 2.0
