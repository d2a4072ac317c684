"""Constraints: functions of a motion (and of the extra variables) whose values must not be negative.

Each is without unit, so that one penalty serves all: lengths are divided by a length of the mechanism.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import jax.numpy as jnp
import numpy as np

from jaxkin.design.measures import joint_coordinate, length_now, transmission_angle
from jaxkin.mechanism.motion import Motion

Constraint = Callable[[Motion, Mapping[str, Any]], Any] | Callable[[Motion], Any]
Key = tuple[str, ...]


def full_crank(ground: Key, crank: Key, coupler: Key, rocker: Key) -> Constraint:
    """Demand that the crank of a four-bar turns fully: it is the shortest bar, and with each other one no longer than
    the rest.

    The four bars are named as in `with_lengths`. For a rocker that turns fully too (a double crank), name the
    ground first and the crank in its place.
    """

    def margins(motion: Motion, extras: Mapping[str, Any]):
        g, a, b, c = (length_now(motion.mechanism, key) for key in (ground, crank, coupler, rocker))
        total = g + a + b + c
        return jnp.stack([total - 2 * (a + other) for other in (g, b, c)]) / total

    return margins


def grashof(*bars: Key) -> Constraint:
    """Demand that some bar of a four-bar turns fully: the shortest and the longest are no longer than the other two."""
    if len(bars) != 4:
        raise ValueError(f"grashof: name the four bars of a four-bar by their keys as in with_lengths, got {len(bars)}")

    def margins(motion: Motion, extras: Mapping[str, Any]):
        lengths = jnp.sort(jnp.stack([jnp.asarray(length_now(motion.mechanism, key)) for key in bars]))
        return (lengths[1] + lengths[2] - lengths[0] - lengths[3])[None] / jnp.sum(lengths)

    return margins


def transmission_within(joint: str, ends: tuple[str, str], least: float, largest: float = np.pi) -> Constraint:
    """Demand that the transmission angle (see `transmission_angle`) stays between two angles, in radians."""

    def margins(motion: Motion, extras: Mapping[str, Any]):
        angle = transmission_angle(motion, joint, ends)
        return jnp.concatenate([angle - least, largest - angle])

    return margins


def in_box(part: str, point: Sequence[float | int] | str, lower: Sequence[float], upper: Sequence[float]) -> Constraint:
    """Demand that a point of a part, given in the assembled pose or as the name of an extra variable, stays within a
    box (x, y, z).

    Use infinity where a side is open.
    """
    low, high = np.asarray(lower, float), np.asarray(upper, float)
    sides = np.concatenate([low[np.isfinite(low)], high[np.isfinite(high)]])
    size = max(float(np.ptp(sides)) if sides.size > 1 else 0.0, 1e-300) or 1.0

    def margins(motion: Motion, extras: Mapping[str, Any]):
        found = motion.points(part, extras[point] if isinstance(point, str) else point)
        inside = [found[:, k] - low[k] for k in range(3) if np.isfinite(low[k])]
        inside += [high[k] - found[:, k] for k in range(3) if np.isfinite(high[k])]
        return jnp.concatenate(inside) / size

    return margins


def in_sequence(joint: str, *, least: float = 0.0) -> Constraint:
    """Demand that the driven displacements rise from pose to pose, by `least` at least, and by no more than one turn in
    all."""

    def margins(motion: Motion, extras: Mapping[str, Any]):
        values = motion.inputs[
            joint if joint in motion.inputs else next(n for n in motion.inputs if n.startswith(joint))
        ]
        return jnp.concatenate([jnp.diff(values) - least, (2 * jnp.pi - (values[-1] - values[0]))[None]]) / (2 * jnp.pi)

    return margins


def above(joint: str, least: float, size: float = 1.0) -> Constraint:
    """Demand that a joint's displacement stays at or above a value; `size` makes it a pure number."""

    def margins(motion: Motion, extras: Mapping[str, Any]):
        return (joint_coordinate(motion, joint) - least) / size

    return margins
