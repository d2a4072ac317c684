"""Parts that touch along an edge or at a corner, in none of the sixteen states: a box on its edge, a pin on its rim."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.boxes import boxes_of, bulge, crossing
from jaxkin.contacts.overlap import Solid
from jaxkin.geometry.part import Part


def edge_note(one: Part, two: Part, tolerance: float) -> str | None:
    """Which faces of two parts without a contact touch nevertheless, in words; None if they are apart.

    Faces count as touching within the tolerance, a length, and within the height of the chords that stand for them.
    """
    sides = [_all_triangles(part) for part in (one, two)]
    bulges = [np.array([bulge(face) for face in part.faces]) for part in (one, two)]
    pairs = crossing(boxes_of(sides[0][0]), boxes_of(sides[1][0]), tolerance + bulges[0].max() + bulges[1].max())
    if not len(pairs):
        return None
    i, j = pairs.T
    apart = distances(sides[0][0][i], sides[1][0][j])
    face1, face2 = sides[0][1][i], sides[1][1][j]
    beyond = apart - bulges[0][face1] - bulges[1][face2]
    nearest = int(np.argmin(beyond))
    if beyond[nearest] > tolerance:
        return None
    names = f"{one.name} {one.faces[face1[nearest]].name} and {two.name} {two.faces[face2[nearest]].name}"
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


def _all_triangles(part: Part) -> tuple[Solid, np.ndarray]:
    """The triangles of all analytic faces and the number of the face of each."""
    numbers = np.repeat(np.arange(len(part.faces)), [len(face.triangles) for face in part.faces])
    return np.concatenate([face.triangles for face in part.faces]), numbers
