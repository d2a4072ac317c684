"""Report parts that touch only along an edge or at a corner, such as a box on its edge: none of the sixteen states."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.boxes import Boxes, boxes_of, crossing
from jaxkin.contacts.overlap import Solid
from jaxkin.geometry.part import Part

TINY = np.finfo(float).tiny
"""Smallest denominator: avoids 0 / 0 for degenerate triangles, which tessellations contain."""

_PARALLEL_SQUARE = 1e-12
"""Squared sine of the angle between two edges up to which they count as parallel; then a corner is as near."""


def edge_note(one: Part, two: Part, tolerance: float) -> str | None:
    """Name the nearest faces of two parts without a contact in a message, if they touch; None if the parts are apart.

    Faces count as touching where their triangles are no farther apart than `tolerance` (a length) and the lengths by
    which the true surfaces bulge over the triangles.
    """
    (triangles1, face1, bulge1), (triangles2, face2, bulge2) = (_all_triangles(part) for part in (one, two))
    pairs = crossing(_inflated(triangles1, bulge1), _inflated(triangles2, bulge2), tolerance)
    if not len(pairs):
        return None
    i, j = pairs.T
    beyond = distances(triangles1[i], triangles2[j]) - bulge1[i] - bulge2[j]
    nearest = int(np.argmin(beyond))
    if beyond[nearest] > tolerance:
        return None
    names = f"{one.name} {one.faces[face1[i[nearest]]].name} and {two.name} {two.faces[face2[j[nearest]]].name}"
    return f"{names} meet at an edge or a corner only: none of the sixteen contact states, so no joint"


def distances(a: Solid, b: Solid) -> Float[np.ndarray, "_"]:
    """Compute the distance between the two triangles of each pair (pairs,), from `a` and `b` (pairs, 3, 3).

    It is the least distance of a corner from the other triangle, or of two crossing edges; so it is not zero for
    triangles that pierce each other.
    """
    return np.min([_corners_to(a, b), _corners_to(b, a), _crossing_edges(a, b)], axis=0)


def _corners_to(a: Solid, b: Solid) -> np.ndarray:
    """Compute the distance of the nearest corner of `a` from the triangle `b`, pair by pair."""
    edges = np.roll(b, -1, axis=1) - b
    offset = a[:, :, None] - b[:, None]  # pair, corner of a, edge of b
    along = np.sum(offset * edges[:, None], axis=-1) / np.maximum(np.sum(edges**2, axis=-1), TINY)[:, None]
    to_edges = np.linalg.norm(offset - along.clip(0, 1)[..., None] * edges[:, None], axis=-1).min(axis=-1)
    normal = np.cross(edges[:, 0], edges[:, 1])[:, None]
    over = np.all(np.sum(np.cross(edges[:, None], offset) * normal[:, None], axis=-1) > 0, axis=-1)
    height = np.abs(np.sum(offset[:, :, 0] * normal, axis=-1)) / np.maximum(np.linalg.norm(normal, axis=-1), TINY)
    return np.where(over, height, to_edges).min(axis=-1)


def _crossing_edges(a: Solid, b: Solid) -> np.ndarray:
    """Compute the least distance of an edge of `a` and an edge of `b` that cross each other, seen along their common
    normal, pair by pair; infinity where none do."""
    u, v = (np.roll(a, -1, axis=1) - a)[:, :, None], (np.roll(b, -1, axis=1) - b)[:, None]
    w = a[:, :, None] - b[:, None]
    uu, uv, vv, uw, vw = (np.sum(x * y, axis=-1) for x, y in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    square = uu * vv - uv**2
    parallel = square <= _PARALLEL_SQUARE * uu * vv
    square = np.where(parallel, 1.0, square)
    s, t = (uv * vw - vv * uw) / square, (uu * vw - uv * uw) / square
    within = ~parallel & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    apart = np.linalg.norm(w + s[..., None] * u - t[..., None] * v, axis=-1)
    return np.where(within, apart, np.inf).min(axis=(1, 2))


def _all_triangles(part: Part) -> tuple[Solid, np.ndarray, np.ndarray]:
    """List the triangles of all faces with, for each, the index of its face and the bulge of that face (a length)."""
    numbers = np.repeat(np.arange(len(part.faces)), [len(face.triangles) for face in part.faces])
    bulges = np.array([face.bulge for face in part.faces])
    return np.concatenate([face.triangles for face in part.faces]), numbers, bulges[numbers]


def _inflated(triangles: Solid, by: np.ndarray) -> Boxes:
    """Compute the bounding box of each triangle, enlarged on all sides by a length of its own."""
    return boxes_of(triangles) + by[:, None, None] * np.array([[-1.0], [1.0]])
