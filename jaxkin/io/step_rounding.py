"""How far rounding may have moved a solid of a STEP file: by the digits of its text, and by single precision."""

from __future__ import annotations

import re

import numpy as np

from jaxkin.geometry.pose import apply
from jaxkin.io.step_glb import Instance
from jaxkin.io.step_placements import SINGLE

_TRIPLES = re.compile(r"\b(?:CARTESIAN_POINT|DIRECTION)\s*\(\s*'[^']*'\s*,\s*\(([^()]*)\)")

_ALL_DIGITS = 15
"""Significant digits of float64, in which surfaces are computed."""

_MANY_DIGITS = 12
"""So many significant digits of one number show that numbers are written as they are."""

_FEW_DIGITS = 6
"""The fewest significant digits that files are rounded to; round dimensions mostly have less."""

_SMALL = 0.01
"""Small numbers over the largest one. They have as many digits as the largest ones in a file that rounds its numbers;
not so round dimensions far away, as in 1000015.1 beside 20. and 12.7."""

_FULL = 0.7
"""The least share, among small numbers of `_FEW_DIGITS` or more, of those with the most digits of all, where these are
what the file rounds to: there one in ten ends in a zero, which is not written."""

_ENOUGH = 10
"""So many such numbers are needed to tell."""


def text_rounding(text: str) -> float:
    """Find the rounding of the coordinates in the text of a STEP file, relative, from how many digits it writes."""
    digits: dict[float, int] = {}
    for found in _TRIPLES.finditer(text):
        for number in found[1].split(","):
            mantissa = number.strip().upper().partition("E")[0]
            count = len(mantissa.lstrip("+-").replace(".", "").strip("0"))
            if count >= _MANY_DIGITS:
                return 0.5 * 10.0 ** (1 - _ALL_DIGITS)
            if count:
                try:
                    digits[abs(float(number))] = count
                except ValueError:  # points without end
                    continue
    most, largest = max(digits.values(), default=0), max(digits, default=0.0)
    long = [count for number, count in digits.items() if number <= _SMALL * largest and count >= _FEW_DIGITS]
    rounded = len(long) >= _ENOUGH and long.count(most) >= _FULL * len(long)
    return 0.5 * 10.0 ** (1 - (most if rounded else _ALL_DIGITS))


def place_rounding(instance: Instance, relative: float) -> float:
    """Bound how far rounding may have moved the surfaces of an instance, in metres.

    `relative` is the rounding of the numbers of the file. What is not placed is in the coordinates of the file, exactly
    as these are; placements that are not found in its text are in single precision.
    """
    points = instance.mesh.outline
    error = relative * _reach(points)
    for pose, rounding in reversed(instance.places):
        turned = not np.isin(pose[:3, :3], (-1.0, 0.0, 1.0)).all()
        lever = np.linalg.norm(pose[:3, 3]) + (np.sqrt(3) * _reach(points) if turned else 0.0)
        error += (rounding + relative) * float(lever)
        points = apply(pose, points)
    return error


def corner_rounding(instance: Instance) -> float:
    """Bound how far single precision may have moved the corners of the triangles from the surfaces, in metres."""
    return SINGLE * _reach(instance.mesh.outline)


def _reach(points: np.ndarray) -> float:
    return float(np.linalg.norm(points, axis=-1).max())
