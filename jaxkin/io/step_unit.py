"""The length unit of a STEP file, from its text (ISO 10303-21)."""

from __future__ import annotations

import re
import warnings

from jaxkin.io.units import METRES

_PREFIXES = {"MICRO": 1e-6, "MILLI": 1e-3, "CENTI": 1e-2, "DECI": 1e-1, "DECA": 1e1, "HECTO": 1e2, "KILO": 1e3}


def length_unit(text: str, name: str) -> tuple[str, float]:
    """The unit that the first shapes of the file are given in: its name, a key of `METRES`, and its metres.

    `name` is what messages call the file. Raises ValueError for a unit that is not in `METRES`; a file without unit is
    read in millimetres, as the kernel does, with a warning.
    """
    lengths = {found[1]: found[2] for found in re.finditer(r"#(\d+)\s*=\s*([^;]*\bLENGTH_UNIT\b[^;]*);", text)}
    for context in re.finditer(r"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^)]*)\)", text):
        for number in re.findall(r"#(\d+)", context[1]):
            if number in lengths:
                metres = _metres(text, lengths, number)
                for unit, value in METRES.items():
                    if unit and metres and abs(value / metres - 1) < 1e-6:
                        return unit, metres
                known = ", ".join(filter(None, METRES))
                raise ValueError(
                    f"{name} is in the length unit {' '.join(lengths[number].split())}: export it in {known}"
                )
    warnings.warn(f"{name} does not say its length unit: taken for mm", stacklevel=2)
    return "mm", METRES["mm"]


def _metres(text: str, lengths: dict[str, str], number: str) -> float | None:
    """None where it is not said."""
    if si := re.search(r"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.", lengths.get(number, "")):
        return _PREFIXES.get(si[1]) if si[1] else 1.0
    conversion = re.search(r"CONVERSION_BASED_UNIT\s*\(\s*'[^']*'\s*,\s*#(\d+)", lengths.get(number, ""))
    measure = conversion and re.search(
        rf"#{conversion[1]}\s*=[^;]*?MEASURE_WITH_UNIT\s*\(\s*(?:\w+\s*\()?\s*([\d.Ee+-]+)\s*\)?\s*,\s*#(\d+)",
        text,
    )
    base = _metres(text, lengths, measure[2]) if measure else None
    return float(measure[1]) * base if measure and base else None
