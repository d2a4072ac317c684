"""Units of length by name."""

from jaxkin._arguments import text

METRES = {
    "um": 1e-6,
    "mm": 1e-3,
    "cm": 1e-2,
    "dm": 1e-1,
    "m": 1.0,
    "km": 1e3,
    "in": 0.0254,
    "ft": 0.3048,
    "": 1.0,
}
"""Metres in a unit; where no unit was said, lengths are taken for metres."""


def check_unit(unit: str) -> str:
    """Return the name of a unit of length, "" where none was said; raise ValueError for others than `METRES`."""
    if text(unit, "unit") not in METRES:
        raise ValueError(f"unit must be one of {', '.join(filter(None, METRES))}, or '' for metres, got {unit!r}")
    return unit


def unit_name(unit: str) -> str:
    """Name a unit in a sentence: its abbreviation, but "inches" for "in", which reads as a preposition."""
    return "inches" if unit == "in" else unit
