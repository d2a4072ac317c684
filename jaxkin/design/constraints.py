"""Constraints: functions of a motion (and of the extra variables) whose values must not be negative.

Each is without unit, so that one penalty serves all: lengths are divided by a length of the mechanism. They are pytrees
of their numbers, as objectives are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin._arguments import text
from jaxkin._traced import traced
from jaxkin.design import given
from jaxkin.design.clearance import check_shapes, clearance
from jaxkin.design.measures import (
    STATIC,
    PartPoint,
    driven_values,
    joint_coordinate,
    lengths_now,
    part_point,
    transmission_angle,
)
from jaxkin.design.objective import Extras
from jaxkin.design.shapes import Shape
from jaxkin.dimensions.features import LengthName
from jaxkin.geometry.characteristic_length import centroid_and_length
from jaxkin.mechanism.motion import Motion

Constraint = Callable[[Motion, Extras], Any] | Callable[[Motion], Any]


class DesignConstraint:
    """A constraint of this module."""

    name: ClassVar[str]
    """That of the function that makes it."""


def constraint_name(constraint: Constraint) -> str:
    """Tell the name of a constraint, for messages: that of the function that made it, or its own."""
    return getattr(constraint, "name", None) or getattr(constraint, "__name__", type(constraint).__name__)


def numbered(number: int, constraint: Constraint) -> str:
    """Tell the number and the name of a constraint, for messages."""
    return f"constraint {number} ({constraint_name(constraint)})"


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _FullCrank(DesignConstraint):
    name = "full_crank"
    bars: tuple[LengthName, LengthName, LengthName, LengthName] = field(metadata=STATIC)

    def __call__(self, motion: Motion, extras: Extras):
        g, a, b, c = lengths_now(motion.mechanism, self.bars)
        total = g + a + b + c
        return jnp.stack([total - 2 * (a + other) for other in (g, b, c)]) / total


def full_crank(ground: LengthName, crank: LengthName, coupler: LengthName, rocker: LengthName) -> Constraint:
    """Demand that the crank of a four-bar turns fully: it is the shortest bar, and with each other one no longer than
    the rest.

    The four bars are named as in `with_lengths`. For a rocker that turns fully too (a double crank), name the
    ground first and the crank in its place.
    """
    named = {"ground": ground, "crank": crank, "coupler": coupler, "rocker": rocker}
    g, a, b, c = (given.bar(key, f"full_crank: {argument}") for argument, key in named.items())
    return _FullCrank((g, a, b, c))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Grashof(DesignConstraint):
    name = "grashof"
    bars: tuple[LengthName, ...] = field(metadata=STATIC)

    def __call__(self, motion: Motion, extras: Extras):
        lengths = jnp.sort(jnp.stack([jnp.asarray(each) for each in lengths_now(motion.mechanism, self.bars)]))
        return (lengths[1] + lengths[2] - lengths[0] - lengths[3])[None] / jnp.sum(lengths)


def grashof(*bars: LengthName) -> Constraint:
    """Demand that some bar of a four-bar turns fully: the shortest and the longest are no longer than the other two."""
    if len(bars) != 4:
        raise ValueError(f"grashof: name the four bars of a four-bar by their keys as in with_lengths, got {len(bars)}")
    return _Grashof(tuple(given.bar(key, "grashof: a bar") for key in bars))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _TransmissionWithin(DesignConstraint):
    name = "transmission_within"
    joint: str = field(metadata=STATIC)
    ends: tuple[str, str] = field(metadata=STATIC)
    least: Any
    largest: Any

    def __call__(self, motion: Motion, extras: Extras):
        angle = transmission_angle(motion, self.joint, self.ends)
        return jnp.concatenate([angle - self.least, self.largest - angle])


def transmission_within(joint: str, ends: tuple[str, str], least: float, largest: float = np.pi) -> Constraint:
    """Demand that the transmission angle (see `transmission_angle`) stays between two angles, in radians."""
    text(joint, "transmission_within: joint")
    least = given.angle(least, "transmission_within: least", np.pi)
    largest = given.angle(largest, "transmission_within: largest", np.pi)
    if not traced((least, largest)) and least > largest:
        raise ValueError(f"transmission_within: least must not exceed largest, got {least:.6g} and {largest:.6g}")
    return _TransmissionWithin(joint, given.ends(ends, "transmission_within: ends"), least, largest)


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _InBox(DesignConstraint):
    name = "in_box"
    point: PartPoint
    axes: tuple[int, ...] = field(metadata=STATIC)
    """The axis of each side that is not open."""
    signs: tuple[int, ...] = field(metadata=STATIC)
    """Of each side 1 if it is a lower one, or -1."""
    sides: Any
    size: Any

    def __call__(self, motion: Motion, extras: Extras):
        found = self.point.path(motion, extras)
        inside = [
            sign * (found[:, axis] - side) for axis, sign, side in zip(self.axes, self.signs, self.sides, strict=True)
        ]
        return jnp.concatenate(inside) / self.size


def in_box(part: str, point: Sequence[float | int] | str, lower: Sequence[float], upper: Sequence[float]) -> Constraint:
    """Demand that a point of a part, given in the assembled pose or as the name of an extra variable, stays within a
    box (x, y, z).

    Use infinity where a side is open. Distances to the sides are divided by the range of the numbers of all sides, or
    by one where there is a single side.
    """
    low = given.corner(lower, "in_box: lower", "-inf")
    high = given.corner(upper, "in_box: upper", "inf")
    if np.any(low > high) or np.any(low == np.inf) or np.any(high == -np.inf):
        raise ValueError(f"in_box: lower must be below upper, got {lower!r} and {upper!r}")
    closed = [(k, 1, float(low[k])) for k in range(3) if np.isfinite(low[k])]
    closed += [(k, -1, float(high[k])) for k in range(3) if np.isfinite(high[k])]
    if not closed:
        raise ValueError("in_box: a box that is open on all sides bounds nothing; give at least one finite side")
    axes, signs, sides = (tuple(each) for each in zip(*closed, strict=True))
    size = float(np.ptp(sides)) or 1.0
    return _InBox(part_point(part, point, "in_box"), axes, signs, sides, size)


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _InSequence(DesignConstraint):
    name = "in_sequence"
    joint: str = field(metadata=STATIC)
    least: Any

    def __call__(self, motion: Motion, extras: Extras):
        values = driven_values(motion, self.joint, "in_sequence")
        rest = (2 * jnp.pi - (values[-1] - values[0]))[None]
        return jnp.concatenate([jnp.diff(values) - self.least, rest]) / (2 * jnp.pi)


def in_sequence(joint: str, *, least: float = 0.0) -> Constraint:
    """Demand that the displacements of a driven joint rise from pose to pose, by `least` at least, and by no more than
    one turn in all.

    The joint is named as in the drive; where it has several coordinates, "joint.coordinate".
    """
    return _InSequence(text(joint, "in_sequence: joint"), given.number(least, "in_sequence: least"))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Above(DesignConstraint):
    name = "above"
    joint: str = field(metadata=STATIC)
    least: Any
    size: Any

    def __call__(self, motion: Motion, extras: Extras):
        return (joint_coordinate(motion, self.joint) - self.least) / self.size


def above(joint: str, least: float, size: float = 1.0) -> Constraint:
    """Demand that a joint's displacement stays at or above a value; `size` makes it a pure number."""
    text(joint, "above: joint")
    return _Above(joint, given.number(least, "above: least"), given.positive(size, "above: size"))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Apart(DesignConstraint):
    name = "apart"
    one: Shape
    other: Shape
    least: Any

    def __call__(self, motion: Motion, extras: Extras):
        origins = jnp.concatenate([jnp.asarray(each.frames_1)[:, :3, 3] for each in motion.mechanism.all_joints])
        _, size = centroid_and_length(jax.lax.stop_gradient(origins))
        return (clearance(motion, self.one, self.other, extras) - self.least) / size


def apart(one: Shape, other: Shape, least: float | int = 0.0) -> Constraint:
    """Demand that two shapes stay at least `least` apart in every pose: see `clearance`.

    Clearances are divided by the root-mean-square distance of the joints from their centre.
    """
    check_shapes(one, other, "apart")
    return _Apart(one, other, given.number(least, "apart: least"))
