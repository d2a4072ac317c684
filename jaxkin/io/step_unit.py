"""The length unit of a STEP file, from its text (ISO 10303-21)."""

from __future__ import annotations

import re
from collections import Counter

NAMES = {1e-6: "um", 1e-3: "mm", 1e-2: "cm", 1e-1: "dm", 1.0: "m", 1e3: "km", 0.0254: "in", 0.3048: "ft"}
"""By the length in metres."""
PREFIXES = {"MICRO": 1e-6, "MILLI": 1e-3, "CENTI": 1e-2, "DECI": 1e-1, "KILO": 1e3, "$": 1.0, "": 1.0}


def length_unit(text: str) -> tuple[str, float]:
    """Name and metres of the unit that most of the geometry is given in."""
    entities = dict(re.findall(r"#(\d+)\s*=\s*((?:'[^']*'|[^;'])*);", text))
    units: Counter[float] = Counter()
    for entity in entities.values():
        if context := re.search(r"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^)]*)\)", entity):
            for number in re.findall(r"#(\d+)", context[1]):
                if re.search(r"\bLENGTH_UNIT\b", entities[number]):
                    units[_metres(entities, number)] += 1
    metres = units.most_common(1)[0][0]
    return next(name for value, name in NAMES.items() if abs(value / metres - 1) < 1e-9), metres


def _metres(entities: dict[str, str], number: str) -> float:
    entity = entities[number]
    if si := re.search(r"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.", entity):
        return PREFIXES[si[1] or "$"]
    measure = re.search(r"CONVERSION_BASED_UNIT\s*\(\s*'[^']*'\s*,\s*#(\d+)", entity)
    value, base = re.search(r"LENGTH_MEASURE\s*\(([^)]*)\)\s*,\s*#(\d+)", entities[measure[1]]).groups()
    return float(value) * _metres(entities, base)
