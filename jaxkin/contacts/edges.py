"""Parts that touch along an edge or at a corner, in none of the sixteen states: a box on its edge, a pin on its rim."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.boxes import Boxes, boxes_of, bulge, crossing
from jaxkin.contacts.overlap import Solid
from jaxkin.geometry.part import Part

TINY = np.finfo(float).tiny
"""Under the line where degenerate triangles, which tessellations hold, would put zero."""


def edge_note(one: Part, two: Part, tolerance: float) -> str | None:
    """Which faces of two parts without a contact touch nevertheless, in words; None if they are apart.

    Faces count as touching within the tolerance, a length, and within the height of the chords that stand for them.
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
    """Distances between pairs of triangles, by corners over faces and edges over edges.

    Triangles that pierce each other count by the nearest of these.
    """
    return np.min([_corners_to(a, b), _corners_to(b, a), _crossing_edges(a, b)], axis=0)


def _corners_to(a: Solid, b: Solid) -> np.ndarray:
    """From the nearest corner of the first triangle to the second."""
    edges = np.roll(b, -1, axis=1) - b
    offset = a[:, :, None] - b[:, None]  # pair, corner of a, edge of b
    along = np.sum(offset * edges[:, None], axis=-1) / np.maximum(np.sum(edges**2, axis=-1), TINY)[:, None]
    to_edges = np.linalg.norm(offset - along.clip(0, 1)[..., None] * edges[:, None], axis=-1).min(axis=-1)
    normal = np.cross(edges[:, 0], edges[:, 1])[:, None]
    over = np.all(np.sum(np.cross(edges[:, None], offset) * normal[:, None], axis=-1) > 0, axis=-1)
    height = np.abs(np.sum(offset[:, :, 0] * normal, axis=-1)) / np.maximum(np.linalg.norm(normal, axis=-1), TINY)
    return np.where(over, height, to_edges).min(axis=-1)


def _crossing_edges(a: Solid, b: Solid) -> np.ndarray:
    """Between the edges that cross each other; infinity where none do."""
    u, v = (np.roll(a, -1, axis=1) - a)[:, :, None], (np.roll(b, -1, axis=1) - b)[:, None]
    w = a[:, :, None] - b[:, None]
    uu, uv, vv, uw, vw = (np.sum(x * y, axis=-1) for x, y in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    square = uu * vv - uv**2
    parallel = square <= 1e-12 * uu * vv  # then a corner is as near
    square = np.where(parallel, 1.0, square)
    s, t = (uv * vw - vv * uw) / square, (uu * vw - uv * uw) / square
    within = ~parallel & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    apart = np.linalg.norm(w + s[..., None] * u - t[..., None] * v, axis=-1)
    return np.where(within, apart, np.inf).min(axis=(1, 2))


def _all_triangles(part: Part) -> tuple[Solid, np.ndarray, np.ndarray]:
    """The triangles of all analytic faces, and for each the number of its face and how far that bulges."""
    numbers = np.repeat(np.arange(len(part.faces)), [len(face.triangles) for face in part.faces])
    bulges = np.array([bulge(face) for face in part.faces])
    return np.concatenate([face.triangles for face in part.faces]), numbers, bulges[numbers]


def _inflated(triangles: Solid, by: np.ndarray) -> Boxes:
    return boxes_of(triangles) + by[:, None, None] * np.array([[-1.0], [1.0]])
