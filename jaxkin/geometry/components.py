"""Find the connected components of a graph that is given by its edges."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int


def components(count: int, edges: Int[np.ndarray, "edges 2"]) -> Int[np.ndarray, " count"]:
    """Return for each of `count` nodes the number of its connected component, an array (count,).

    Components are numbered from 0 in the order of their first nodes.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(edges), bool), tuple(edges.T)), shape=(count, count))
    label = connected_components(graph, directed=False)[1]
    _, first, label = np.unique(label, return_index=True, return_inverse=True)
    rank = np.empty(len(first), int)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[label]


def grouped(label: Int[np.ndarray, "_"]) -> list[Int[np.ndarray, "_"]]:
    """Group the indices of equal labels; the groups are in the order of the labels, the indices rise."""
    order = np.argsort(label, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(label[order])) + 1) if len(order) else []
