"""Stepper motors that are drawn as one solid with their shaft, known by the sizes of flange, pilot and shaft."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.part import Part
from jaxkin.geometry.surfaces import Plane

_SIZES = {
    8: (20.3, (15.0, 16.0), (4.0,)),
    11: (28.2, (22.0,), (5.0,)),
    14: (35.2, (22.0,), (5.0,)),
    17: (42.3, (22.0,), (5.0,)),
    23: (56.8, (38.1,), (6.35, 8.0)),
    34: (86.0, (73.0,), (12.7, 14.0)),
}
"""Side of the square flange, diameters of the pilot and of the shaft, millimetres, by the sizes of NEMA ICS 16."""
SAME_FLANGE, SAME_PILOT, SAME_SHAFT = 0.04, 0.03, 0.02
"""Differences of these sizes that are none, over the size: people draw the flange of size 17 as 41 to 43."""


def stepper_size(part: Part, shaft: Bore, pins: Sequence[Bore], millimetres: float) -> int | None:
    """Find the size of NEMA of a stepper motor by its square flange, and the pilot and the shaft in its middle.

    `pins` are all of the part, and `millimetres` is the unit of lengths. None where it is no such motor.
    """
    pilots = [bore for bore in pins if bore.radius > shaft.radius and bore.on_axis_of(shaft)]
    for size, (flange, wide, narrow) in _SIZES.items():
        if (
            _is_one_of(2 * millimetres * shaft.radius, narrow, SAME_SHAFT)
            and any(_is_one_of(2 * millimetres * pilot.radius, wide, SAME_PILOT) for pilot in pilots)
            and _is_square(part, shaft, flange / millimetres)
        ):
            return size
    return None


def _is_one_of(found: float, sizes: tuple[float, ...], slack: float) -> bool:
    return any(abs(found / size - 1) <= slack for size in sizes)


def _is_square(part: Part, shaft: Bore, side: float) -> bool:
    """Tell whether a part has four sides about its shaft, half of `side` away from it, across each other."""
    planes = [face.surface for face in part.faces if isinstance(face.surface, Plane)]
    sides = [
        plane.normal
        for plane in planes
        if abs(plane.normal @ shaft.axis) < ACROSS
        and abs(2 * float((plane.point - shaft.point) @ plane.normal) / side - 1) <= SAME_FLANGE
    ]
    if not sides:
        return False
    turned = np.cross(shaft.axis, sides[0])
    return all(any(each @ way > 1 - ACROSS for each in sides) for way in (sides[0], -sides[0], turned, -turned))
