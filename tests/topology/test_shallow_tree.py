"""Spanning trees for files: every part once, as near to the roots as the graph allows, by the cheapest joints."""

import networkx as nx
from hypothesis import given
from hypothesis import strategies as st

from jaxkin.topology.shallow_tree import shallow_tree

PAIRS = st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)), max_size=14)


@given(PAIRS, st.randoms(use_true_random=False))
def test_parts_hang_as_near_to_the_root_as_the_graph_allows(pairs, random):
    joint_parts = [(str(one), str(other)) for one, other in pairs]
    costs = [random.randint(0, 3) for _ in pairs]
    tree = shallow_tree(joint_parts, ["0"], costs)
    graph = nx.MultiGraph([("0", "0"), *joint_parts])
    expected = nx.single_source_shortest_path_length(graph, "0")
    depth = {"0": 0}
    for part, parent, joint, sign in tree:
        assert part not in depth and joint_parts[joint] == ((parent, part) if sign > 0 else (part, parent))
        depth[part] = depth[parent] + 1  # the parent comes before
        rivals = [
            number
            for number, ends in enumerate(joint_parts)
            for a, b in (ends, ends[::-1])
            if b == part and expected.get(a) == expected[part] - 1
        ]
        assert costs[joint] == min(costs[number] for number in rivals)
    assert depth == expected
