"""What a mechanism looks like: solids or sticks, each body in a colour of its own."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import cycle
from math import dist
from typing import TYPE_CHECKING

from jaxkin.geometry.part import Part, body_name
from jaxkin.view.sticks import stick_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.view.sheet import Color

FIXED_COLOR = (0.62, 0.64, 0.66)
"""Fixed bodies."""

PALETTE = (
    (0.00, 0.45, 0.70),
    (0.90, 0.62, 0.00),
    (0.00, 0.62, 0.45),
    (0.84, 0.37, 0.00),
    (0.80, 0.47, 0.65),
    (0.34, 0.71, 0.91),
    (0.94, 0.89, 0.26),
)
"""Moving bodies in turn: the colours of Okabe and Ito, which colour-blind people can tell apart as well."""

SHADES = ((1.0, 1.0), (0.55, 1.0), (1.0, 0.6))
"""Share of colour in white, and of light, each time the palette is gone through: three of one colour differ enough."""

DISTINCT = len(PALETTE) * len(SHADES)
"""Bodies that get colours of their own."""

LEAST_DIFFERENCE = 0.13
"""Distance of two colours, red, green, blue in 0..1, from which on the boxes of a legend are told apart: those of the
palette and its shades differ by 0.134 or more."""


def drawn_parts(mechanism: Mechanism) -> tuple[Part, ...]:
    """Make the parts of a mechanism to draw, every one with a colour: red, green, blue as on the screen (sRGB), in
    0..1.

    The solids where the mechanism was read from a file, otherwise sticks, also for parts of which the file has no
    solid; colours of the file where it gives any. Parts without one share that of their body.
    """
    solids = drawn_solids(mechanism)
    painted = {part.name for part in solids if part.color}
    colors, of_part = cycle(PALETTE), {}
    for parts in mechanism.bodies.values():
        if not painted.issuperset(parts):
            of_part |= dict.fromkeys(parts, FIXED_COLOR if parts[0] in mechanism.fixed else next(colors))
    return tuple(part if part.color else replace(part, color=of_part[part.name]) for part in solids)


def drawn_solids(mechanism: Mechanism) -> tuple[Part, ...]:
    """Make the parts of a mechanism to draw, in the colours of the file: sticks where it has no solid of a part.

    A part without a solid and without joints stays the mark that it is.
    """
    solids = mechanism.solids
    if not solids:
        return stick_parts(mechanism)
    if all(part.is_solid for part in solids) or not mechanism.joints:
        return solids
    sticks = {part.name: part.triangles for part in stick_parts(mechanism) if len(part.triangles)}
    return tuple(
        part if part.is_solid else replace(part, triangles=sticks.get(part.name, part.triangles)) for part in solids
    )


def told_apart(parts: Sequence[Part], bodies: Mapping[str, Sequence[str]], fixed: Collection[str]) -> tuple[Part, ...]:
    """Colour all parts by their bodies where these colours tell more of the moving bodies apart than their own do.

    What a legend shows of a body is the colour of its first part. CAD systems give most parts one colour, often white.
    """
    own = {part.name: part.color for part in parts}
    by_body = body_colors(bodies, fixed)
    first = [members[0] for members in bodies.values() if members[0] not in fixed]
    if _different([own[name] for name in first]) >= _different([by_body[name] for name in first]):
        return tuple(parts)
    return tuple(replace(part, color=by_body[part.name]) for part in parts)


def _different(colors: Iterable[Color | None]) -> int:
    """Count colours that can be told apart."""
    found: list[Color] = []
    for color in colors:
        if color is not None and all(dist(color, other) >= LEAST_DIFFERENCE for other in found):
            found.append(color)
    return len(found)


def body_colors(bodies: Mapping[str, Sequence[str]], fixed: Collection[str]) -> dict[str, Color]:
    """Choose the colour of each part by its body alone: the palette in turn, then paler and darker; fixed bodies are
    grey."""
    shades = [tuple(1 - pale + pale * dark * value for value in color) for pale, dark in SHADES for color in PALETTE]
    colors, found = cycle(shades), {}
    for parts in bodies.values():
        found |= dict.fromkeys(parts, FIXED_COLOR if parts[0] in fixed else next(colors))
    return found


def body_label(parts: Sequence[str], solids: Iterable[Part]) -> str:
    """Tell what a legend calls a body: its heaviest part, and how many more, or which where that is no longer."""
    name = body_name(parts, {part.name: part for part in solids})
    if len(parts) == 1:
        return name
    counted, listed = f"{name} and {len(parts) - 1} more", ", ".join([name, *(part for part in parts if part != name)])
    return listed if len(listed) <= len(counted) else counted
