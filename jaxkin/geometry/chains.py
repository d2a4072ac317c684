"""Number the coordinates of a chain of movements, those of one movement after those of another."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import accumulate, pairwise

from jaxkin.geometry.movements import MOVEMENTS


def coordinate_ranges(movements: Iterable[str]) -> list[range]:
    """List for each movement of a chain, given by their keys, the numbers of its coordinates in the chain."""
    counts = (len(MOVEMENTS[movement].coordinates) for movement in movements)
    return [range(first, end) for first, end in pairwise(accumulate(counts, initial=0))]
