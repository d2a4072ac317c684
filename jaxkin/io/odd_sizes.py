"""Parts of quite another size than all others: often drawn, or exported, in another unit."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from jaxkin.geometry.part import Part

_JUMP = 100.0
"""Ratio of the sizes of two parts, next to each other by size, from which on it is told. Between a millimetre and a
metre it is 1000, less the range of the parts themselves; machines with a screw and a bed have parts of every size
between."""


def with_odd_sizes_noted(parts: tuple[Part, ...]) -> tuple[Part, ...]:
    """Note parts that are far larger, or far smaller, than all others; the fewer ones are told, of as many the large.

    An inch is 25.4 mm: between parts of all sizes that is no sign of another unit, and is not told.
    """
    sized = sorted((part for part in parts if part.extent > 0), key=lambda part: part.extent)
    ratios = [larger.extent / smaller.extent for smaller, larger in pairwise(sized)]
    if max(ratios, default=1.0) < _JUMP:
        return parts
    below = 1 + ratios.index(max(ratios))
    small, large = sized[below - 1], sized[below]
    are_large = len(sized) - below <= below
    if are_large:
        odd, text = sized[below:], f"times as large as {small.name!r}, the largest of the other parts"
    else:
        odd, text = sized[:below], f"times smaller than {large.name!r}, the smallest of the other parts"
    notes = {}
    for part in odd:
        ratio = part.extent / small.extent if are_large else large.extent / part.extent
        notes[part.name] = f"it is {ratio:.4g} {text}: if it was drawn in another unit, export it in theirs"
    return tuple(replace(part, notes=(*part.notes, notes[part.name])) if part.name in notes else part for part in parts)
