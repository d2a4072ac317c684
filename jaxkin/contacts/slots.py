"""Find the pins that stand with play in slots: a cylinder between two walls that face each other."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from jaxkin.contacts.boxes import Boxes, crossing
from jaxkin.contacts.tolerance import NEAR_SLOT, NEAR_TILT
from jaxkin.geometry.part import Part
from jaxkin.geometry.surfaces import Cylinder, Plane

Slot = tuple[int, int, int]
"""Indices of the face of a pin, and of two walls on either side of it."""


def pins_in_slots(one: Part, other: Part, boxes1: Boxes, boxes2: Boxes) -> Iterator[Slot]:
    """Yield the pins of one part that stand between two walls of another one, no farther from each than `NEAR_SLOT`.

    `boxes1` and `boxes2` are the boxes around the faces of the two parts. Whether a pin and a wall share a region is
    left to the examination of the two faces.
    """
    cylinders = [(k, face.surface) for k, face in enumerate(one.faces) if isinstance(face.surface, Cylinder)]
    pins = [(k, surface) for k, surface in cylinders if surface.side > 0]
    walls = [(k, face.surface) for k, face in enumerate(other.faces) if isinstance(face.surface, Plane)]
    if not pins or len(walls) < 2:
        return
    radii = np.array([pin.radius for _, pin in pins])
    around = boxes1[[k for k, _ in pins]] + NEAR_SLOT * radii[:, None, None] * np.array([[-1.0], [1.0]])
    near = crossing(around, boxes2[[k for k, _ in walls]], 0.0)
    points, axes = (np.stack([getattr(pin, name) for _, pin in pins])[near[:, 0]] for name in ("point", "axis"))
    at, normals = (np.stack([getattr(wall, name) for _, wall in walls])[near[:, 1]] for name in ("point", "normal"))
    middles = around.mean(axis=1)[near[:, 0]]
    centres = points + np.sum((middles - points) * axes, axis=-1, keepdims=True) * axes
    gaps = np.sum((centres - at) * normals, axis=-1) - radii[near[:, 0]]
    beside = (
        (np.abs(np.sum(axes * normals, axis=-1)) <= NEAR_TILT) & (gaps > 0) & (gaps <= NEAR_SLOT * radii[near[:, 0]])
    )
    rows = np.flatnonzero(beside)
    for pin in np.unique(near[rows, 0]).tolist():
        for i, j in combinations(rows[near[rows, 0] == pin].tolist(), 2):
            if normals[i] @ normals[j] < -np.cos(NEAR_TILT):
                yield pins[pin][0], walls[near[i, 1]][0], walls[near[j, 1]][0]
