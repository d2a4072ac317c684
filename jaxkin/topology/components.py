"""Connected and biconnected components of a graph.

Written out here, since the import of a graph library would add a quarter of a second to every start.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Sequence
from typing import TypeVar

Node = TypeVar("Node", bound=Hashable)


def connected(nodes: Iterable[Node], pairs: Iterable[Collection[Node]]) -> list[set[Node]]:
    """Find the connected components of a graph, in the order of their first nodes; `pairs` are its edges."""
    component_of = {node: {node} for node in nodes}
    for one, other in pairs:
        small, large = sorted((component_of[one], component_of[other]), key=len)
        if small is not large:
            large |= small
            component_of |= dict.fromkeys(small, large)
    return list({id(component): component for component in component_of.values()}.values())


def biconnected(nodes: int, edges: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Find the biconnected components of a multigraph, each as the rising indices of its edges.

    An edge from a node to itself is a component. Depth-first search (Hopcroft and Tarjan 1973): a component is complete
    where no node below an edge has an edge to a node above it.
    """
    around: list[list[tuple[int, int]]] = [[] for _ in range(nodes)]
    for edge, (one, other) in enumerate(edges):
        around[one].append((edge, other))
        around[other].append((edge, one))
    depth, low = [-1] * nodes, [0] * nodes
    found = [[edge] for edge, (one, other) in enumerate(edges) if one == other]
    for root in range(nodes):
        if depth[root] >= 0:
            continue
        depth[root], passed = 0, []
        way = [(root, -1, iter(around[root]))]  # (node, edge that led to it, edges left to try)
        while way:
            node, came, rest = way[-1]
            for edge, other in rest:
                if depth[other] < 0:
                    depth[other] = low[other] = len(way)
                    passed.append(edge)
                    way.append((other, edge, iter(around[other])))
                    break
                if edge != came and depth[other] < depth[node]:
                    passed.append(edge)
                    low[node] = min(low[node], depth[other])
            else:
                way.pop()
                if not way:
                    continue
                above = way[-1][0]
                low[above] = min(low[above], low[node])
                if low[node] >= depth[above]:
                    component = [passed.pop()]
                    while component[-1] != came:
                        component.append(passed.pop())
                    found.append(sorted(component))
    return found
