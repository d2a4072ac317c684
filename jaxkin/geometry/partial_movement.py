"""Find the movement that is left of a movement in which some coordinates rest, as in loops that keep to a plane."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from jaxkin.geometry.movements import MOVEMENTS


def remaining(name: str, kept: Collection[int]) -> str | None:
    """Look up the key of the movement that is left of a movement in which all but the coordinates `kept` rest.

    None where no movement has just these elementary motions.
    """
    if len(kept) == len(MOVEMENTS[name].coordinates):
        return name
    numbers = {coordinate: number for number, coordinate in enumerate(sorted(kept))}
    left = tuple(
        replace(element, coordinate=numbers[element.coordinate])
        for element in MOVEMENTS[name].elements
        if element.coordinate in numbers
    )
    return next((other for other, movement in MOVEMENTS.items() if movement.elements == left), None)
