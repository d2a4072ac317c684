"""Rods between two balls: they spin about the line of the centres, and nothing else moves (host code, numbers only)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import networkx as nx
import numpy as np

from jaxkin.geometry.motions import MOVEMENTS
from jaxkin.joints.joint import Joint

PARALLEL = 1e-9
"""Sine of the angle between directions that count as parallel."""


def idle_spins(joints: Sequence[Joint], body_of: Mapping[str, object]) -> tuple[tuple[int, int, int], ...]:
    """The spins of rods, as `Form.spins`. `body_of` gives the body of a part, the same for all fixed parts.

    A rod is one part, or several in a row that slide along the line only, such as the halves of a leg, held by two
    balls and nothing else, on two different bodies: between two balls on the same body its turn is of use.
    """
    ball_of, balls = {}, 0
    for index, joint in enumerate(joints):
        count = sum(MOVEMENTS[name].ball for name in joint.movements)
        if count == 1 and len(joint.movements) == 1:
            ball_of[index] = balls
        balls += count
    graph = nx.MultiGraph()
    for index, joint in enumerate(joints):
        one, other = joint.parts
        graph.add_edge(body_of[one], body_of[other], index)
    slides = [(a, b, index) for a, b, index in graph.edges(keys=True) if joints[index].movements == ("T_z",)]
    rods = nx.MultiGraph()
    rods.add_nodes_from(graph)
    rods.add_edges_from(slides)
    found = []
    for bodies in nx.connected_components(rods):
        held = [(index, a in bodies) for a, b, index in graph.edges(keys=True) if (a in bodies) != (b in bodies)]
        if len(held) != 2 or not all(index in ball_of for index, _ in held):
            continue
        (one, _), (other, _) = held
        ends = [{body_of[part] for part in joints[index].parts} - bodies for index in (one, other)]
        line = np.asarray(joints[other].before[0], float)[:3, 3] - np.asarray(joints[one].before[0], float)[:3, 3]
        along = [index for a, _, index in slides if a in bodies]
        if ends[0] == ends[1] or not _all_along(line, [joints[index] for index in along]):
            continue
        second = [body_of[joints[index].parts[1]] in bodies for index in (one, other)]
        found.append((ball_of[one], ball_of[other], 1 if second[0] == second[1] else -1))
    return tuple(sorted(found))


def _all_along(line: np.ndarray, slides: Sequence[Joint]) -> bool:
    """Whether the line has a direction, and the joints slide along it."""
    length = float(np.linalg.norm(line))
    axes = [np.asarray(joint.before[0], float)[:3, 2] for joint in slides]
    return length > 0 and all(np.linalg.norm(np.cross(axis, line)) <= PARALLEL * length for axis in axes)
