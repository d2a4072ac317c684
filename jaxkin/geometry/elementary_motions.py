"""Elementary motions of a local frame, of which movements are products: slides, turns and screws along one axis.

A motion is as far as its coordinate says, or as a law says of the curve or the surface that its joint follows: x, y, z
or the angle of the tangent there. Of the slides over a surface those that belong to the coordinate v have a rate and no
length: those of u have gone all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from jaxkin.geometry.patches import FollowedPoint

FollowedLaw = Literal["x", "y", "z", "x_v", "y_v", "z_v", "turn"]
"""A function of what a joint follows: a coordinate of the point there, or the angle of the tangent. `_v` are those of
the second coordinate of a surface."""


@dataclass(frozen=True)
class ElementaryMotion:
    """A translation along, a rotation about or a screw motion about one axis of the local frame."""

    kind: Literal["translate", "rotate", "screw"]
    """A screw turns by its coordinate q and advances by pitch q / 2 pi."""
    axis: int
    """Axis of the local frame: 0, 1, 2 for x, y, z."""
    coordinate: int
    """Index of the coordinate in `Movement.coordinates` that is the angle or length of the motion. Several motions may
    have the same coordinate."""
    law: FollowedLaw | None = None
    """Which function of the curve or the surface the motion follows; None where q itself is its angle or length."""
    sense: Literal[1, -1] = 1
    """-1 where the motion is the inverse of what `law` says."""


def amount(
    element: ElementaryMotion, q: Any, pitch: Any, point: FollowedPoint | None, cos_sin: Callable[[Any], Any]
) -> tuple[Any, tuple[Any, Any] | None]:
    """Compute how far a motion goes: its length along the axis, and (cosine, sine) of its angle; None for none.

    `pitch` is the advance of a screw per turn, `point` is where the joint is on what it follows, for
    motions with a law.
    """
    if element.law is not None:
        if element.law == "turn":
            cos, sin = law_turn(point)
            return None, (cos, element.sense * sin)
        return element.sense * law_length(element.law, point), None
    advance = None
    if element.kind != "rotate":
        advance = q if element.kind == "translate" else q * pitch / (2 * np.pi)
    return advance, None if element.kind == "translate" else tuple(cos_sin(q))


def rates(element: ElementaryMotion, pitch: Any, point: FollowedPoint | None) -> tuple[Any, Any]:
    """Compute the derivatives of the length and of the angle of a motion with respect to its coordinate."""
    if element.law is not None:
        rate = element.sense * law_rate(element.law, point)
        return (0.0, rate) if element.law == "turn" else (rate, 0.0)
    advance = 0.0 if element.kind == "rotate" else 1.0 if element.kind == "translate" else pitch / (2 * np.pi)
    return advance, 0.0 if element.kind == "translate" else 1.0


def law_length(law: FollowedLaw, point: FollowedPoint | None) -> Any:
    """Look up the length that a law other than "turn" says."""
    return 0.0 if law.endswith("_v") else _of(law, point)


def law_turn(point: FollowedPoint | None) -> tuple[Any, Any]:
    """Look up the cosine and the sine of the angle of the tangent."""
    return _of("cos", point), _of("sin", point)


def law_rate(law: FollowedLaw, point: FollowedPoint | None) -> Any:
    """Look up the derivative of the length, or the angle, of a law with respect to its coordinate."""
    return _of("turning" if law == "turn" else f"d{law}", point)


def _of(name: str, point: FollowedPoint | None) -> Any:
    if point is None:
        raise ValueError("a motion along a curve, or over a surface, needs the curve, or the surface")
    return getattr(point, name)


def displaced_columns(
    columns: Sequence[Any], axis: int, advance: Any, turn: tuple[Any, ...] | None, back: bool = False
) -> list[Any]:
    """Multiply frames F by an elementary motion E from the right, F E, or `back` by its inverse, in numpy, JAX or other
    arithmetic.

    `columns` are the four columns of F: its axes x, y, z and its origin. E translates by the length `advance` along the
    axis 0, 1, 2 (x, y, z) of the frame, and rotates about it by the angle with (cosine, sine) `turn`; None for one of
    them means no translation, or no rotation.
    """
    i, j, k = axis, (axis + 1) % 3, (axis + 2) % 3
    columns = list(columns)
    if advance is not None:
        columns[3] = columns[3] + columns[i] * (-advance if back else advance)
    if turn is not None:
        cos, sin = turn[0], -turn[1] if back else turn[1]
        columns[j], columns[k] = columns[j] * cos + columns[k] * sin, columns[k] * cos - columns[j] * sin
    return columns


def displaced_point(
    point: Sequence[Any], axis: int, advance: Any, turn: tuple[Any, ...] | None, back: bool
) -> tuple[Any, Any, Any]:
    """Displace a point (x, y, z) of the local frame by an elementary motion E, or `back` by its inverse.

    `axis`, `advance` and `turn` are those of `displaced_columns`.
    """
    i, j, k = axis, (axis + 1) % 3, (axis + 2) % 3
    rows = list(point)
    if advance is not None and back:
        rows[i] = rows[i] - advance
    if turn is not None:
        cos, sin = turn[0], -turn[1] if back else turn[1]
        rows[j], rows[k] = cos * rows[j] - sin * rows[k], sin * rows[j] + cos * rows[k]
    if advance is not None and not back:
        rows[i] = rows[i] + advance
    return rows[0], rows[1], rows[2]
