"""Hard cases: axes nearly parallel or nearly intersecting, lengths far apart, single precision."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from reference import mechanisms, overconstrained, spatial
from reference.hard_case import HardCase, angles, displacements, turn
from reference.hard_fourbars import (
    FOURBAR,
    MARGINS,
    PARALLELOGRAM,
    Array,
    rocker,
)


def sliders(crank: float, rod: float) -> HardCase:
    """A slider-crank without offset of these lengths; its closed form needs no difference of large numbers."""

    def slide(given: Array) -> Mapping[str, Array]:
        def sag(theta: Array) -> Array:
            return (crank * np.sin(theta)) ** 2 / (rod + np.sqrt(rod**2 - (crank * np.sin(theta)) ** 2))

        return {"S": crank * (np.cos(1.0 + given) - np.cos(1.0)) - sag(1.0 + given) + sag(1.0)}

    return HardCase(
        f"slider-crank, crank {crank:g}, rod {rod:g}",
        "unit" if rod == 3 * crank else "length ratio 1e6",
        partial(mechanisms.slider_crank, 1.0, crank, rod, 0.0),
        {"A": turn(25)},
        displacements(slide, rod),
        "closed form",
        long=True,
    )


NEARLY = tuple(
    HardCase(
        f"Bennett linkage, twists {margin:.0e}",
        "axes nearly parallel",
        partial(mechanisms.bennett_linkage, 0.9, margin, 1.7 * margin),
        {"A": turn(25, 0.3)},
        angles("B", lambda theta, m=margin: spatial.bennett(theta, m, 1.7 * m)[..., 1], 0.9),
        "closed form",
        long=True,
    )
    for margin in MARGINS[:7]
) + tuple(
    HardCase(
        f"spherical four-bar, axes miss by {margin:.0e}",
        "axes nearly intersecting",
        partial(overconstrained.missing_axes, 0.4, margin),
        {"A": turn(25)},
        angles("D", lambda theta: spatial.spherical_fourbar(theta).output, 0.4),
        "closed form",
        long=True,
    )
    for margin in MARGINS[:7]
)

SIZES = tuple(
    sliders(crank, rod)
    for crank, rod in ((1.0, 1e6), (1e-3, 1e3), (1e-6, 3e-6), (1e-3, 3e-3), (1.0, 3.0), (1e3, 3e3), (1e6, 3e6))
)

SINGLE_PRECISION = (
    HardCase(
        "four-bar in float32",
        "rounding of 1e-7",
        FOURBAR,
        {"A": turn(25)},
        angles("D", rocker(), 1.0),
        "closed form",
        bits=32,
        long=True,
    ),
    HardCase(
        "parallelogram in float32",
        "change points at 0 and pi",
        PARALLELOGRAM,
        {"A": turn(25)},
        displacements(lambda given: {"D": given}),
        "rocker turns as the crank",
        bits=32,
        long=True,
    ),
    HardCase(
        "Bennett linkage in float32",
        "redundant equations",
        mechanisms.bennett_linkage,
        {"A": turn(25)},
        angles("B", lambda theta: spatial.bennett(theta)[..., 1], 0.9),
        "closed form",
        bits=32,
        long=True,
    ),
    HardCase(
        "RSSR linkage in float32",
        "the rod may spin",
        mechanisms.rssr_linkage,
        {"A": turn(25)},
        angles("D", lambda theta: spatial.rssr(theta).output, 0.3),
        "closed form",
        bits=32,
        long=True,
    ),
)
