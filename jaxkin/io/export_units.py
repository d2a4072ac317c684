"""Units of the exports of CAD systems for Simscape Multibody, by the names that exporters write."""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element

METRES_BY_NAME = {
    "meter": 1.0, "m": 1.0, "centimeter": 0.01, "cm": 0.01, "millimeter": 0.001, "mm": 0.001,
    "micrometer": 1e-6, "micron": 1e-6, "um": 1e-6, "nanometer": 1e-9, "nm": 1e-9, "kilometer": 1000.0, "km": 1000.0,
    "inch": 0.0254, "in": 0.0254, "foot": 0.3048, "ft": 0.3048, "yard": 0.9144, "yd": 0.9144, "mil": 2.54e-5,
}  # fmt: skip
"""Metres in one unit of length."""

POUND = 0.45359237

KILOGRAMS_BY_NAME = {
    "kilogram": 1.0, "kg": 1.0, "gram": 0.001, "g": 0.001, "milligram": 1e-6, "mg": 1e-6, "tonne": 1000.0,
    "lbm": POUND, "lb": POUND, "pound": POUND, "poundmass": POUND, "ounce": POUND / 16, "oz": POUND / 16,
    "slug": 14.59390294, "slinch": 175.12683524,
}  # fmt: skip
"""Kilograms in one unit of mass."""

DATA, MODEL = "DataUnits", "ModelUnits"
"""What the numbers of the file are in, and what a model is drawn in."""


def unit_of(root: Element, what: str, usual: str) -> str:
    """Find the name of the unit that the numbers of a file are in, such as `what`="length".

    Exporters of some systems write no `DataUnits`: then the numbers are in the `ModelUnits` of the file. `usual` where
    it has neither.
    """
    tags = (DATA, MODEL, f"RootAssembly/{MODEL}")
    found = (at.get(what) for tag in tags if (at := root.find(tag)) is not None)
    return next((name for name in found if name), usual)


def model_unit(root: Element, part: Element) -> str:
    """Find the name of the unit of length of the model of a part; that of the numbers of the file where there is
    none."""
    own = (at.get("length") for each in (part, root) if (at := each.find(MODEL)) is not None)
    return next((name for name in own if name), unit_of(root, "length", "meter"))


def factor(name: str, known: Mapping[str, float]) -> float | None:
    """Look up a unit by its name in any case of letters, in the singular or the plural; None where it is not known."""
    called = name.strip().casefold().replace("metre", "meter").replace("-", "")
    return known.get(called, known.get(called.removesuffix("s")))
