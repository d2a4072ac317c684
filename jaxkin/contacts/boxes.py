"""Broad phase: which axis-aligned boxes overlap, by sorting along one axis and sweeping."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.part import Face

Boxes = Float[np.ndarray, "_ 2 d"]
Pairs = Int[np.ndarray, "_ 2"]


def overlapping(boxes: Boxes, margin: float) -> Pairs:
    """Pairs `i < j` of boxes (lowest and highest corner) no farther apart than `margin` along each axis, in order.

    The sweep goes along the axis in which the boxes are spread most for their size, so that few meet there.
    """
    if len(boxes) < 2:
        return np.zeros((0, 2), int)
    lows, highs = boxes[:, 0], boxes[:, 1] + margin
    spread = np.ptp(lows + highs, axis=0) / np.maximum((highs - lows).mean(axis=0), np.finfo(float).tiny)
    axis = int(np.argmax(spread))
    order = np.argsort(lows[:, axis], kind="stable")
    until = np.searchsorted(lows[order, axis], highs[order, axis], side="right")
    counts = until - np.arange(len(order)) - 1
    first = np.repeat(np.arange(len(order)), counts)
    second = first + 1 + np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    pairs = np.sort(np.stack([order[first], order[second]], axis=-1), axis=-1)
    i, j = pairs.T
    pairs = pairs[np.all((lows[i] <= highs[j]) & (lows[j] <= highs[i]), axis=-1)]
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


def crossing(boxes1: Boxes, boxes2: Boxes, margin: float) -> Pairs:
    """Pairs (i, j) of a box of the first set and one of the second no farther apart than `margin`, in order.

    Compares all with all: meant for the faces of two parts and the triangles of two faces, cut down beforehand to
    those that reach the other set.
    """
    inside1 = np.flatnonzero(_reaches(boxes1, boxes2, margin))
    inside2 = np.flatnonzero(_reaches(boxes2, boxes1, margin))
    rows = max(1, 4_000_000 // max(1, len(inside2)))  # bounds the memory of the comparison
    found = [np.zeros((0, 2), int)]
    for start in range(0, len(inside1), rows):
        some = inside1[start : start + rows]
        a, b = boxes1[some][:, None], boxes2[inside2][None]
        meet = np.all((a[:, :, 0] <= b[:, :, 1] + margin) & (b[:, :, 0] <= a[:, :, 1] + margin), axis=-1)
        i, j = np.nonzero(meet)
        found.append(np.stack([some[i], inside2[j]], axis=-1))
    return np.concatenate(found)


def face_box(face: Face) -> Float[np.ndarray, "2 3"]:
    """The box of a face with the bulge of its surface over the triangles."""
    height = bulge(face)
    return face.box + np.array([[-height], [height]])


def bulge(face: Face) -> float:
    """How far the surface of a face rises over its triangles."""
    corners = face.triangles
    middles = np.concatenate([(corners + np.roll(corners, 1, axis=1)) / 2, corners.mean(axis=1, keepdims=True)], axis=1)
    return float(np.abs(face.surface.distance(middles.reshape(-1, 3))).max())


def boxes_of(triangles: Float[np.ndarray, "triangles 3 d"]) -> Float[np.ndarray, "triangles 2 d"]:
    """The bounding box of each triangle."""
    return np.stack([triangles.min(axis=1), triangles.max(axis=1)], axis=1)


def _reaches(boxes: Boxes, others: Boxes, margin: float) -> np.ndarray:
    """Which boxes come within `margin` of the box around all others."""
    if not len(others):
        return np.zeros(len(boxes), bool)
    low, high = others[:, 0].min(axis=0) - margin, others[:, 1].max(axis=0) + margin
    return np.all((boxes[:, 0] <= high) & (boxes[:, 1] >= low), axis=-1)
