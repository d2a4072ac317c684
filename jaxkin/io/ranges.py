"""Ranges of displacements as people write them: "0:360:361", "0,10,25"; degrees where they do not say otherwise."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import METRES

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

RangeValues = Float[np.ndarray, " poses"]

FORM = "START:STOP:COUNT, as in 0:360:361, or VALUE,VALUE,..."
"""What a range looks like."""
MAX_POSES = 10_000_000
"""Poses of a range at most: a slip of the finger must not fill the memory."""
RADIANS = {"deg": np.pi / 180, "rad": 1.0, "turn": 2 * np.pi}


class Range(NamedTuple):
    """Displacements of one joint coordinate, as they were written."""

    values: RangeValues
    unit: str = ""
    """A key of `RADIANS` or `METRES`; empty for degrees, or for the unit of the mechanism."""


def read_range(text: str) -> RangeValues:
    """Read the displacements of a text "START:STOP:COUNT", ends included, or "VALUE,VALUE,..."; ValueError
    otherwise."""
    ranged = ":" in text
    try:
        if ranged:
            start, stop, last = text.split(":")
            numbers, count = [float(start), float(stop)], int(last)
        else:
            numbers = [float(value) for value in text.split(",")]
            count = len(numbers)
    except ValueError:
        raise ValueError(f"cannot read {text!r} as a range; write {FORM}") from None
    if not np.all(np.isfinite(numbers)):
        raise ValueError(f"displacements must be finite numbers, got {text!r}; write {FORM}")
    if not 1 <= count <= MAX_POSES:
        raise ValueError(f"COUNT must be a number from 1 to {MAX_POSES}, got {count}; write {FORM}")
    if ranged and count == 1 and numbers[0] != numbers[1]:
        raise ValueError(
            f"one pose cannot include both ends of {text!r}; write {numbers[0]:g}, or a COUNT of 2 or more"
        )
    return np.linspace(numbers[0], numbers[1], count) if ranged else np.array(numbers)


def in_radians(mechanism: Mechanism, ranges: Mapping[str, Range]) -> dict[str, RangeValues]:
    """Make the drive for `sweep`, by the full names of its coordinates: radians, and lengths in the unit of the
    mechanism.

    Raises ValueError for names that do not exist, for a unit of length on an angle, and the other way round.
    """
    from jaxkin.linkage.coordinates import resolve

    for key, given in ranges.items():
        wrong = np.flatnonzero(~np.isfinite(given.values))
        if len(wrong):
            raise ValueError(
                f"drive {key!r}: pose {wrong[0]} is {given.values[wrong[0]]}; all displacements must be finite numbers"
            )
    names = resolve(mechanism.linkage, {name: given.values for name, given in ranges.items()})
    return {
        name: given.values * _factor(key, name, given.unit, mechanism.unit)
        for name, (key, given) in zip(names, ranges.items(), strict=True)
    }


def _factor(key: str, name: str, unit: str, unit_of_lengths: str) -> float:
    lengths = is_length(name.rpartition(".")[2])
    if not unit or (unit == unit_of_lengths and lengths):
        return 1.0 if lengths else RADIANS["deg"]
    if lengths and unit in METRES and unit_of_lengths:
        return METRES[unit] / METRES[unit_of_lengths]
    if not lengths and unit in RADIANS:
        return RADIANS[unit]
    known = list(filter(None, METRES) if unit_of_lengths else []) if lengths else RADIANS
    why = f"{name!r} is {'a length' if lengths else 'an angle'}"
    instead = f"write one of {', '.join(known)}" if known else "leave the unit out, the mechanism was given none"
    raise ValueError(f"drive {key!r}: the unit is {unit!r}, but {why}; {instead}")
