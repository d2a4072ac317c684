"""The configuration of a loop system: its coordinates, with the turn of every ball pair as a unit quaternion.

The three angles of a ball lock at phi = 90 deg, so the solver never uses them: a ball turns by `exp(delta)` applied on
the left of its present turn, and its angles are only computed at the end (`joint_coordinates`). The line between the
centres of two balls, state (p), turns about the two axes at right angles to it, wherever it points: `exp(delta)` on the
right, no turn about the line itself. Structure of arrays: poses stand last.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import cos_sin
from jaxkin.solve.system.loop_system import LoopSystem

Coordinates = Float[Array, "columns poses"]
Quaternions = Float[Array, "balls 4 poses"]
Rotations = Float[Array, "3 3 poses"]
"""[row, column]."""


class State(NamedTuple):
    """Coordinates of all joints (radians, scaled lengths; the columns of balls are unused) and turns of the balls."""

    x: Coordinates
    turns: Quaternions
    """Quaternions (w, x, y, z) of part 2 relative to part 1, of `LoopSystem.turned_balls`."""


def assembled(system: LoopSystem, poses: int, dtype) -> State:
    """The assembled pose: no displacement anywhere."""
    turn = jnp.array([1.0, 0.0, 0.0, 0.0], dtype)[None, :, None]
    return State(
        jnp.zeros((system.columns, poses), dtype), jnp.broadcast_to(turn, (len(system.turned_balls), 4, poses))
    )


def retract(system: LoopSystem, state: State, delta: Coordinates) -> State:
    """The state moved by `delta`: added to coordinates, a rotation vector on the left of each ball's turn."""
    if not system.turned_balls:
        return State(state.x + delta, state.turns)
    turns = multiply(exponential(_of_balls(system, state, delta)), jnp.moveaxis(state.turns, 0, 1))
    turns = turns / jnp.sqrt(jnp.sum(turns * turns, axis=0))
    return State(jnp.where(turning(system), 0.0, state.x + delta), jnp.moveaxis(turns, 0, 1))


def rate(system: LoopSystem, state: State, delta: Coordinates) -> State:
    """The derivative of `retract(state, t delta)` at t = 0, as a tangent of the state's arrays."""
    if not system.turned_balls:
        return State(delta, jnp.zeros_like(state.turns))
    spin = _of_balls(system, state, delta)
    turns = 0.5 * multiply(jnp.concatenate([jnp.zeros_like(spin[:1]), spin]), jnp.moveaxis(state.turns, 0, 1))
    return State(jnp.where(turning(system), 0.0, delta), jnp.moveaxis(turns, 0, 1))


def difference(a: State, b: State) -> Float[Array, " poses"]:
    """Largest difference of two states: of coordinates, and of turns as an angle (twice that of the quaternions)."""
    largest = jnp.max(jnp.abs(a.x - b.x), axis=0)
    return jnp.maximum(largest, 2 * jnp.max(jnp.abs(a.turns - b.turns), axis=(0, 1), initial=0.0))


def drive(system: LoopSystem, state: State, inputs: Float[Array, "driven poses"]) -> State:
    """The state with the driven coordinates set; a ball is driven by its three angles theta, phi, psi."""
    if not system.driven:
        return state
    state = State(jnp.where(is_driven(system), _spread(system, inputs), state.x), state.turns)
    for number, ball in enumerate(system.turned_balls):
        first, *_ = system.balls[ball]
        if first in system.driven:
            state = State(state.x, state.turns.at[number].set(from_angles(state.x[first : first + 3])))
    return state


def driven_rate(
    system: LoopSystem, state: State, direction: Float[Array, "driven poses"]
) -> tuple[Coordinates, Coordinates]:
    """The change of the driven coordinates in a direction of the inputs, and the same in columns of the Jacobian.

    They differ for a driven ball, which turns by `z psi' + Rz (y phi' + Ry x theta')` while its angles change.
    """
    change = jnp.where(is_driven(system), _spread(system, direction), 0.0)
    columns = change
    for first, *_ in system.balls:
        if first in system.driven:
            _, phi, psi = state.x[first : first + 3]
            d_theta, d_phi, d_psi = change[first : first + 3]
            along, across = jnp.cos(phi) * d_theta, d_phi
            spin = [
                jnp.cos(psi) * along - jnp.sin(psi) * across,
                jnp.sin(psi) * along + jnp.cos(psi) * across,
                d_psi - jnp.sin(phi) * d_theta,
            ]
            columns = columns.at[first : first + 3].set(jnp.stack(spin))
    return change, columns


def _spread(system: LoopSystem, inputs: Float[Array, "driven poses"]) -> Coordinates:
    """The inputs in their columns; anything in the others, zeros where nothing is driven."""
    if not system.driven:
        return jnp.zeros((system.columns, inputs.shape[-1]), inputs.dtype)
    which = np.array([system.driven.index(c) if c in system.driven else 0 for c in range(system.columns)])
    return inputs if len(system.driven) == 1 else inputs[which]


def driven(system: LoopSystem, x: Coordinates) -> Float[Array, "driven poses"]:
    """The driven ones of the coordinates."""
    return jnp.stack([x[column] for column in system.driven]) if system.driven else x[:0]


def is_driven(system: LoopSystem) -> Bool[np.ndarray, "columns 1"]:
    """Which coordinates are given. A mask costs the compiled program less than picking rows and putting them back."""
    return np.isin(np.arange(system.columns), system.driven)[:, None]


def turning(system: LoopSystem) -> Bool[np.ndarray, "columns 1"]:
    """The columns of balls that are solved for: their turns hold what they did."""
    turning = [column for columns in system.balls for column in columns if column not in system.driven]
    return np.isin(np.arange(system.columns), turning)[:, None]


def _of_balls(system: LoopSystem, state: State, delta: Coordinates) -> Float[Array, "3 balls poses"]:
    """Rotation vectors of the balls, applied on the left; none for those that are driven."""
    balls = [system.balls[ball] for ball in system.turned_balls]
    none = system.columns
    which = np.array([(*columns, none)[:3] if columns[0] not in system.driven else [none] * 3 for columns in balls])
    vectors = jnp.concatenate([delta, jnp.zeros_like(delta[:1])])[which.T]
    lines = np.array([len(columns) == 2 for columns in balls])
    if not lines.any():
        return vectors
    along = map(jnp.stack, rotation_matrix(jnp.moveaxis(state.turns, 1, 0)))
    return jnp.where(lines[:, None], sum(axis * part for axis, part in zip(along, vectors, strict=True)), vectors)


def multiply(a: Float[Array, "4 *poses"], b: Float[Array, "4 *poses"]) -> Float[Array, "4 *poses"]:
    """Product of quaternions: the turn b, then the turn a."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return jnp.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ]
    )


def exponential(vector: Float[Array, "3 *poses"]) -> Float[Array, "4 *poses"]:
    """The quaternion of a rotation vector."""
    square = jnp.sum(vector * vector, axis=0)
    small = square < 1e-6
    angle = jnp.sqrt(jnp.where(small, 1.0, square))  # sqrt has no derivative at zero: the other branch is the series
    cos, sin = cos_sin(0.5 * angle)
    half_sinc = jnp.where(small, 0.5 - square / 48.0, sin / angle)
    cos = jnp.where(small, 1.0 - square / 8.0 + square * square / 384.0, cos)
    return jnp.concatenate([cos[None], half_sinc * vector])


def from_angles(angles: Float[Array, "3 poses"]) -> Float[Array, "4 poses"]:
    """The quaternion of T_theta_phi_psi = Rz(psi) Ry(phi) Rx(theta)."""
    half = 0.5 * angles
    (ct, cp, cs), (st, sp, ss) = cos_sin(half)
    return jnp.stack(
        [
            ct * cp * cs + st * sp * ss,
            st * cp * cs - ct * sp * ss,
            ct * sp * cs + st * cp * ss,
            ct * cp * ss - st * sp * cs,
        ]
    )


def rotation_matrix(turn: Float[Array, "4 *poses"]) -> list[list[Array]]:
    """Columns of the rotation matrix of a unit quaternion: entry [column][row]."""
    w, x, y, z = turn
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
        [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
        [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
    ]


def matrix(turn: Float[Array, "4 *poses"]) -> Float[Array, "3 3 *poses"]:
    """The rotation matrix of a unit quaternion, [row, column]."""
    return jnp.stack([jnp.stack(column) for column in rotation_matrix(turn)], axis=1)


def angles(rotation: Float[Array, "3 3 *poses"]) -> Float[Array, "3 *poses"]:
    """The paper's theta, phi, psi of rotation matrices; at phi = +-90 deg, where they lock, theta is taken as zero.

    However near to the lock, together they give the turn to rounding: psi and phi are read from what theta leaves.
    """
    (_, xy, xz), (_, yy, yz), (zx, zy, zz) = rotation
    locked = zy * zy + zz * zz < 1e-30  # entries of rotation matrices are right to 1e-16
    theta = jnp.where(locked, 0.0, jnp.arctan2(jnp.where(locked, 0.0, zy), jnp.where(locked, 1.0, zz)))
    cos, sin = cos_sin(theta)
    psi = jnp.arctan2(sin * xz - cos * xy, cos * yy - sin * yz)
    return jnp.stack([theta, jnp.arctan2(-zx, sin * zy + cos * zz), psi])
