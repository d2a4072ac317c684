"""Prove that the input can be moved from the assembled pose to a pose: no discriminant vanishes on the way.

The discriminants f of all groups are known at equidistant nodes, h apart. Between two nodes they are bounded by
differences of the nodes nearby: the second differences stand for h^2 times the second derivative, the third ones for
h^3 times the third. The assembled pose is one of the nodes, from which the ways lead upwards and downwards; or it is
the first node as well as the last, a full turn later, and both ways lead to every pose.
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
BLOCK = 16
"""Intervals whose turns are summed at once; their number must be a multiple."""
PARABOLA_ERROR = 0.064
"""Largest error of a parabola through three nodes between two of them, over h^3 times the third derivative: that of
t (t - 1) (t + 1) / 6 for t from 0 to 1."""


class Way(NamedTuple):
    """What is known of a line of nodes, and of the intervals between neighbouring ones."""

    x: Float[Array, "columns nodes"]
    """Coordinates, angles unwrapped along the line."""
    discriminant: Float[Array, "groups nodes"]
    curvature: Float[Array, "groups intervals"]
    """Upper bound of h^2 |f"|."""
    monotone: Bool[Array, "groups intervals"]
    """Whether f surely rises or falls in the whole interval."""
    steep: Bool[Array, " intervals"]
    """Whether an angle changes by more than `MAX_TURN`."""
    blocked: Bool[Array, " intervals"]
    """Which intervals are not passed."""
    beyond: Bool[Array, " nodes"]
    """Which nodes are surely beyond a limit."""

    @property
    def passes(self) -> Bool[Array, ""]:
        """Whether the motion passes all intervals."""
        return ~jnp.any(self.blocked)

    @property
    def limited(self) -> Bool[Array, ""]:
        """Whether there surely is a limit."""
        return jnp.any(self.beyond)


class Reach(NamedTuple):
    """What a way says of poses, upwards and downwards."""

    x: Float[Array, "columns poses"]
    """Coordinates of the node below each pose."""
    passed: tuple[Bool[Array, " poses"], Bool[Array, " poses"]]
    """To which poses the motion passes, upwards and downwards, if the loops close there."""
    crossed: tuple[Bool[Array, " poses"], Bool[Array, " poses"]]
    """Before which poses there surely is a limit, upwards and downwards."""


def way(
    x: Float[Array, "columns nodes"], discriminant: Float[Array, "groups nodes"], angles: Float[np.ndarray, "_ 1"]
) -> Way:
    """Judge a line of nodes. `angles` is 1 for coordinates that are angles up to full turns, else 0."""
    turns = angles * jnp.round(jnp.diff(x, axis=1) / TURN)
    # sums of blocks, then of blocks before them: products of small matrices, which XLA does faster than sums one by one
    blocks = turns.reshape(len(x), -1, BLOCK)
    within = blocks @ np.tri(BLOCK).T
    before = within[:, :, -1] @ np.tri(blocks.shape[1], k=-1).T
    sums = (within + before[:, :, None]).reshape(turns.shape)
    x = x - TURN * jnp.pad(sums, ((0, 0), (1, 0)))
    steep = jnp.max(jnp.abs(angles * jnp.diff(x, axis=1)), axis=0) > MAX_TURN

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
    beyond = jnp.any(discriminant < -LEAST_DISCRIMINANT, axis=0)
    return Way(x, discriminant, curvature, monotone, steep, blocked, beyond)


def reach(
    way: Way, first: int, last: int, position: Float[Array, " poses"], discriminant: Float[Array, "groups poses"]
) -> Reach:
    """Tell to which poses the motion passes, upwards from the node `first` and downwards from the node `last`.

    `position` of a pose is counted in nodes. Between a node and a pose in the next interval, f is not below the lesser
    of its values there by more than (distance^2 / 8) |f"|. Where it is monotone, it is not below its value at the pose,
    which may be as near to a limit as it likes, since the loops close there.
    """
    columns, groups, count = len(way.x), len(way.discriminant), way.blocked.shape[0]
    number = np.arange(count)
    block_above = jnp.min(jnp.where(way.blocked & (number >= first), number, count))
    block_below = jnp.max(jnp.where(way.blocked & (number < last), number, -1))
    limit_above = jnp.min(jnp.where(way.beyond[1:] & (number >= first), number, count))
    limit_below = jnp.max(jnp.where(way.beyond[:-1] & (number < last), number, -1))
    facts = jnp.stack(
        [
            (first <= number) & (number <= block_above) & ~way.steep,
            (number < last) & (number >= block_below) & ~way.steep,
            number > limit_above,
            number < limit_below,
        ]
    )
    rows = way.x[:, :-1], way.discriminant[:, :-1], way.discriminant[:, 1:], way.curvature, way.monotone, facts
    table = jnp.concatenate([row.astype(way.x.dtype) for row in rows])  # gathered once
    interval = jnp.clip(jnp.floor(position), 0, count - 1)
    chosen = table[:, interval.astype(jnp.int32)]
    ends = np.cumsum([columns, *[groups] * 4])
    x, below, above, curvature, monotone, facts = jnp.split(chosen, ends)

    def bounded(at_node: Array, distance: Array) -> Bool[Array, " poses"]:
        bound = jnp.minimum(at_node, discriminant) - 0.125 * distance * distance * curvature
        return jnp.all(jnp.where(monotone > 0, at_node, bound) > LEAST_DISCRIMINANT, axis=0)

    from_below, from_above, after_limit, before_limit = facts > 0
    distance = position - interval
    passed = from_below & bounded(below, distance), from_above & bounded(above, 1 - distance)
    return Reach(x, passed, (after_limit, before_limit))
