"""Connected components of a graph given by its edges."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int


def components(count: int, edges: Int[np.ndarray, "edges 2"]) -> Int[np.ndarray, " count"]:
    """Number the connected components of `count` nodes, from 0 in the order of their first nodes: one number a node."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(edges), bool), tuple(edges.T)), shape=(count, count))
    label = connected_components(graph, directed=False)[1]
    _, first, label = np.unique(label, return_index=True, return_inverse=True)
    rank = np.empty(len(first), int)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[label]


def grouped(label: Int[np.ndarray, "_"]) -> list[Int[np.ndarray, "_"]]:
    """Group the indices of equal labels, by increasing label."""
    order = np.argsort(label, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(label[order])) + 1) if len(order) else []
