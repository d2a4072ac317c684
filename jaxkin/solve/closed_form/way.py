"""Prove that the input can be moved from the assembled pose to a pose: no discriminant vanishes on the way.

The discriminants f of all groups are known at nodes, h apart, the first of which is the assembled pose. Between two
nodes they are bounded by differences of the nodes nearby: the second differences stand for h^2 times the second
derivative, the third ones for h^3 times the third.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.equations import ratio

LEAST_DISCRIMINANT = 1e-6
"""Discriminant over its largest value below which an interval is not passed: a change point, where it is zero, is
passed on another branch, and 1e-6 away the coordinates are still right to a thousand roundings."""
MAX_TURN = 1.5
"""Largest change of an angle from node to node, radians: more than half a turn would be unwrapped wrongly."""
PARABOLA_ERROR = 0.064
"""Largest error of a parabola through three nodes between two of them, over h^3 times the third derivative: that of
t (t - 1) (t + 1) / 6 for t from 0 to 1."""


class Way(NamedTuple):
    """What is known between neighbouring nodes, from the assembled pose outwards."""

    x: Float[Array, "columns intervals"]
    """Coordinates of the node at which an interval begins, angles unwrapped."""
    discriminant: Float[Array, "groups intervals"]
    """Those of that node."""
    curvature: Float[Array, "groups intervals"]
    """Upper bound of h^2 |f"| in the interval."""
    monotone: Bool[Array, "groups intervals"]
    """Whether f surely rises or falls in the whole interval."""
    free: Bool[Array, " intervals"]
    """Whether the motion passes to the interval, and no angle changes there by more than `MAX_TURN`."""
    crossed: Bool[Array, " intervals"]
    """Whether there surely is a limit before the interval."""
    end: Float[Array, "columns 1"]
    """Coordinates of the last node."""
    passes: Bool[Array, ""]
    """Whether the motion passes to the last node."""
    limited: Bool[Array, ""]
    """Whether there surely is a limit."""


class Reach(NamedTuple):
    """What a way says of poses."""

    x: Float[Array, "columns poses"]
    """Coordinates nearby, unwrapped along the way."""
    passed: Bool[Array, " poses"]
    """To which poses the motion passes, if the loops close there."""
    crossed: Bool[Array, " poses"]
    """Before which poses there surely is a limit."""


def way(
    x: Float[Array, "columns nodes"], discriminant: Float[Array, "groups nodes"], unwrapped: Float[np.ndarray, "_ 1"]
) -> Way:
    """Judge the way along equidistant nodes, the first of which is the assembled pose.

    `unwrapped` is 1 for coordinates that are angles up to full turns, else 0.
    """
    steps = jnp.diff(x, axis=1)
    steps = steps - unwrapped * TURN * jnp.round(steps / TURN)
    steep = jnp.max(jnp.abs(unwrapped * steps), axis=0) > MAX_TURN

    one, other, change = discriminant[:, :-1], discriminant[:, 1:], jnp.diff(discriminant, axis=1)
    second = jnp.diff(discriminant, n=2, axis=1)
    third = jnp.pad(jnp.abs(jnp.diff(second, axis=1)), ((0, 0), (2, 2)), mode="edge")  # of intervals -1 ... n
    third = jnp.maximum(jnp.maximum(third[:, :-2], third[:, 1:-1]), third[:, 2:])
    second = jnp.pad(second, ((0, 0), (1, 1)), mode="edge")  # of all nodes
    curvature = jnp.maximum(jnp.abs(second[:, :-1]), jnp.abs(second[:, 1:])) + 2 * third
    # the slope differs from the mean one by at most half of h |f"|
    monotone = jnp.abs(change) > 0.5 * curvature
    bend = jnp.maximum(second[:, :-1], second[:, 1:])
    dip = ratio((0.5 * bend - change) ** 2, 2 * bend)
    least = jnp.where(jnp.abs(change) < 0.5 * bend, one - dip, jnp.minimum(one, other))
    least = least - jnp.where(monotone, 0.0, 2 * PARABOLA_ERROR * third)
    blocked = jnp.any(least <= LEAST_DISCRIMINANT, axis=0) | steep
    beyond = jnp.any(other < -LEAST_DISCRIMINANT, axis=0)

    before = _sums_before(jnp.concatenate([steps, jnp.stack([blocked, beyond]).astype(steps.dtype)]))
    path, (blocks, limits) = x[:, :1] + before[:-2], before[-2:]
    free = (blocks[:-1] == 0) & ~steep
    crossed = limits[:-1] > 0
    return Way(path[:, :-1], one, curvature, monotone, free, crossed, path[:, -1:], blocks[-1] == 0, limits[-1] > 0)


def reach(way: Way, position: Float[Array, " poses"], discriminant: Float[Array, "groups poses"]) -> Reach:
    """Tell to which poses the motion passes, which have these positions on the way, counted in nodes from the first.

    Between a node and a pose in the next interval, f is not below the lesser of its values there by more than
    (distance^2 / 8) |f"|. Where it is monotone, it is not below its value at the pose, which may be as near to a limit
    as it likes, since the loops close there.
    """
    columns, groups = len(way.x), len(way.discriminant)
    rows = [*way[:3], way.monotone, way.free[None], way.crossed[None]]
    table = jnp.concatenate([row.astype(way.x.dtype) for row in rows])  # gathered once: a row a pose
    interval = jnp.clip(jnp.floor(position), 0, table.shape[1] - 1)
    chosen = table.T[interval.astype(jnp.int32)].T
    x, one, curvature, monotone, (free, crossed) = jnp.split(chosen, np.cumsum([columns, groups, groups, groups]))
    distance = position - interval
    bound = jnp.minimum(one, discriminant) - 0.125 * distance * distance * curvature
    least = jnp.where(monotone > 0, one, bound)
    return Reach(x, (free > 0) & jnp.all(least > LEAST_DISCRIMINANT, axis=0), crossed > 0)


def _sums_before(steps: Float[Array, "rows intervals"]) -> Float[Array, "rows nodes"]:
    """Sum the intervals before each node: by a product of matrices, which XLA does faster than sums one by one."""
    count = steps.shape[1]
    before = np.arange(count)[:, None] < np.arange(count + 1)
    return steps @ jnp.asarray(before, steps.dtype)
