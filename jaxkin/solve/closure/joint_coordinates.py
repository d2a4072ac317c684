"""Convert between joint coordinates (Table 2) and the state of the solver.

In the state the rotations of balls are quaternions. Two contact states have pairs of movements whose angles lock where
a ball has rolled a quarter turn, and are quaternions too. For a ball on a plane, (d), the rotation about the normal and
the two angles become one ball. For a ball on a ball, (p), the line of centres rotates about axes at right angles to it;
its rotation about itself changes nothing. The angles computed here give the same displacement as the quaternions, to
rounding, even where the two frames of such a pair deviate slightly from Table 1.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import Geometry
from jaxkin.solve.closure.rod_spin import remove_spin_from_rotations, remove_spin_from_state
from jaxkin.solve.closure.spatial import cut_rotations
from jaxkin.solve.closure.spatial_geometry import Spatial
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import Coordinates, Rotations, State, angles, from_angles, matrix, multiply, turning

Frames = tuple[Float[Array, "_ 4 4"], ...]
"""For each joint its frames on one of its parts, as `frames_1` or `frames_2` of `Joint`."""


def ball_rotations(system: LoopSystem, geometry: Geometry, state: State) -> dict[int, Rotations]:
    """Compute the rotation matrices of all balls, by number, without the idle spins of rods.

    A ball at which a loop is cut gets the rotation that closes the loop.
    """
    rotations = _all_rotations(system, geometry, state)
    if not isinstance(geometry.loops, Spatial):
        return rotations
    return remove_spin_from_rotations(system, geometry.loops.lines, rotations)


def remove_idle_spin(system: LoopSystem, geometry: Geometry, state: State) -> State:
    """Remove the idle spins of all rods: the result is a smooth function of the input, unlike the solver's state."""
    if not isinstance(geometry.loops, Spatial) or not system.spinning:
        return state
    return remove_spin_from_state(system, geometry.loops.lines, _all_rotations(system, geometry, state), state)


def _all_rotations(system: LoopSystem, geometry: Geometry, state: State) -> dict[int, Rotations]:
    """Compute the rotation matrices of all balls, by number, with the idle spins of rods."""
    matrices = matrix(jnp.moveaxis(state.turns, 1, 0))
    uncut = {ball: matrices[:, :, number] for number, ball in enumerate(system.turned_balls)}
    return uncut | cut_rotations(system, geometry.loops, state) if isinstance(geometry.loops, Spatial) else uncut


def joint_coordinates(
    system: LoopSystem, frames_1: Frames, frames_2: Frames, x: Coordinates, rotations: dict[int, Rotations]
) -> Coordinates:
    """Compute the coordinates of all joints: `x`, with the entries of balls replaced by the angles of their rotations.

    `x` is in radians and in the unit of the frames; `rotations` holds the rotation of each ball, by number.
    """
    rotations = dict(rotations)
    pairs = []
    for (joint, frame), (ball, columns) in reversed(system.places.items()):  # pairs that lock stand last
        if columns[0] in system.driven:
            continue
        if len(columns) == 2:
            behind, _ = system.places[joint, frame + 1]
            between = _between(frames_1[joint], frames_2[joint], frame)
            found, rotations[behind] = _line(between, rotations[ball], rotations[behind])
        elif columns == tuple(range(columns[0], columns[0] + 3)):
            pairs.append((ball, columns))
            continue
        else:
            first = columns[2] - 2
            found, moved = _on_plane(_between(frames_1[joint], frames_2[joint], frame - 1), rotations[ball])
            x = x.at[first : first + 2].add(moved)
        x = x.at[np.array(columns)].set(found, unique_indices=True)
    if pairs:
        found = angles(jnp.stack([rotations[ball] for ball, _ in pairs], axis=2))
        x = x.at[np.array([columns for _, columns in pairs]).T].set(found, unique_indices=True)
    return x


def unwrap_ball_angles(system: LoopSystem, x: Coordinates) -> Coordinates:
    """Unwrap the angles of balls by multiples of 2 pi, so that the angles do not jump from pose to pose."""
    which = np.flatnonzero(turning(system))
    return x.at[which].set(jnp.unwrap(x[which], axis=-1), unique_indices=True) if which.size else x


def as_state(system: LoopSystem, frames_1: Frames, frames_2: Frames, x: Coordinates) -> State:
    """Compute the state from the coordinates `x` of all joints: the inverse of `joint_coordinates`."""
    turns = []
    for (joint, frame), (ball, columns) in system.places.items():
        chosen = x[np.array(columns)]
        if len(columns) == 2:
            turn = from_angles(jnp.stack([*chosen, jnp.zeros_like(chosen[0])]))
        elif columns == tuple(range(columns[0], columns[0] + 3)):
            turn = from_angles(chosen)
        else:
            theta, phi, about_normal = chosen
            between = _between(frames_1[joint], frames_2[joint], frame - 1)
            half, none = 0.5 * about_normal, jnp.zeros_like(theta)
            of_line = jnp.stack([jnp.cos(half), *(jnp.sin(half) * between[2, :3, None])])
            turn = multiply(of_line, from_angles(jnp.stack([theta, phi, none])))
            # also where a loop is cut at the ball: the turn about the normal moves its centre
            first = columns[2] - 2
            x = x.at[first : first + 2].add(_rotated_origin(about_normal, between) - between[:2, 3, None])
        if ball in system.turned_balls:
            turns.append(turn)
    return State(x, jnp.stack(turns) if turns else jnp.zeros((0, 4, x.shape[1]), x.dtype))


def _line(between: Float[Array, "3 4"], line: Rotations, ball: Rotations) -> tuple[Array, Rotations]:
    """Compute theta and phi of the line of centres of (p), and the rotation of the ball behind the line.

    `between` is the pose of the ball's frame relative to that of the line. The spin of the line about itself is moved
    into the rotation of the ball.
    """
    a, b, c = centre = between[:3, 3]
    x, y, z = jnp.einsum("ijp,j->ip", line, centre)
    square = x * x + z * z
    at_pole = square <= 1e-30 * (centre @ centre)
    across = jnp.where(at_pole, 0.0, square - a * a)
    lifted = jnp.where(across > 0, jnp.sqrt(jnp.where(across > 0, across, 1.0)), 0.0) * jnp.where(c < 0, -1.0, 1.0)
    theta = jnp.arctan2(b * lifted - c * y, b * y + c * lifted)
    phi = _direction(lifted * x - a * z, a * x + lifted * z, at_pole)
    none = jnp.zeros_like(theta)
    rest = jnp.einsum("jip,jkp->ikp", matrix(from_angles(jnp.stack([theta, phi, none]))), line)
    inner = between[:3, :3]
    rotation = jnp.einsum("ji,jkp,kl,lmp->imp", inner, rest, inner, ball)
    return jnp.stack([theta, phi]), rotation


def _on_plane(between: Float[Array, "3 4"], ball: Rotations) -> tuple[Array, Float[Array, "2 poses"]]:
    """Compute theta, phi and psi about the normal of (d), and the change of its displacements x and y by psi.

    `between` is the pose of the ball's frame relative to that of the plane.
    """
    inner = between[:3, :3]
    turn = jnp.einsum("ij,jkp->ikp", inner, ball)
    wx, wy, wz = turn[:, 0]
    square = wx * wx + wy * wy
    locked = square < 1e-30  # entries of rotation matrices are right to 1e-16
    side = jnp.where(inner[2, 2] < 0, -1.0, 1.0)
    across = jnp.where(locked, 0.0, square - inner[2, 1] ** 2)
    level = jnp.where(across > 0, jnp.sqrt(jnp.where(across > 0, across, 1.0)), 0.0)
    phi = jnp.arctan2(side * inner[2, 0], jnp.abs(inner[2, 2])) - jnp.arctan2(side * wz, level)
    none = jnp.zeros_like(phi)
    leaned = jnp.einsum("ij,jkp->ikp", inner, matrix(from_angles(jnp.stack([none, phi, none]))))
    vx, vy, _ = leaned[:, 0]
    about_normal = _direction(vx * wy - vy * wx, vx * wx + vy * wy, locked)
    upright = matrix(from_angles(jnp.stack([none, none, about_normal])))
    rolled = jnp.einsum("jip,kjp,klp->ilp", leaned, upright, turn)
    theta = jnp.arctan2(rolled[2, 1], rolled[1, 1])
    return jnp.stack([theta, phi, about_normal]), between[:2, 3, None] - _rotated_origin(about_normal, between)


def _direction(sin: Array, cos: Array, undefined: Array) -> Array:
    """Compute atan2(sin, cos); zero with zero derivative where the angle is undefined."""
    angle = jnp.arctan2(jnp.where(undefined, 0.0, sin), jnp.where(undefined, 1.0, cos))
    return jnp.where(undefined, 0.0, angle)


def _rotated_origin(angle: Float[Array, " poses"], between: Float[Array, "3 4"]) -> Float[Array, "2 poses"]:
    """Rotate the origin of the second frame of a pair about z of the first one, and return its x and y."""
    cos, sin, (x, y) = jnp.cos(angle), jnp.sin(angle), between[:2, 3]
    return jnp.stack([cos * x - sin * y, sin * x + cos * y])


def _between(
    frames_1: Float[Array, "frames 4 4"], frames_2: Float[Array, "frames 4 4"], frame: int
) -> Float[Array, "3 4"]:
    """Compute the pose of the next frame of a chain relative to this one."""
    here, there = jnp.asarray(frames_2[frame], float), jnp.asarray(frames_1[frame + 1], float)
    inverse = here[:3, :3].T
    return jnp.concatenate([inverse @ there[:3, :3], (inverse @ (there[:3, 3] - here[:3, 3]))[:, None]], axis=1)
