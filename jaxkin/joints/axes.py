"""Make axes and centres that coincide or meet within the noise do so exactly (host code, float64)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from jaxkin.joints.directions import clusters, connected

Points = Float[np.ndarray, "_ 3"]
Star = tuple[int, Int[np.ndarray, "lines"]]
"""A point, by its index, and the lines through it."""

MIN_CROSSING_ANGLE = 0.1
"""Smallest angle, radians, between two axes whose common point is used. The point is uncertain by the noise over the
sine of that angle: for axes nearer to parallel it does not tell which other axes pass through it."""


def align_positions(points: Points, axes: Points, centres: Points, noise: float) -> tuple[Points, Points]:
    """Move lines (a point and a unit vector of `axes` each) and centres so that near coincidences become exact.

    1. Parallel lines within `noise` (a length) of each other become one line, centres within `noise` one point.
    2. Axes that pass a centre within `noise` pass through it, and axes that meet within `noise` meet in one point.

    Parallel axes must be the same vector up to its sign (`align_directions`). Lines move perpendicular to themselves
    only. A step that would move something farther than `noise` leaves it where it is. Returns the points and centres.
    """
    if len(points) + len(centres) == 0:
        return points, centres
    middle = np.vstack([points, centres]).mean(axis=0)
    points, centres = points - middle, centres - middle
    parallel = np.linalg.norm(np.cross(axes[:, None], axes[None]), axis=-1) == 0.0
    found_lines = [
        group[members]
        for group in connected(parallel)
        for members in _coinciding(points[group] - _along(points[group], axes[group]), noise)
    ]
    found_centres = _coinciding(centres, noise)
    lines = np.array([points[members].mean(axis=0) for members in found_lines]).reshape(-1, 3)
    line_axes = np.array([axes[members[0]] for members in found_lines]).reshape(-1, 3)
    nodes = np.array([centres[members].mean(axis=0) for members in found_centres]).reshape(-1, 3)
    lines, nodes = _make_incident(lines, line_axes, nodes, noise)
    new_points, new_centres = np.empty_like(points), np.empty_like(centres)
    for members, line in zip(found_lines, lines, strict=True):
        new_points[members] = line + _along(points[members] - line, axes[members])
    for members, node in zip(found_centres, nodes, strict=True):
        new_centres[members] = node
    return new_points + middle, new_centres + middle


def _along(vectors: Points, axes: Points) -> Points:
    """Project vectors onto unit axes."""
    return np.sum(vectors * axes, axis=-1, keepdims=True) * axes


def _coinciding(points: Points, noise: float) -> list[Int[np.ndarray, "members"]]:
    """Group points that are all within `noise` of their mean."""
    near = np.linalg.norm(points[:, None] - points[None], axis=-1) < noise

    def tight(members) -> bool:
        return bool(np.all(np.linalg.norm(points[members] - points[members].mean(axis=0), axis=1) <= noise))

    return clusters(near, tight) if len(points) else []


def _make_incident(lines: Points, axes: Points, nodes: Points, noise: float) -> tuple[Points, Points]:
    """Move lines and nodes (points) the least so that each line passes exactly through the nodes that it nearly passes.

    With the directions given, "the line passes through the node" is a linear homogeneous equation in both positions:
    all these equations together have a solution, and the nearest one is an orthogonal projection.
    """
    stars, points = _stars(lines, axes, nodes, noise)
    count = len(lines)
    position = np.vstack([lines, points])
    linked = np.zeros((len(position), len(position)), bool)
    for node, members in stars:
        linked[count + node, members] = linked[members, count + node] = True
    for group in connected(linked) if len(position) else []:
        column = {int(index): k for k, index in enumerate(group)}
        rows = []
        for node, members in stars:
            for line in members if count + node in column else ():
                across = np.linalg.svd(axes[line][None])[2][1:]
                row = np.zeros((2, len(group), 3))
                row[:, column[int(line)]], row[:, column[count + node]] = across, -across
                rows.append(row.reshape(2, -1))
        if not rows:
            continue
        matrix = np.vstack(rows)
        change = np.linalg.lstsq(matrix, matrix @ position[group].ravel(), rcond=None)[0].reshape(-1, 3)
        given = group < count + len(nodes)
        if np.all(np.linalg.norm(change[given], axis=1) <= noise):
            position[group] -= change
    return position[:count], position[count : count + len(nodes)]


def _stars(lines: Points, axes: Points, nodes: Points, noise: float) -> tuple[list[Star], Points]:
    """Find the lines that pass each node within `noise`; add nodes where lines meet, nearest to a right angle first.

    Returns (node, lines) for each node that some line passes, and the positions of all nodes.
    """
    points = list(nodes)
    stars: list[Star] = []

    def add(node: int) -> None:
        offset = points[node] - lines
        passing = np.flatnonzero(np.linalg.norm(offset - _along(offset, axes), axis=1) <= noise)
        if len(passing):
            stars.append((node, passing))

    for node in range(len(nodes)):
        add(node)
    between = lines[None] - lines[:, None]
    normals = np.cross(axes[:, None], axes[None])
    sines = np.linalg.norm(normals, axis=-1)
    gaps = np.sum(between * normals, axis=-1) / np.maximum(sines, MIN_CROSSING_ANGLE)
    crossings = np.argwhere(np.triu((sines > MIN_CROSSING_ANGLE) & (np.abs(gaps) <= noise)))
    for i, j in sorted(crossings.tolist(), key=lambda pair: -sines[*pair]):
        if any(i in members and j in members for _, members in stars):
            continue
        normal = normals[i, j] / sines[i, j]
        foot = lines[i] + (np.cross(between[i, j], axes[j]) @ normal / sines[i, j]) * axes[i]
        points.append(foot + gaps[i, j] / 2 * normal)
        add(len(points) - 1)
    return stars, np.array(points).reshape(-1, 3)
