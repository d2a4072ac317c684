"""Hobby servos that are drawn as one solid with their shaft, known by the sizes of their case and its two tabs."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane

_SIZES = {"micro": (22.8, 12.2, (3.9, 5.1)), "standard": (40.3, 20.0, (5.4, 6.3))}
"""Length and width of the case, and least and largest diameter of the shaft, millimetres: of those of 9 g, as SG90, and
of those with 25 teeth, as MG996R."""
SAME_CASE = 0.045
"""Difference of lengths and widths that is none, over the size: cases of different makers differ by as much."""
AT_END = 0.15
"""The shaft is as far from one end of the case as from its sides, but for this share of that distance."""


def servo_size(part: Part, shaft: Bore, bores: Sequence[Bore], millimetres: float) -> str | None:
    """Find the size of a servo by its shaft, near one end of its case, and holes along it in a tab at each end.

    `bores` are all of the part, and `millimetres` is the unit of lengths. None where it is no such servo.
    """
    reaches: list[tuple[Vector, float]] = []
    for face in part.faces:
        if isinstance(face.surface, Plane) and abs(face.surface.normal @ shaft.axis) < ACROSS:
            normal = face.surface.normal
            reaches.append((normal, millimetres * float((face.surface.point - shaft.point) @ normal)))
    holes = [bore for bore in bores if bore.hole and abs(bore.axis @ shaft.axis) > 1 - ACROSS]
    tabs = [millimetres * (hole.point - shaft.point) for hole in holes]
    for size, (length, width, (least, most)) in _SIZES.items():
        if not least <= 2 * millimetres * shaft.radius <= most:
            continue
        sides = [normal for normal, reach in reaches if abs(2 * reach / width - 1) <= SAME_CASE]
        for side in sides:
            if not any(side @ other < ACROSS - 1 for other in sides):
                continue
            for along in (np.cross(shaft.axis, side), np.cross(side, shaft.axis)):
                near, far = (
                    [reach for normal, reach in reaches if normal @ way > 1 - ACROSS] for way in (along, -along)
                )
                if any(_is_case(*ends, length, width) and _has_tabs(tabs, along, *ends) for ends in product(near, far)):
                    return size
    return None


def _is_case(near: float, far: float, length: float, width: float) -> bool:
    """Tell whether the ends of a case are where those of a servo are, as distances from its shaft."""
    return abs(2 * near / width - 1) <= AT_END and abs((near + far) / length - 1) <= SAME_CASE


def _has_tabs(holes: Sequence[Vector], along: Vector, near: float, far: float) -> bool:
    """Tell whether there are holes beyond both ends of a case, `near` along a direction and `far` against it."""
    return any(hole @ along > near for hole in holes) and any(hole @ along < -far for hole in holes)
