"""Hold the state of a loop system: coordinates, with the rotation ("turn") of each ball as a unit quaternion.

The three angles of a ball lock at phi = 90 deg, so the solver does not use them: a step multiplies the quaternion of a
ball by `exp(delta)` on the left, and angles are computed only at the end (`closure.joint_coordinates`). The line
between the centres of two balls, contact state (p), rotates about two axes at right angles to the line, wherever it
points: its quaternion is multiplied by `exp(delta)` on the right, without a rotation about the line itself. The poses
are the last axis of every array.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import cos_sin
from jaxkin.solve.system.loop_system import LoopSystem

Coordinates = Float[Array, "columns poses"]
Quaternions = Float[Array, "balls 4 poses"]
Rotations = Float[Array, "3 3 poses"]
"""Rotation matrices, [row, column, pose]."""


class State(NamedTuple):
    """The states of a loop system at many poses."""

    x: Coordinates
    """Coordinates of all joints, radians and lengths over the characteristic length; zero for free balls."""
    turns: Quaternions
    """Unit quaternions (w, x, y, z) of part 2 relative to part 1, for each ball of `LoopSystem.turned_balls`."""


def assembled(system: LoopSystem, poses: int, dtype) -> State:
    """Make the state of the assembled pose, in which all coordinates are zero, for a number of poses."""
    turn = jnp.array([1.0, 0.0, 0.0, 0.0], dtype)[None, :, None]
    return State(
        jnp.zeros((system.columns, poses), dtype), jnp.broadcast_to(turn, (len(system.turned_balls), 4, poses))
    )


def retract(system: LoopSystem, state: State, delta: Coordinates) -> State:
    """Move a state by `delta`, which is added to the coordinates.

    The columns of a free ball in `delta` are a rotation vector, by whose exponential its quaternion is multiplied on
    the left. Quaternions are normalised.
    """
    if not system.turned_balls:
        return State(state.x + delta, state.turns)
    turns = multiply(exponential(_of_balls(system, state, delta)), jnp.moveaxis(state.turns, 0, 1))
    turns = turns / jnp.sqrt(jnp.sum(turns * turns, axis=0))
    return State(jnp.where(turning(system), 0.0, state.x + delta), jnp.moveaxis(turns, 0, 1))


def rate(system: LoopSystem, state: State, delta: Coordinates) -> State:
    """Differentiate `retract(state, t delta)` by t at t = 0: the tangent of the state's arrays."""
    if not system.turned_balls:
        return State(delta, jnp.zeros_like(state.turns))
    spin = _of_balls(system, state, delta)
    turns = 0.5 * multiply(jnp.concatenate([jnp.zeros_like(spin[:1]), spin]), jnp.moveaxis(state.turns, 0, 1))
    return State(jnp.where(turning(system), 0.0, delta), jnp.moveaxis(turns, 0, 1))


def difference(a: State, b: State) -> Float[Array, " poses"]:
    """Measure the distance between two states at each pose: the largest difference of a coordinate or of a ball's
    angle.

    The angle between two rotations is about twice the difference of their quaternions.
    """
    largest = jnp.max(jnp.abs(a.x - b.x), axis=0)
    return jnp.maximum(largest, 2 * jnp.max(jnp.abs(a.turns - b.turns), axis=(0, 1), initial=0.0))


def select_poses(mask: Bool[Array, " poses"], yes, no):
    """Select, pose by pose, the arrays of `yes` where the mask holds and those of `no` elsewhere."""
    return jax.tree.map(lambda a, b: jnp.where(mask, a, b), yes, no)


def drive(system: LoopSystem, state: State, inputs: Float[Array, "driven poses"]) -> State:
    """Set the driven coordinates of a state to the inputs; a ball is driven by its three angles theta, phi, psi."""
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
    """Compute the rates of the driven coordinates for inputs at the rate `direction`: as coordinates, and as columns.

    The two differ for a driven ball. Its coordinates are angles; its columns of the Jacobian are rotations about world
    axes, with the angular velocity `z psi' + Rz (y phi' + Ry x theta')`.
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
    """Copy inputs to the rows of their columns; the other rows are undefined, or zero if nothing is driven."""
    if not system.driven:
        return jnp.zeros((system.columns, inputs.shape[-1]), inputs.dtype)
    which = np.array([system.driven.index(c) if c in system.driven else 0 for c in range(system.columns)])
    return inputs if len(system.driven) == 1 else inputs[which]


def driven(system: LoopSystem, x: Coordinates) -> Float[Array, "driven poses"]:
    """Select the driven coordinates."""
    return jnp.stack([x[column] for column in system.driven]) if system.driven else x[:0]


def is_driven(system: LoopSystem) -> Bool[np.ndarray, "columns 1"]:
    """Mask the driven columns: in a compiled program, a mask costs less than gathering and scattering rows."""
    return np.isin(np.arange(system.columns), system.driven)[:, None]


def turning(system: LoopSystem) -> Bool[np.ndarray, "columns 1"]:
    """Mask the columns of balls that are not driven: their rotations are in `State.turns`, not in `State.x`."""
    turning = [column for columns in system.balls for column in columns if column not in system.driven]
    return np.isin(np.arange(system.columns), turning)[:, None]


def _of_balls(system: LoopSystem, state: State, delta: Coordinates) -> Float[Array, "3 balls poses"]:
    """Select the rotation vectors of the balls from `delta`, to be applied on the left; zero for driven balls."""
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
    """Multiply quaternions: the product rotates by b first, then by a."""
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
    """Compute the unit quaternion of a rotation vector."""
    square = jnp.sum(vector * vector, axis=0)
    small = square < 1e-6
    angle = jnp.sqrt(jnp.where(small, 1.0, square))  # sqrt has no derivative at zero: the other branch is the series
    cos, sin = cos_sin(0.5 * angle)
    half_sinc = jnp.where(small, 0.5 - square / 48.0, sin / angle)
    cos = jnp.where(small, 1.0 - square / 8.0 + square * square / 384.0, cos)
    return jnp.concatenate([cos[None], half_sinc * vector])


def from_angles(angles: Float[Array, "3 poses"]) -> Float[Array, "4 poses"]:
    """Compute the unit quaternion of T_theta_phi_psi = Rz(psi) Ry(phi) Rx(theta) from theta, phi, psi in radians."""
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
    """Compute the rotation matrix of a unit quaternion as a list of columns: entry [column][row]."""
    w, x, y, z = turn
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
        [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
        [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
    ]


def matrix(turn: Float[Array, "4 *poses"]) -> Float[Array, "3 3 *poses"]:
    """Compute the rotation matrix of a unit quaternion, [row, column]."""
    return jnp.stack([jnp.stack(column) for column in rotation_matrix(turn)], axis=1)


def angles(rotation: Float[Array, "3 3 *poses"]) -> Float[Array, "3 *poses"]:
    """Compute the paper's theta, phi, psi of rotation matrices; at phi = +-90 deg, where they lock, theta is zero.

    The three angles give the rotation to rounding however near phi is to +-90 deg, because psi and phi are computed
    from the rotation that is left after theta.
    """
    (_, xy, xz), (_, yy, yz), (zx, zy, zz) = rotation
    locked = zy * zy + zz * zz < 1e-30  # entries of rotation matrices are right to 1e-16
    theta = jnp.where(locked, 0.0, jnp.arctan2(jnp.where(locked, 0.0, zy), jnp.where(locked, 1.0, zz)))
    cos, sin = cos_sin(theta)
    psi = jnp.arctan2(sin * xz - cos * xy, cos * yy - sin * yz)
    return jnp.stack([theta, jnp.arctan2(-zx, sin * zy + cos * zz), psi])
