"""Find tolerances with which a near miss would be a contact: rounded up to few digits, and tried before advised."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from jaxkin.contacts.region import ContactRegion
from jaxkin.contacts.tolerance import ContactTolerance, reach, smaller_radius
from jaxkin.contacts.touch import Touch
from jaxkin.geometry.surfaces import Surface

DIGITS = 2
"""Number of significant digits of an advised tolerance.

Two digits round it up by a tenth at most, which makes hardly any other pair of faces touch."""
_MORE = (1.0, 1.1, 1.3, 1.6, 2.0)
"""Factors by which the tolerance that a near miss seems to need is enlarged, in turn, until it works.

The measured value may not do, since the region that the faces share also depends on the tolerance."""
_PRINTED = 6
"""Number of significant digits with which an advised tolerance is written."""
_CLOSE = 9
"""Largest number of significant digits that `told_apart` writes; beyond them numbers differ by rounding only."""

ToleranceChoices = dict[str, float]
"""Values by the names of arguments of `Assembly.contacts`."""


def remedy(
    touch: Touch,
    region: ContactRegion,
    tolerance: ContactTolerance,
    surfaces: tuple[Surface, Surface],
    works: Callable[[ContactTolerance], bool],
) -> ToleranceChoices:
    """Find the tolerances that make a near miss a contact, as few as possible; empty if no acceptable ones do.

    `works` checks whether given tolerances make the faces a contact.
    """
    if touch.tilt > tolerance.angle or not region.inside:
        return {}
    for options in _candidates(touch, region, tolerance, surfaces):
        if works(replace(tolerance, **options)):
            return options
    return {}


def _candidates(
    touch: Touch, region: ContactRegion, tolerance: ContactTolerance, surfaces: tuple[Surface, Surface]
) -> Iterator[ToleranceChoices]:
    """Yield tolerances that may make the touch a contact: first a larger `fit` alone, then a larger `length` too."""
    radius, clearance = smaller_radius(*surfaces), touch.clearance
    fits: list[ToleranceChoices] = [{}]
    if clearance is not None and clearance > max(tolerance.length, tolerance.fit * radius):
        fits = [{"fit": value} for more in _MORE if (value := rounded_up(more * clearance / radius)) > tolerance.fit]
    yield from filter(None, fits)
    needed = reach(touch, region.extent) - max(0.0, clearance or 0.0)
    for more in _MORE if needed > 0 else ():
        # as many digits as are printed where two are more than is accepted
        for length in (rounded_up(more * needed), rounded_up(more * needed, _PRINTED)):
            if tolerance.length < length <= tolerance.near_length:
                yield {**fits[0], "length": length}
                break


def rounded_up(value: float, digits: int = DIGITS) -> float:
    """Round a positive number up to a number of significant digits."""
    step = 10.0 ** (np.floor(np.log10(value)) + 1 - digits)
    up = float(f"{np.ceil(value / step * (1 - 1e-12)) * step:.{digits}g}")
    return up if up >= value else float(f"{up + step:.{digits}g}")


def told_apart(more: float, less: float) -> tuple[str, str]:
    """Write two numbers with as many digits as make them look different: 3 to `_CLOSE`."""
    texts = [(f"{more:.{digits}g}", f"{less:.{digits}g}") for digits in range(3, _CLOSE + 1)]
    return next((pair for pair in texts if pair[0] != pair[1]), texts[-1])
