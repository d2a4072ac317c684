"""What a mechanism looks like: solids or sticks, each part in a colour of its own."""

from __future__ import annotations

from dataclasses import replace
from itertools import cycle
from typing import TYPE_CHECKING

from jaxkin.geometry.part import Part
from jaxkin.view.sticks import stick_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

GREY = (0.62, 0.64, 0.66)
"""Fixed parts."""

PALETTE = (
    (0.00, 0.45, 0.70),
    (0.90, 0.62, 0.00),
    (0.00, 0.62, 0.45),
    (0.84, 0.37, 0.00),
    (0.80, 0.47, 0.65),
    (0.34, 0.71, 0.91),
    (0.94, 0.89, 0.26),
)
"""Moving parts in turn: the colours of Okabe and Ito, which colour-blind people can tell apart as well."""


def drawn_parts(mechanism: Mechanism) -> tuple[Part, ...]:
    """The parts of a mechanism to draw, every one with a colour: red, green, blue as on the screen (sRGB), in 0..1.

    The solids where the mechanism was read from a file, otherwise sticks; colours of the file where it gives any.
    """
    colors = cycle(PALETTE)
    return tuple(
        part if part.color else replace(part, color=GREY if part.name in mechanism.fixed else next(colors))
        for part in mechanism.solids or stick_parts(mechanism)
    )
