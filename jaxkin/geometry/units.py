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
SPELLED = {"in": "inches", "ft": "feet"}
"""Units whose names are words."""


def lengths_in(unit: str) -> str:
    """Say in which unit lengths are; inches and feet in full, since "in in" reads badly."""
    return f"lengths in {SPELLED.get(unit, unit)}"
