"""Units of length by name."""

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


def unit_name(unit: str) -> str:
    """Name a unit in a sentence: its abbreviation, but "inches" for "in", which reads as a preposition."""
    return "inches" if unit == "in" else unit
