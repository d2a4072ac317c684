"""Densities of parts, kg/m^3: of usual materials, and as a user gives them for all parts or by their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from jaxkin._names import closest, match_parts
from jaxkin._traced import traced
from jaxkin.geometry.part import Part

DENSITIES = {
    "steel": 7850.0,
    "stainless steel": 7900.0,
    "cast iron": 7200.0,
    "aluminium": 2700.0,
    "titanium": 4500.0,
    "brass": 8500.0,
    "bronze": 8800.0,
    "copper": 8960.0,
    "magnesium": 1800.0,
    "nylon": 1140.0,
    "pom": 1410.0,
    "abs": 1050.0,
    "pla": 1240.0,
    "wood": 600.0,
}
"""Material -> usual density, kg/m^3, as handbooks round it: an alloy may be a few percent off."""


def densities_of(density: Any, solids: Sequence[Part]) -> tuple[dict[str, Any], set[str]]:
    """Look up the density of each part that has one, kg/m^3, and the parts that it names by more than "*"."""
    if density is None:
        return {}, set()
    if not isinstance(density, Mapping):
        return dict.fromkeys((part.name for part in solids), _density(density)), set()
    found: dict[str, Any] = {}
    named: set[str] = set()
    # a pattern with "*" gives way to names, and "*" alone to all others
    for key in sorted(density, key=lambda key: ("*" not in str(key), len(str(key)))):
        for name in match_parts(key, solids, "density"):
            found[name] = _density(density[key])
            named |= {name} if key != "*" else set()
    return found, named


def _density(given: Any) -> Any:
    """Return a density in kg/m^3, given as a number or as the name of a material.

    Raises ValueError for unknown names, and for what is negative, infinite or no number; traced numbers are not looked
    at.
    """
    if isinstance(given, str):
        if given.lower() not in DENSITIES:
            known = ", ".join(DENSITIES)
            raise ValueError(f"there is no material {given!r} among {known}{closest(given.lower(), DENSITIES)}")
        return DENSITIES[given.lower()]
    if traced(given):
        return given
    number = np.asarray(given)
    if number.shape != () or number.dtype.kind not in "iuf" or not (np.isfinite(number) and number >= 0):
        raise ValueError(f"a density must be one number, kg/m^3, or the name of a material, got {given!r}")
    return float(number)
