"""Ball bearings that are drawn as one closed ring, known by their sizes, of ISO 15 and of inch series, or by names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.bearings import Ring, reach_of, ring_of
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.named_bearings import is_named_bearing
from jaxkin.geometry.part import Part

SAME_SIZE = 0.005
"""Difference of a size that is none, over the size: bores are drawn with some hundredths of a millimetre of play."""

MAX_WIDTH, BORES = 0.6, (0.2, 0.85)
"""Largest width of a ball bearing, and least and largest bore, over its outside diameter: those of the table below have
up to 0.56, and 0.24 to 0.81."""

_SIZES = """
1.5 4 1.2; 2 5 1.5; 2 5 2.3; 2 6 2.3; 2 6 3; 2.5 6 1.8; 2.5 6 2.6; 3 6 2; 3 6 2.5; 3 7 2; 3 7 3; 3 8 2.5; 3 8 3; 3 8
4; 3 9 3; 3 9 5; 3 10 4; 4 7 2; 4 7 2.5; 4 8 2; 4 8 3; 4 9 2.5; 4 9 4; 4 10 3; 4 10 4; 4 11 4; 4 12 4; 4 13 5; 4 16 5;
5 8 2; 5 8 2.5; 5 9 2.5; 5 9 3; 5 10 3; 5 10 4; 5 11 3; 5 11 4; 5 11 5; 5 13 4; 5 13 5; 5 14 5; 5 16 5; 5 19 6; 6 10
2.5; 6 10 3; 6 12 3; 6 12 4; 6 13 3.5; 6 13 5; 6 15 5; 6 16 5; 6 17 6; 6 19 6; 7 11 2.5; 7 11 3; 7 13 3; 7 13 4; 7 14
3.5; 7 14 5; 7 17 5; 7 19 6; 7 22 7; 8 12 2.5; 8 12 3.5; 8 14 3.5; 8 14 4; 8 16 4; 8 16 5; 8 19 6; 8 22 7; 8 24 8; 9
17 4; 9 17 5; 9 20 6; 9 24 7; 9 26 8; 10 15 3; 10 15 4; 10 19 5; 10 19 7; 10 22 6; 10 26 8; 10 30 9; 10 35 11; 12 18
4; 12 21 5; 12 24 6; 12 28 8; 12 32 10; 12 37 12; 15 21 4; 15 24 5; 15 28 7; 15 32 8; 15 32 9; 15 35 11; 15 42 13; 17
23 4; 17 26 5; 17 30 7; 17 35 8; 17 35 10; 17 40 12; 17 47 14; 20 27 4; 20 32 7; 20 37 9; 20 42 8; 20 42 12; 20 47 14;
20 52 15; 25 32 4; 25 37 7; 25 42 9; 25 47 8; 25 47 12; 25 52 15; 25 62 17; 30 42 7; 30 47 9; 30 55 9; 30 55 13; 30 62
16; 30 72 19; 35 47 7; 35 55 10; 35 62 14; 35 72 17; 35 80 21; 40 52 7; 40 62 12; 40 68 15; 40 80 18; 40 90 23; 45 58
7; 45 68 12; 45 75 16; 45 85 19; 45 100 25; 50 65 7; 50 72 12; 50 80 16; 50 90 20; 50 110 27; 55 72 9; 55 80 13; 55 90
18; 55 100 21; 60 78 10; 60 85 13; 60 95 18; 60 110 22; 3.175 9.525 3.967; 3.175 6.35 2.779; 4.7625 12.7 4.978; 6.35
9.525 3.175; 6.35 12.7 3.175; 6.35 12.7 4.7625; 6.35 15.875 4.978; 6.35 19.05 7.142; 9.525 22.225 7.142; 12.7 28.575
7.938; 15.875 34.925 8.731; 19.05 41.275 11.112
"""
"""Bore, outside diameter and width of deep groove ball bearings, millimetres: common sizes of the series 60, 62, 63 and
67 to 69 up to 60 mm bore, miniature bearings open and with shields, and inch series R; others are not told."""


def sizes_of(table: str) -> Float[np.ndarray, "sizes 3"]:
    """Read a table of sizes: bore, outside diameter and width, with semicolons between."""
    return np.array([row.split() for row in table.replace("\n", " ").split(";")], float)


SIZES = sizes_of(_SIZES)
"""The same as an array."""


def closed_bearings(parts: Sequence[Part], bores: Mapping[str, Sequence[Bore]], metre: float = 1e-3) -> list[Ring]:
    """Find the rings without other holes that have the size of a ball bearing, or the name of one and its proportions.

    `bores` are the bores and pins of each part by its name, and `metre` is the unit of lengths in metres.
    """
    rings = [ring for part in parts if (ring := ring_of(part, bores[part.name])) is not None]
    sized = {ring.part.name for ring in rings if ring.plain and is_catalogued(ring, metre / 1e-3, SIZES)}
    named = [ring for ring in rings if ring.plain and is_named_bearing(ring.part.name) and _has_proportions(ring)]
    named = [ring._replace(told="is a ball bearing by its name") for ring in named if ring.part.name not in sized]
    return [*(ring for ring in rings if ring.part.name in sized), *named]


def _has_proportions(ring: Ring) -> bool:
    """Tell whether a ring is as wide and as thick as ball bearings are: a bush is longer, or thinner."""
    low, high = reach_of(ring, ring.hole)
    outside = 2 * ring.outside.radius
    return bool(high - low <= MAX_WIDTH * outside and BORES[0] <= 2 * ring.hole.radius / outside <= BORES[1])


def is_catalogued(ring: Ring, millimetres: float, sizes: Float[np.ndarray, "sizes 3"]) -> bool:
    """Tell whether a ring has one of the sizes of a table; its lengths are in units of so many millimetres."""
    low, high = reach_of(ring, ring.hole)
    size = millimetres * np.array([2 * ring.hole.radius, 2 * ring.outside.radius, high - low])
    return bool(np.any(np.all(np.abs(size / sizes - 1) <= SAME_SIZE, axis=1)))
