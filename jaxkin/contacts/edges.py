"""Parts that touch along an edge or at a corner, in none of the sixteen states: a box on its edge, a pin on its rim."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.boxes import Boxes, boxes_of, bulge, crossing
from jaxkin.contacts.overlap import Solid
from jaxkin.geometry.part import Part


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
    """Distances between pairs of triangles, by corners over faces and edges over edges; triangles that pierce each
    other count by the nearest of these."""
    from trimesh.triangles import closest_point

    found = []
    for triangles, others in ((a, b), (b, a)):
        for corner in range(3):
            points = others[:, corner]
            found.append(np.linalg.norm(closest_point(triangles, points) - points, axis=-1))
    for k in range(3):
        for m in range(3):
            found.append(_segment_distances(a[:, k], a[:, (k + 1) % 3], b[:, m], b[:, (m + 1) % 3]))
    return np.min(found, axis=0)


def _segment_distances(p: np.ndarray, p_end: np.ndarray, q: np.ndarray, q_end: np.ndarray) -> np.ndarray:
    """Where the lines are nearest within both segments; ends over faces are covered by the corners."""
    u, v, w = p_end - p, q_end - q, p - q
    uu, uv, vv, uw, vw = (np.sum(x * y, axis=-1) for x, y in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    square = uu * vv - uv**2
    flat = square <= 1e-12 * uu * vv
    square = np.where(flat, 1.0, square)
    s, t = (uv * vw - vv * uw) / square, (uu * vw - uv * uw) / square
    inside = ~flat & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    return np.where(inside, np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=-1), np.inf)


def _all_triangles(part: Part) -> tuple[Solid, np.ndarray, np.ndarray]:
    """The triangles of all analytic faces, and for each the number of its face and how far that bulges."""
    numbers = np.repeat(np.arange(len(part.faces)), [len(face.triangles) for face in part.faces])
    bulges = np.array([bulge(face) for face in part.faces])
    return np.concatenate([face.triangles for face in part.faces]), numbers, bulges[numbers]


def _inflated(triangles: Solid, by: np.ndarray) -> Boxes:
    return boxes_of(triangles) + by[:, None, None] * np.array([[-1.0], [1.0]])
