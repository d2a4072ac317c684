"""Faces of OBJ as trimesh reads them right; for the program of `mesh_worker.py`, and it imports nothing of jaxkin."""

import re

import numpy as np

TURN = 1e-12
"""Twice the area of three corners over that of the face, from which on they are no line."""


def plain_faces(text: bytes) -> bytes:
    """Write faces by the numbers of their corners in the file, and those that are not convex as triangles.

    trimesh counts corners like -1, which are counted back from the face, from the end of the file, and makes a fan of
    every face, which leaves one that is not convex. Texts with neither are returned as they are.
    """
    back = re.search(rb"^[ \t]*f\b[^\r\n]*\s-\d", text, re.M)
    if not back and not re.search(rb"^[ \t]*f(?:[ \t]+[\d/]+){4}", text, re.M):
        return text
    points: list[list[float]] = []
    lines: list[bytes] = []
    for line in re.sub(rb"\\\r?\n", b" ", text).splitlines():
        kind, *words = line.split() or [b""]
        if kind == b"v":
            points.append([float(word) for word in words[:3]])
        if kind != b"f":
            lines.append(line)
            continue
        found = [int(word.partition(b"/")[0]) for word in words if word[:1] != b"#"]
        face = [number + len(points) + 1 if number < 0 else number for number in found]
        known = len(face) > 3 and 0 < min(face) <= max(face) <= len(points)
        for rows in triangles(np.array([points[k - 1] for k in face])) if known else [range(len(face))]:
            lines.append(b"f " + b" ".join(b"%d" % face[k] for k in rows))
    return b"\n".join(lines) + b"\n"


def triangles(corners: np.ndarray) -> list[list[int]]:
    """Divide a flat face, its corners (n, 3) in order, into triangles by cutting off its ears (Meisters 1975); a convex
    one stays whole. Faces with bridges to their holes pass some corners twice."""
    corners = corners - corners.mean(axis=0)  # of faces far from the origin products would be rounded
    normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)  # Newell: twice the area
    keep = np.argsort(np.abs(normal))[:2]
    flat = corners[:, np.sort(keep)]
    flat = flat / (np.abs(np.ptp(flat, axis=0)).max() or 1.0)
    flat = flat if _area(flat) >= 0 else flat * [1.0, -1.0]
    least = TURN * max(_area(flat), TURN)
    left = list(range(len(flat)))
    if all(_turn(flat, left, k) >= -least for k in range(len(left))):
        return [left]
    found = []
    while len(left) > 3:
        ears = (k for k in range(len(left)) if _turn(flat, left, k) > least and _is_free(flat, left, k, least))
        k = next(ears, None)
        if k is None:  # corners on a line, or a face that crosses itself, which is told where the solid is
            k = max(range(len(left)), key=lambda at: _turn(flat, left, at))
        found.append([left[k - 1], left[k], left[(k + 1) % len(left)]])
        del left[k]
    return [*found, left]


def _area(flat: np.ndarray) -> float:
    x, y = flat.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _cross(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Compute twice the areas of triangles, positive where `c` is to the left of the way from `a` to `b`."""
    return (b[0] - a[0]) * (c[..., 1] - a[1]) - (b[1] - a[1]) * (c[..., 0] - a[0])


def _turn(flat: np.ndarray, left: list[int], k: int) -> float:
    return float(_cross(flat[left[k - 1]], flat[left[k]], flat[left[(k + 1) % len(left)]]))


def _is_free(flat: np.ndarray, left: list[int], k: int, least: float) -> bool:
    """Tell whether no other corner is in the triangle at a corner, but those in the place of one of its corners."""
    a, b, c = (flat[left[at % len(left)]] for at in (k - 1, k, k + 1))
    others = flat[left]
    apart = np.min([np.abs(others - corner).max(axis=1) for corner in (a, b, c)], axis=0) > TURN
    inside = np.min([_cross(a, b, others), _cross(b, c, others), _cross(c, a, others)], axis=0) >= -least
    return not bool((apart & inside).any())
