"""Prove that the input can be moved from the assembled pose to a pose: no discriminant vanishes on the way.

The discriminants f of all groups are known at equidistant nodes, h apart. Between two nodes they are bounded by
differences of the nodes nearby: the second differences stand for h^2 times the second derivative, the third ones for
h^3 times the third. The assembled pose is one of the nodes, from which the ways lead upwards and downwards; or it is
the first node as well as the last, a full turn later, and both ways lead to every pose.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.equations import namespace, ratio

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

Numbers = Array | np.ndarray


class Way(NamedTuple):
    """What is known of a line of nodes, and of the intervals between neighbouring ones."""

    x: Float[Numbers, "columns nodes"]
    """Coordinates, angles unwrapped along the line."""
    passes: Bool[Numbers, ""]
    """Whether the motion passes all intervals."""
    limited: Bool[Numbers, ""]
    """Whether there surely is a limit."""
    table: Float[Numbers, "rows intervals"]
    """What `reach` reads of the interval of a pose, in the order of its lines."""


def way(
    x: Float[Numbers, "columns nodes"],
    discriminant: Float[Numbers, "groups nodes"],
    angles: Float[np.ndarray, "_ 1"],
    first: int,
    last: int,
) -> Way:
    """Judge a line of nodes, travelled upwards from the node `first` and downwards from the node `last`.

    `angles` is 1 for coordinates that are angles up to full turns, else 0.
    """
    xp = namespace(x)
    turns = angles * xp.round(xp.diff(x, axis=1) / TURN)
    # sums of blocks, then of blocks before them: products of small matrices, which XLA does faster than sums one by one
    blocks = turns.reshape(len(x), -1, BLOCK)
    within = blocks @ np.tri(BLOCK).T
    before = within[:, :, -1] @ np.tri(blocks.shape[1], k=-1).T
    sums = (within + before[:, :, None]).reshape(turns.shape)
    x = x - TURN * xp.pad(sums, ((0, 0), (1, 0)))
    steep = xp.max(xp.abs(angles * xp.diff(x, axis=1)), axis=0) > MAX_TURN

    # h^2 |f"| of each interval is at most `curvature`
    one, other, change = discriminant[:, :-1], discriminant[:, 1:], xp.diff(discriminant, axis=1)
    second = xp.diff(discriminant, n=2, axis=1)
    third = xp.pad(xp.abs(xp.diff(second, axis=1)), ((0, 0), (2, 2)), mode="edge")  # of intervals -1 ... n
    third = xp.maximum(xp.maximum(third[:, :-2], third[:, 1:-1]), third[:, 2:])
    second = xp.pad(second, ((0, 0), (1, 1)), mode="edge")  # of all nodes
    curvature = xp.maximum(xp.abs(second[:, :-1]), xp.abs(second[:, 1:])) + 2 * third
    # the slope differs from the mean one by at most half of h |f"|
    monotone = xp.abs(change) > 0.5 * curvature
    bend = xp.maximum(second[:, :-1], second[:, 1:])
    dip = ratio((0.5 * bend - change) ** 2, 2 * bend)
    least = xp.where(xp.abs(change) < 0.5 * bend, one - dip, xp.minimum(one, other))
    least = least - xp.where(monotone, 0.0, 2 * PARABOLA_ERROR * third)
    blocked = xp.any(least <= LEAST_DISCRIMINANT, axis=0) | steep
    beyond = xp.any(discriminant < -LEAST_DISCRIMINANT, axis=0)

    count = blocked.shape[0]
    number = np.arange(count)
    block_above = xp.min(xp.where(blocked & (number >= first), number, count))
    block_below = xp.max(xp.where(blocked & (number < last), number, -1))
    limit_above = xp.min(xp.where(beyond[1:] & (number >= first), number, count))
    limit_below = xp.max(xp.where(beyond[:-1] & (number < last), number, -1))
    facts = xp.stack(
        [
            (first <= number) & (number <= block_above) & ~steep,
            (number < last) & (number >= block_below) & ~steep,
            number > limit_above,
            number < limit_below,
        ]
    )
    rows = x[:, :-1], one, other, curvature, monotone, facts
    table = xp.concatenate([row.astype(x.dtype) for row in rows])
    return Way(x, ~xp.any(blocked), xp.any(beyond), table)


class Reach(NamedTuple):
    """What a way says of poses, upwards and downwards."""

    x: Float[Array, "columns poses"]
    """Coordinates of the node below each pose."""
    passed: tuple[Bool[Array, " poses"], Bool[Array, " poses"]]
    """To which poses the motion passes, upwards and downwards, if the loops close there."""
    crossed: tuple[Bool[Array, " poses"], Bool[Array, " poses"]]
    """Before which poses there surely is a limit, upwards and downwards."""


def reach(
    table: Float[Numbers, "rows intervals"],
    columns: int,
    position: Float[Array, " poses"],
    discriminant: Float[Array, "groups poses"],
) -> Reach:
    """Tell to which poses the motion passes, by the table of a way of so many `columns`.

    `position` of a pose is counted in nodes. Between a node and a pose in the next interval, f is not below the lesser
    of its values there by more than (distance^2 / 8) |f"|. Where it is monotone, it is not below its value at the pose,
    which may be as near to a limit as it likes, since the loops close there.
    """
    xp, groups = namespace(position), len(discriminant)
    interval = xp.clip(xp.floor(position), 0, table.shape[1] - 1)
    chosen = xp.asarray(table)[:, interval.astype(np.int32)]  # gathered once
    x, below, above, curvature, monotone, facts = xp.split(chosen, np.cumsum([columns, *[groups] * 4]))

    def bounded(at_node: Numbers, distance: Numbers) -> Bool[Numbers, " poses"]:
        bound = xp.minimum(at_node, discriminant) - 0.125 * distance * distance * curvature
        return xp.all(xp.where(monotone > 0, at_node, bound) > LEAST_DISCRIMINANT, axis=0)

    from_below, from_above, after_limit, before_limit = facts > 0
    distance = position - interval
    passed = from_below & bounded(below, distance), from_above & bounded(above, 1 - distance)
    return Reach(x, passed, (after_limit, before_limit))
