"""Motors that are drawn as one solid with their shaft, known by their names: a hint, where no size tells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore
from jaxkin.assembly.inference.part_names import words_of
from jaxkin.geometry.part import Part

_ENDINGS = ("motor", "motors", "moteur", "motore", "servo", "stepper", "motoreductor", "motorreductor")
"""How words for motors end, in English, German, Spanish, Portuguese, Polish, Czech, French and Italian."""
MIN_CASE = 2.5
"""Farthest a motor reaches from its shaft, over the radius of that, at least."""


def is_named_motor(name: str) -> bool:
    """Tell whether the name of a part says that it is a motor, and not something of one."""
    words = words_of(name)
    return bool(words) and words[-1].endswith(_ENDINGS)


def is_shaft_of_case(part: Part, pin: Bore, pins: Sequence[Bore]) -> bool:
    """Tell whether a pin may be the shaft of a motor: the thinnest one on its axis, longer than its radius, that ends
    where the part does and comes out of something far wider."""
    axis = pin.axis
    heights, slack = part.outermost @ axis, SAME_LENGTH * pin.radius
    low, high = np.sort(pin.reach(axis))
    at_end = heights.max() - high <= slack or low - heights.min() <= slack
    away = np.linalg.norm(np.cross(part.outermost - pin.point, axis), axis=1).max()
    thinnest = all(pin.radius <= other.radius + slack for other in pins if other.on_axis_of(pin))
    return bool(at_end and thinnest and high - low > pin.radius and away >= MIN_CASE * pin.radius)
