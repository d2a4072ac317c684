"""Remove the idle spin of rods between two balls: the rotation about the line of their centres, which no loop fixes.

Least-norm steps leave some spin, which depends on the path. It is replaced by the spin at which both balls are rotated
least from the assembled pose. With the quaternion `(w, v)` of each ball and the unit vector `n` along the line, fixed
in the rod, this spin minimises the sum of `|v|^2` over both balls. A further spin by `phi` makes the sum a constant
less `(b cos phi - a sin phi)/2`, where `a = sum 2 w v.n` and `b = sum w^2 - (v.n)^2`. So equal inputs give equal poses,
whatever path led to them.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from operator import add

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry.trig import cos_sin
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import Rotations, State, matrix, multiply

Lines = Float[Array, "spins 2 3"]
"""For each rod the unit vector from its first to its second ball, in the frames of both balls on the rod. The sign is
that of the spin: reversed at a ball whose joint has the rod as part 1."""


def spin_lines(system: LoopSystem, frames: Float[Array, "frames 4 4"]) -> Lines:
    """Compute the lines from the frames of all joints: first those on part 1, joint by joint, then those on part 2."""
    of_ball, first = np.zeros(len(system.balls), np.int32), 0
    for chain in system.chains:
        for _, frame, _, ball in chain:
            if ball is not None:
                of_ball[ball] = first + frame
        first += len(chain)
    table = np.array(system.spins, np.int32).reshape(-1, 4)
    side = table[:, 2:]
    ends = frames[of_ball[table[:, :2]] + np.where(side > 0, first, 0)]
    line = ends[:, 1, :3, 3] - ends[:, 0, :3, 3]
    line = line / jnp.sqrt(jnp.sum(line * line, axis=1, keepdims=True))
    return jnp.einsum("sbij,si->sbj", ends[..., :3, :3], line) * jnp.asarray(side[..., None], frames.dtype)


def _spins(
    system: LoopSystem, lines: Lines, rotations: Mapping[int, Rotations]
) -> tuple[list[tuple[int, int]], Float[Array, "4 ends poses"]]:
    """Compute (number, side) of both balls of each rod, and for each of these the quaternion that removes the spin."""
    ends = [(ball, side) for one, other, *sides in system.spins for ball, side in zip((one, other), sides, strict=True)]
    rotation = jnp.stack([rotations[ball] for ball, _ in ends], axis=2)
    n = lines.reshape(-1, 3).T[..., None]
    along = reduce(add, (n[i] * each for i, each in enumerate(vee(rotation))))
    aside = [rotation[i, i] - n[i] * reduce(add, (rotation[i, j] * n[j] for j in range(3))) for i in range(3)]
    a, b = (each[::2] + each[1::2] for each in (along, 0.5 * reduce(add, aside)))
    undefined = a * a + b * b < 1e-30  # both balls are rotated by half a turn about an axis at right angles to the line
    phi = -jnp.arctan2(jnp.where(undefined, 0.0, a), jnp.where(undefined, 1.0, b))
    cos, sin = (jnp.repeat(each, 2, axis=0) for each in cos_sin(0.5 * phi))
    return ends, jnp.concatenate([cos[None], sin * n])


def remove_spin_from_rotations(
    system: LoopSystem, lines: Lines, rotations: Mapping[int, Rotations]
) -> dict[int, Rotations]:
    """Remove the spin of all rods from the rotation matrices of the balls, by number."""
    rotations = dict(rotations)
    if not system.spins:
        return rotations
    ends, spins = _spins(system, lines, rotations)
    removing = matrix(spins)
    for number, (ball, side) in enumerate(ends):
        one, other = (rotations[ball], removing[:, :, number])[::side]
        rotations[ball] = reduce(add, (one[:, j, None] * other[None, j] for j in range(3)))
    return rotations


def remove_spin_from_state(system: LoopSystem, lines: Lines, rotations: Mapping[int, Rotations], state: State) -> State:
    """Remove the spin of all rods, at least one, from a state; `rotations` are the matrices of all its balls."""
    quaternions = dict(zip(system.turned_balls, state.turns, strict=True))
    ends, spins = _spins(system, lines, rotations)
    for number, (ball, side) in enumerate(ends):
        if ball in quaternions:
            quaternions[ball] = multiply(*(quaternions[ball], spins[:, number])[::side])
    return State(state.x, jnp.stack([*quaternions.values()]))


def vee(rotation: Float[Array, "3 3 *poses"]) -> Float[Array, "3 *poses"]:
    """Compute the axial vector of (R - R^T)/2: the axis times the sine of the angle, or `2 w v` of a quaternion."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = rotation
    return 0.5 * jnp.stack([zy - yz, xz - zx, yx - xy])


def turn_between(one: Float[Array, "3 *poses"], other: Float[Array, "3 *poses"]) -> Float[Array, "3 3 *poses"]:
    """Compute a rotation matrix [column, row] that turns the direction `one` into `other`, with any spin."""
    one, other = one / lengths(one), other / lengths(other)
    cos, cross = jnp.sum(one * other, axis=0), jnp.cross(one, other, axis=0)
    near = jnp.concatenate([1 + cos[None], cross])
    # the least rotation to the opposite direction is not unique: beyond 90 deg turn by 180 deg about a normal first
    x, y, z = one
    below = 1 + jnp.abs(z)
    across = jnp.stack([1 - x * x / below, -x * y / below, jnp.where(z < 0, x, -x)])
    far = jnp.concatenate(
        [jnp.sum(cross * across, axis=0)[None], (1 - cos) * across - jnp.cross(cross, across, axis=0)]
    )
    turn = jnp.where(cos < 0, far, near)
    return matrix(turn / jnp.sqrt(jnp.sum(turn * turn, axis=0))).swapaxes(0, 1)


def lengths(vectors: Float[Array, "3 *entries"]) -> Float[Array, " *entries"]:
    """Compute the lengths of vectors; for a zero vector 1e-15, with zero derivative."""
    square = jnp.sum(vectors * vectors, axis=0)
    return jnp.sqrt(jnp.where(square > 0, square, 1e-30))
