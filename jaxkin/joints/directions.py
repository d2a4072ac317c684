"""Make directions that are parallel or perpendicular within the noise exactly so (host code, float64)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.geometry.components import components, grouped

Directions = Float[np.ndarray, "directions 3"]
RESOLVED = 1e-7
"""Angle down to which 1 - |cos| = angle^2 / 2 tells angles in float64, radians; smaller ones their sine tells."""


def connected(near: Bool[np.ndarray, "n n"]) -> list[Int[np.ndarray, "members"]]:
    """Find the connected components, as arrays of nodes, of the graph with a symmetric adjacency matrix."""
    return grouped(components(len(near), np.argwhere(near)))


def clusters(near: Bool[np.ndarray, "n n"], spread) -> list[Int[np.ndarray, "members"]]:
    """Group near nodes: connected components for which `spread(members)` is true, and each other node alone.

    Nearness is not transitive: a chain of near nodes may connect nodes that are far apart. Such a chain is no cluster,
    and its members stay where they are.
    """
    found = []
    for members in connected(near):
        found.extend([members] if len(members) == 1 or spread(members) else members[:, None])
    return found


def align_directions(directions: Directions, noise: float) -> Directions:
    """Change unit vectors so that those parallel or perpendicular within `noise` (radians) are exactly so.

    Parallel directions become one vector, up to their signs; perpendicular ones get a dot product of rounding size
    (2e-16). No direction moves by more than `noise` to become parallel and as much again to become perpendicular;
    where that is not enough, the directions stay as they are.
    """
    if len(directions) == 0:
        return directions
    near = 1.0 - np.abs(directions @ directions.T) < max(noise, RESOLVED) ** 2 / 2
    if noise < RESOLVED:
        one, other = np.nonzero(near)
        near[one, other] = np.linalg.norm(np.cross(directions[one], directions[other]), axis=1) < noise

    def same_sense(members) -> Directions:
        return directions[members] * np.where(directions[members] @ directions[members[0]] < 0, -1.0, 1.0)[:, None]

    def mean(members) -> np.ndarray:
        total = same_sense(members).sum(axis=0)
        return total / np.linalg.norm(total)

    found = clusters(near, lambda members: np.all(np.linalg.norm(same_sense(members) - mean(members), axis=1) <= noise))
    means = make_perpendicular(np.array([mean(members) for members in found]), noise)
    aligned = np.empty_like(directions)
    for members, direction in zip(found, means, strict=True):
        aligned[members] = np.where(directions[members] @ direction < 0, -1.0, 1.0)[:, None] * direction
    return aligned


def make_perpendicular(directions: Directions, noise: float) -> Directions:
    """Change unit vectors the least so that all pairs that are perpendicular within `noise` (radians) are exactly so.

    Newton's method on the dot products that should vanish, each step of least norm. Connected groups of directions in
    which one would move by more than `noise` stay as they are.
    """
    result = directions.copy()
    right = np.abs(directions @ directions.T) < noise
    for members in connected(right):
        pairs = [(i, j) for i in range(len(members)) for j in range(i) if right[members[i], members[j]]]
        moved = directions[members]
        for _ in range(3 if pairs else 0):  # quadratic: 1e-6, 1e-12, then rounding
            slopes = np.zeros((len(pairs), len(members), 3))
            for row, (i, j) in enumerate(pairs):
                slopes[row, i], slopes[row, j] = moved[j], moved[i]
            dots = np.array([moved[i] @ moved[j] for i, j in pairs])
            moved = moved - np.linalg.lstsq(slopes.reshape(len(pairs), -1), dots, rcond=None)[0].reshape(-1, 3)
            moved /= np.linalg.norm(moved, axis=1, keepdims=True)
        if np.all(np.linalg.norm(moved - directions[members], axis=1) <= noise):
            result[members] = moved
    return result
