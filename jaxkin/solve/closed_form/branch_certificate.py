"""Certify that a pose is on the branch of the assembled pose: no discriminant vanishes at any input between them.

The discriminants f of all groups are known at equidistant nodes, h apart. Between two nodes they are bounded by
differences of the nodes nearby: the second differences stand for h^2 times the second derivative, the third ones for
h^3 times the third. The assembled pose is one of the nodes, from which the input rises or falls; or it is the first
node as well as the last, a full turn later, and every pose is reached both by rising and by falling.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.arithmetic import namespace, ratio
from jaxkin.solve.closed_form.complex_numbers import Complex, rough_argument

LEAST_DISCRIMINANT = 1e-6
"""Discriminant over its largest value below which an interval is not passed: a change point, where it is zero, is
passed on another branch, and 1e-6 away the coordinates are still right to a thousand roundings."""
MAX_TURN = 1.5
"""Largest change of an angle from node to node, radians: more than half a turn would be unwrapped wrongly."""
BLOCK = 16
"""Intervals whose turns are summed at once."""
PARABOLA_ERROR = 0.064
"""Largest error of a parabola through three nodes between two of them, over h^3 times the third derivative: that of
t (t - 1) (t + 1) / 6 for t from 0 to 1."""

NodeRows = Sequence[Float[Array | np.ndarray, " _"]] | Float[Array | np.ndarray, "_ _"]
"""Rows of numbers at the nodes, or at the intervals between them; of a known line one array, so that a program that is
given the line has few arguments."""


class LineCertificate(NamedTuple):
    """What the discriminants at the nodes of a line prove of the intervals between neighbouring nodes."""

    passes: Bool[Array | np.ndarray, ""]
    """Whether the motion passes all intervals."""
    limited: Bool[Array | np.ndarray, ""]
    """Whether there surely is a limit."""
    blocked: tuple[Int[Array | np.ndarray, ""], Int[Array | np.ndarray, ""]]
    """The first intervals downwards and upwards that the motion may not pass as a whole; -1 and their number if it
    does."""
    table: list[Float[Array | np.ndarray, " intervals"]]
    """What `certify_poses` reads of the interval of a pose, in the order of its lines."""


def surely_passes(discriminants: NodeRows, steep: Bool[Array | np.ndarray, " intervals"]) -> Bool[Array, ""]:
    """Tell whether the motion passes a line by a wide margin, by the largest differences of the whole line.

    It costs less than `certify_line`, which may find that the motion passes where this does not.
    """
    passes = ~jnp.any(steep)
    for f in discriminants:
        change = f[1:] - f[:-1]
        second = change[1:] - change[:-1]
        third = second[1:] - second[:-1]
        curvature = jnp.max(jnp.abs(second)) + 2 * jnp.max(jnp.abs(third))
        passes &= jnp.min(f) - 0.125 * curvature > LEAST_DISCRIMINANT
    return passes


def certify_line(
    discriminants: NodeRows, steep: Bool[Array | np.ndarray, " intervals"], first: int, last: int
) -> LineCertificate:
    """Judge a line of nodes, travelled upwards from the node `first` and downwards from the node `last`.

    `discriminants` are those of all groups at all nodes; `steep` are intervals in which a turn is too large to unwrap.
    """
    xp = namespace(steep, *discriminants)
    blocked, beyond, rows = steep, np.zeros(len(steep) + 1, bool), []
    for f in discriminants:
        found = _bounds(f)
        blocked = blocked | (found.least <= LEAST_DISCRIMINANT)
        beyond = beyond | (f < -LEAST_DISCRIMINANT)
        rows += [f[:-1], f[1:], found.curvature, found.monotone]

    count = len(steep)
    number = np.arange(count)
    block_above = xp.min(xp.where(blocked & (number >= first), number, count))
    block_below = xp.max(xp.where(blocked & (number < last), number, -1))
    limit_above = xp.min(xp.where(beyond[1:] & (number >= first), number, count))
    limit_below = xp.max(xp.where(beyond[:-1] & (number < last), number, -1))
    facts = [
        (first <= number) & (number <= block_above) & ~steep,
        (number < last) & (number >= block_below) & ~steep,
        number > limit_above,
        number < limit_below,
    ]
    table = [row.astype(float) for row in (*facts, *rows)]
    return LineCertificate(~xp.any(blocked), xp.any(beyond), (block_below, block_above), table)


def unwrapped(turns: Sequence[Complex]) -> list[Float[Array | np.ndarray, " nodes"]]:
    """Compute the angles of turns at all nodes, radians, right to 0.08, each the nearest to the one before."""
    if not turns:
        return []
    xp = namespace(*turns[0])
    angles = [xp.asarray(rough_argument(turn)) for turn in turns]
    changed = xp.stack([turns_leapt(angle) for angle in angles])
    return [angle - TURN * row for angle, row in zip(angles, summed(changed), strict=True)]


def turns_leapt(angles: Float[Array | np.ndarray, "*angles nodes"]) -> Float[Array | np.ndarray, "*angles intervals"]:
    """Count by how many full turns principal values leap between neighbouring nodes: -1, 0 or 1."""
    return namespace(angles).round((angles[..., 1:] - angles[..., :-1]) / TURN)


def summed(changed: Float[Array | np.ndarray, "angles intervals"]) -> Float[Array | np.ndarray, "angles nodes"]:
    """Sum up the full turns that angles leap, from the first node to each.

    Sums of blocks, then of blocks before them: products of small matrices, which XLA does faster than sums one by one.
    """
    xp, (count, intervals) = namespace(changed), changed.shape
    blocks = xp.pad(changed, ((0, 0), (0, -intervals % BLOCK))).reshape(count, -1, BLOCK)
    within = blocks @ np.tri(BLOCK).T
    before = within[:, :, -1] @ np.tri(blocks.shape[1], k=-1).T
    sums = (within + before[:, :, None]).reshape(count, -1)[:, :intervals]
    return xp.concatenate([np.zeros((count, 1)), sums], axis=1)


def are_steep(turns: Sequence[Complex], nodes: int) -> Bool[Array | np.ndarray, " intervals"]:
    """Tell in which intervals between so many nodes any angle changes by more than `MAX_TURN`: by the least cosine."""
    if not turns:
        return np.zeros(nodes - 1, bool)
    xp = namespace(*turns[0])
    least: Any = np.ones(nodes - 1)
    for turn in turns:
        real, imag = map(xp.asarray, turn)
        least = xp.minimum(least, real[1:] * real[:-1] + imag[1:] * imag[:-1])
    return least < math.cos(MAX_TURN)


class _Bounds(NamedTuple):
    """What is known of a discriminant f between neighbouring nodes, h apart."""

    least: Float[Array | np.ndarray, " intervals"]
    """f is not below it."""
    curvature: Float[Array | np.ndarray, " intervals"]
    """h^2 |f"| is at most so much."""
    monotone: Bool[Array | np.ndarray, " intervals"]
    """Whether f only rises or only falls."""


def _bounds(f: Float[Array | np.ndarray, " nodes"]) -> _Bounds:
    """Bound a discriminant between neighbouring nodes by its differences."""
    xp = namespace(f)
    one, other, change = f[:-1], f[1:], f[1:] - f[:-1]
    second = change[1:] - change[:-1]
    third = xp.abs(second[1:] - second[:-1])
    # at both ends those of the nearest nodes
    third = xp.concatenate([third[:1], third[:1], third, third[-1:], third[-1:]])
    third = xp.maximum(xp.maximum(third[:-2], third[1:-1]), third[2:])
    second = xp.concatenate([second[:1], second, second[-1:]])  # of all nodes
    curvature = xp.maximum(xp.abs(second[:-1]), xp.abs(second[1:])) + 2 * third
    # the slope differs from the mean one by at most half of h |f"|
    monotone = xp.abs(change) > 0.5 * curvature
    bend = xp.maximum(second[:-1], second[1:])
    dip = ratio((0.5 * bend - change) ** 2, 2 * bend)
    least = xp.where(xp.abs(change) < 0.5 * bend, one - dip, xp.minimum(one, other))
    return _Bounds(least - xp.where(monotone, 0.0, 2 * PARABOLA_ERROR * third), curvature, monotone)


class PoseCertificates(NamedTuple):
    """What the certificate of a line proves of poses, upwards and downwards."""

    passed: tuple[Bool[Array, " poses"], Bool[Array, " poses"]]
    """To which poses the motion passes, upwards and downwards, if the loops close there."""
    crossed: tuple[Bool[Array, " poses"], Bool[Array, " poses"]]
    """Before which poses there surely is a limit, upwards and downwards."""


def certify_poses(
    table: NodeRows,
    interval: Int[Array, " poses"],
    distance: Float[Array, " poses"],
    discriminants: Sequence[Array | np.ndarray],
) -> PoseCertificates:
    """Tell to which poses the motion passes, by the table of a `LineCertificate`.

    A pose is in an `interval`, at a `distance` from its lower node, counted in nodes. Between a node and a pose in the
    next interval, f is not below the lesser of its values there by more than (distance^2 / 8) |f"|. Where it is
    monotone, it is not below its value at the pose, which may be as near to a limit as it likes, since the loops close
    there.
    """
    chosen = [at_intervals(row, interval) for row in table]
    from_below, from_above, after_limit, before_limit = (row > 0 for row in chosen[:4])
    for number, f in enumerate(discriminants):
        below, above, curvature, monotone = chosen[4 + 4 * number : 8 + 4 * number]

        def bounded(at_node: Array, far: Array, f=f, curvature=curvature, monotone=monotone) -> Bool[Array, " poses"]:
            bound = jnp.minimum(at_node, f) - 0.125 * far * far * curvature
            return jnp.where(monotone > 0, at_node, bound) > LEAST_DISCRIMINANT

        from_below &= bounded(below, distance)
        from_above &= bounded(above, 1 - distance)
    return PoseCertificates((from_below, from_above), (after_limit, before_limit))


def certify_nodes(line: LineCertificate, groups: int) -> PoseCertificates:
    """Tell to which nodes the motion passes over a full turn, by the table of its line, of so many groups.

    A node is judged as a pose at the far end of the interval that leads to it; the assembled pose, at both ends of the
    line, is where the motion begins.
    """
    from_below, from_above, after_limit, before_limit = (row > 0 for row in line.table[:4])
    for below, above, curvature, monotone in (line.table[4 + 4 * k : 8 + 4 * k] for k in range(groups)):
        bound = jnp.minimum(below, above) - 0.125 * curvature
        from_below &= jnp.where(monotone > 0, below, bound) > LEAST_DISCRIMINANT
        from_above &= jnp.where(monotone > 0, above, bound) > LEAST_DISCRIMINANT
    block_below, block_above = line.blocked
    number = np.arange(len(from_below))
    here, limited = np.ones(1, bool), jnp.reshape(line.limited, 1)
    return PoseCertificates(
        (
            jnp.concatenate([here, from_below | (number < block_above)]),
            jnp.concatenate([from_above | (number > block_below), here]),
        ),
        (jnp.concatenate([after_limit, limited]), jnp.concatenate([limited, before_limit])),
    )


def at_intervals(
    row: Float[Array | np.ndarray, " intervals"], interval: Int[Array, " poses"]
) -> Float[Array, " poses"]:
    """Look up the entry of the interval of each pose."""
    return jnp.asarray(row).at[interval].get(mode="clip")
