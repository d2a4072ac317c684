"""Where the parts go in a drawing of their graph: evenly spread, few lines that cross, none through another part."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from jaxtyping import Float, Int

if TYPE_CHECKING:
    from networkx import Graph

MAX_IMPROVED_NODES = 40
"""Nodes up to which a layout is improved node by node."""
IMPROVEMENT_ROUNDS, TRIALS = 40, 16
"""Of the improvement, and places that are tried for a node in each."""
RANDOM_STARTS, IMPROVED_STARTS = 3, 2
"""Random layouts to begin with, beside those of the graph's distances, and how many of all are improved."""
CROSSING_WEIGHT, NEAR_WEIGHT, NEAR_DISTANCE = 3.0, 0.15, 0.35
"""The weights of a crossing and of a node near a line, and how near that is, in lengths of a line (Davidson, Harel)."""

N = TypeVar("N", bound=Hashable)
NodePlaces = Float[np.ndarray, "nodes 2"]


def layout(nodes: Sequence[N], pairs: Sequence[tuple[N, N]]) -> dict[N, Float[np.ndarray, "2"]]:
    """Place the nodes in a box of larger side 1 about the origin, wider than high; alike at every call."""
    import networkx as nx

    graph = nx.Graph()
    graph.add_nodes_from(range(len(nodes)))
    number = {node: k for k, node in enumerate(nodes)}
    graph.add_edges_from((number[a], number[b]) for a, b in pairs if a != b)
    points = _best(graph) if len(nodes) > 1 else np.zeros((len(nodes), 2))
    points = points - points.mean(axis=0)
    if len(points) > 2:
        points = points @ np.linalg.svd(points, full_matrices=False)[2].T
    points = points - (points.min(axis=0) + points.max(axis=0)) / 2
    return dict(zip(nodes, points / (np.ptp(points, axis=0).max() or 1.0), strict=True))


def _best(graph: Graph) -> NodePlaces:
    import networkx as nx

    def spring(seed: int) -> dict[int, np.ndarray]:
        return nx.spring_layout(graph, seed=seed, iterations=100)

    edges = np.array(graph.edges, int).reshape(-1, 2)
    if len(graph) > MAX_IMPROVED_NODES:
        return _scaled(spring(0), edges)
    starts = [nx.kamada_kawai_layout(graph)]
    starts += [nx.kamada_kawai_layout(graph, pos=nx.planar_layout(graph))] if nx.is_planar(graph) else []
    starts += [spring(seed) for seed in range(RANDOM_STARTS)]

    def cost(points: NodePlaces) -> float:
        return sum(_cost(points, edges, k, points[k][None])[0] for k in graph)

    chosen = sorted((_scaled(start, edges) for start in starts), key=cost)[:IMPROVED_STARTS]
    return min((_improved(points, edges) for points in chosen), key=cost)


def _scaled(places: dict[int, np.ndarray], edges: Int[np.ndarray, "edges 2"]) -> NodePlaces:
    """Scale places so that lines have a length of 1 on average."""
    points = np.array([places[k] for k in range(len(places))])
    lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    return points / (lengths.mean() if len(lengths) else 1.0)


def _improved(points: NodePlaces, edges: Int[np.ndarray, "edges 2"]) -> NodePlaces:
    """Move each node in turn to the best of some places around it, in rounds that reach less and less far."""
    random = np.random.default_rng(0)
    points = points.copy()
    for reach in np.geomspace(1.5, 0.02, IMPROVEMENT_ROUNDS):
        for node in range(len(points)):
            trials = points[node] + np.vstack([np.zeros(2), reach * random.standard_normal((TRIALS, 2))])
            points[node] = trials[np.argmin(_cost(points, edges, node, trials))]
    return points


def _cost(
    points: NodePlaces, edges: Int[np.ndarray, "edges 2"], node: int, trials: Float[np.ndarray, "trials 2"]
) -> Float[np.ndarray, " trials"]:
    """Compute what each place costs that a node could have: too near or far from others, crossings, lines through
    nodes."""
    others = np.delete(np.arange(len(points)), node)
    own = (edges == node).any(axis=1)
    ends = np.where(edges[own, 0] == node, edges[own, 1], edges[own, 0])
    rest = edges[~own]
    gaps = ((trials[:, None] - points[others]) ** 2).sum(axis=-1)
    cost = (1.0 / np.maximum(gaps, 1e-4)).sum(axis=1)
    cost += ((trials[:, None] - points[ends]) ** 2).sum(axis=(1, 2))
    starts, stops = points[rest[:, 0]], points[rest[:, 1]]
    cost += NEAR_WEIGHT * _nearness(trials[:, None], starts, stops).sum(axis=1)
    to = points[ends][:, None]
    near = _nearness(points[others], trials[:, None, None], to)
    cost += NEAR_WEIGHT * (near * (others != ends[:, None])).sum(axis=(1, 2))
    cross = _cross(trials[:, None, None], to, starts, stops) & ~(rest == ends[:, None, None]).any(axis=-1)
    return cost + CROSSING_WEIGHT * cross.sum(axis=(1, 2))


def _nearness(points: np.ndarray, starts: np.ndarray, stops: np.ndarray) -> np.ndarray:
    """Compute one over the squared distance from a line, less what it is where that begins to count."""
    along = stops - starts
    share = ((points - starts) * along).sum(axis=-1) / np.maximum((along**2).sum(axis=-1), 1e-12)
    gaps = ((points - starts - np.clip(share, 0.0, 1.0)[..., None] * along) ** 2).sum(axis=-1)
    return np.maximum(1.0 / np.maximum(gaps, 1e-4) - 1.0 / NEAR_DISTANCE**2, 0.0)


def _cross(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Tell whether the line from a to b and that from c to d have a point in common."""
    return (_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0)


def _side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Measure on which side of the line from p to q r lies: above zero to the left."""
    return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])
