"""Linear ball bearings that are drawn as one tube, known by their sizes: they slide on the rod in them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from jaxkin.assembly.inference.bearings import ring_of
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.closed_bearings import is_catalogued, sizes_of
from jaxkin.geometry.part import Part

SIZES = sizes_of("""
3 7 10; 4 8 12; 5 10 15; 5 12 22; 6 12 19; 6 12 35; 8 15 17; 8 15 24; 8 15 45; 8 16 25; 10 19 29; 10 19 55; 12 21 30; 12
21 57; 12 22 32; 13 23 32; 13 23 61; 16 26 36; 16 28 37; 16 28 70; 20 32 42; 20 32 45; 20 32 80; 25 40 58; 25 40 59; 25
40 112; 30 45 64; 30 47 68; 30 45 123
""")
"""Bore, outside diameter and length of linear ball bearings, millimetres: LM and LM-L of the metric series of Asia, LME
and KB of that of Europe."""


def linear_bearings(parts: Sequence[Part], bores: Mapping[str, Sequence[Bore]], metre: float = 1e-3) -> set[str]:
    """Find the tubes without other holes that have the size of a linear ball bearing.

    `bores` are the bores and pins of each part by its name, and `metre` is the unit of lengths in metres.
    """
    rings = [ring for part in parts if (ring := ring_of(part, bores[part.name])) is not None]
    return {ring.part.name for ring in rings if ring.plain and is_catalogued(ring, metre / 1e-3, SIZES)}
