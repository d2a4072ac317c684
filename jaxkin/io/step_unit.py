"""The length unit of a STEP file and how exact its geometry is, from its text (ISO 10303-21)."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator, Mapping

from jaxkin.geometry.units import METRES

PREFIXES = {"MICRO": 1e-6, "MILLI": 1e-3, "CENTI": 1e-2, "DECI": 1e-1, "DECA": 1e1, "HECTO": 1e2, "KILO": 1e3}

_DEPTH = 5
"""A unit is defined by another one so many times at most; some files lead round in a circle."""


def length_unit(text: str, name: str) -> tuple[str, float]:
    """Find the unit that the first shapes of the file are given in: its name, a key of `METRES`, and its metres.

    `name` is what messages call the file. Raises ValueError for a unit that is not in `METRES`; a file without unit is
    read in millimetres, as the kernel does, with a warning.
    """
    for said, metres in _length_units(text):
        for unit, value in METRES.items():
            if unit and metres and abs(value / metres - 1) < 1e-6:
                return unit, metres
        known = ", ".join(filter(None, METRES))
        raise ValueError(f"{name} is in the length unit {' '.join(said.split())[:200]}: export it in {known}")
    warnings.warn(f"{name} does not say its length unit: taken for mm", stacklevel=2)
    return "mm", METRES["mm"]


def units_of_shapes(text: str) -> set[float]:
    """Find the metres of all length units of a file, those of millimetres where it says none: parts may be in another
    one than what they are placed in."""
    return {metres for _, metres in _length_units(text) if metres} or {METRES["mm"]}


def uncertainty(text: str) -> float:
    """Find the largest deviation of geometry that a file says it has, in its length unit; 0 where it says none."""
    statements = (statement for statement in text.split(";") if "UNCERTAINTY_MEASURE_WITH_UNIT" in statement)
    number = re.compile(r"LENGTH_MEASURE\s*\(\s*(\d+\.?\d*(?:[Ee][+-]?\d+)?)\s*\)")
    found = [match[1] for match in map(number.search, statements) if match]
    return max(map(float, found), default=0.0)


def _length_units(text: str) -> Iterator[tuple[str, float | None]]:
    """Yield what defines the length unit of each context of shapes, and its metres, None where these cannot be told."""
    # statement by statement: a pattern over all of the text may take a time that grows with its square
    statements = [statement for statement in text.split(";") if "UNIT" in statement]
    units = {
        found[1]: found[2] for statement in statements if (found := re.search(r"#(\d+)\s*=\s*(.*)", statement, re.S))
    }
    for statement in statements:
        context = re.search(r"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^()]*)\)", statement)
        for number in re.findall(r"#(\d+)", context[1]) if context else ():
            if "LENGTH_UNIT" in units.get(number, ""):
                yield units[number], metres_of(units, number)


def metres_of(units: Mapping[str, str], number: str, depth: int = 0) -> float | None:
    """Find how many metres a unit has; None where that is not said, or makes no sense."""
    said = units.get(number, "")
    if si := re.search(r"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.", said):
        return PREFIXES.get(si[1]) if si[1] else 1.0
    conversion = re.search(r"CONVERSION_BASED_UNIT\s*\(\s*'[^']*'\s*,\s*#(\d+)", said)
    measure = conversion and re.search(
        r"MEASURE_WITH_UNIT\s*\(\s*(?:\w+\s*\()?\s*([+-]?[\d.]+(?:[Ee][+-]?\d+)?)\s*\)?\s*,\s*#(\d+)",
        units.get(conversion[1], ""),
    )
    base = metres_of(units, measure[2], depth + 1) if measure and depth < _DEPTH else None
    try:
        return float(measure[1]) * base if measure and base else None
    except ValueError:  # points without end
        return None
