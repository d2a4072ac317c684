"""Densities of the products of a STEP file, from its text: those of the materials that the file says they are of."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from jaxkin.io.step_shapes import StepShapes
from jaxkin.io.step_strings import string_value
from jaxkin.io.step_unit import PREFIXES, metres_of

LIGHTEST, HEAVIEST = 1.0, 23000.0
"""Densities that a material may have, kg/m^3: from foam to osmium. Others are in another unit than the file says."""

_STRING = re.compile(r"'((?:[^']|'')*)'")
_NUMBER = re.compile(r"\(\s*([+-]?\d+\.?\d*(?:[Ee][+-]?\d+)?)\s*\)")
_STATEMENT = re.compile(r"\s*#(\d+)\s*=\s*(.*)", re.S)
_GRAM = re.compile(r"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.GRAM\.")
_POWER = re.compile(r"#(\d+)\s*,\s*([+-]?\d+\.?\d*)")

_OF_OPEN_CASCADE = {"mass": 3.0, "length": 2.0}
"""Powers in the unit of densities as Open CASCADE writes it, which means grams a cubic centimetre by that."""


class Material(NamedTuple):
    """What a file says that a product is of."""

    name: str
    """"" where it has none."""
    density: float
    """kg/m^3."""

    @property
    def note(self) -> str:
        """Tell the density and where it is from."""
        of = f" of {self.name!r}" if self.name else ""
        return f"its file says the density {self.density:.6g} kg/m^3{of}: masses take it where they are given no other"


def materials(text: str) -> dict[str, Material]:
    """Find the materials with a density, by the names of the products that are of them.

    Left out are names that several products have which differ in it, and densities that no material has.
    """
    if "'density'" not in text:
        return {}
    shapes = StepShapes(text)
    raw = {own[1]: own[2] for each in shapes.statements if (own := _STATEMENT.fullmatch(each))}
    said: dict[str, Material] = {}
    names = dict(_properties(shapes, "material name"))
    for definition, representation in _properties(shapes, "density"):
        density = next(_densities(shapes, raw, representation), 0.0)
        if LIGHTEST <= density <= HEAVIEST:
            said[definition] = Material(_called(shapes, names.get(definition, "")), density)
    found: dict[str, set[Material | None]] = {}
    for definition, _ in shapes.defined():
        found.setdefault(shapes.product(definition), set()).add(said.get(definition))
    return {name: one for name, several in found.items() if len(several) == 1 and (one := next(iter(several)))}


def _properties(shapes: StepShapes, what: str) -> Iterator[tuple[str, str]]:
    """Yield the product definitions that have a property of that description, each with its representation."""
    for number in shapes.of_kind("PROPERTY_DEFINITION_REPRESENTATION"):
        one, representation = (*shapes.references(number), "", "")[:2]
        if shapes.kinds.get(one) == "PROPERTY_DEFINITION" and what in _STRING.findall(shapes.bodies[one])[1:2]:
            yield from ((definition, representation) for definition in shapes.references(one)[:1])


def _called(shapes: StepShapes, representation: str) -> str:
    items = (each for each in shapes.references(representation) if "DESCRIPTIVE" in shapes.kinds.get(each, ""))
    return next((string_value(name) for each in items for name in _STRING.findall(shapes.bodies[each])[:1]), "")


def _densities(shapes: StepShapes, raw: Mapping[str, str], representation: str) -> Iterator[float]:
    """Yield the numbers of a representation that are densities, kg/m^3."""
    for item in shapes.references(representation):
        if shapes.kinds.get(item) == "MEASURE_REPRESENTATION_ITEM" and (number := _NUMBER.search(shapes.bodies[item])):
            unit = (shapes.references(item) or [""])[-1]
            yield float(number[1]) * _unit(raw, unit)


def _unit(raw: Mapping[str, str], number: str) -> float:
    """Find the kg/m^3 of a unit; zero where it is none of density."""
    powers, sizes = {}, {}
    for each in re.findall(r"#(\d+)", raw.get(number, "")) if "DERIVED_UNIT" in raw.get(number, "") else ():
        if element := _POWER.search(raw.get(each, "")):
            unit = raw.get(element[1], "")
            what = "mass" if "MASS_UNIT" in unit else "length" if "LENGTH_UNIT" in unit else "another"
            gram = _GRAM.search(unit)
            size = 1e-3 * PREFIXES.get(gram[1] or "", 1.0) if gram else metres_of(raw, element[1]) or 0.0
            powers[what], sizes[what] = float(element[2]), size
    if powers == _OF_OPEN_CASCADE:
        powers = {"mass": 1.0, "length": -3.0}
    if powers != {"mass": 1.0, "length": -3.0} or not all(sizes.values()):
        return 0.0
    return sizes["mass"] / sizes["length"] ** 3
