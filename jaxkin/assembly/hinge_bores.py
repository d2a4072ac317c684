"""The pins and holes that an inferred hinge is made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore
from jaxkin.joints.joint import Joint


def holes_of(hinge: Joint, bores: Mapping[str, Sequence[Bore]]) -> list[Bore]:
    """List the holes of the two parts of a hinge that have its axis and its radius; empty without known sizes."""
    sizes = dict(hinge.evidence.sizes) if hinge.evidence else {}
    radius = sizes.get("radius", 0.0)
    return [each for each in _on_axis(hinge, bores, radius, sizes.get("offset", 0.0)) if each.hole]


def pins_of(hinge: Joint, bores: Mapping[str, Sequence[Bore]]) -> list[Bore]:
    """List the pins of the two parts of a hinge that have its axis and its radius, less the clearance."""
    sizes = dict(hinge.evidence.sizes) if hinge.evidence else {}
    radius = sizes.get("radius", 0.0) - sizes.get("clearance", 0.0)
    return [each for each in _on_axis(hinge, bores, radius, sizes.get("offset", 0.0)) if not each.hole]


def _on_axis(hinge: Joint, bores: Mapping[str, Sequence[Bore]], radius: float, offset: float) -> list[Bore]:
    pose = np.asarray(hinge.frames_1, float)[0]
    found = []
    for bore in (bore for part in hinge.parts for bore in bores.get(part, ()) if radius > 0):
        away = float(np.linalg.norm(np.cross(bore.point - pose[:3, 3], pose[:3, 2])))
        if abs(bore.radius - radius) <= SAME_LENGTH * radius and away <= offset + SAME_LENGTH * radius:
            found.append(bore)
    return found
