"""Closure of the loops (Eq. 10): residual and Jacobian of all poses at once.

A loop is travelled once. `R, t` is the displacement accumulated so far; every elementary movement leaves one column of
the Jacobian behind: the twist that it gives to the end of the loop. Of the twelve equations of Eq. 11 at most six are
independent: `vee(R - R^T)/2` and `t`. Their Gauss-Newton step is that of all twelve with the rotation rows weighted by
sqrt(1/2). The vector `vee` also vanishes at half a turn, so a pose is accepted on all twelve (`merit`).

Structure of arrays: poses stand last.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.motions import MOVEMENTS, Element
from jaxkin.solve.state import State, rotation_matrix
from jaxkin.solve.system import LoopSystem

Rotation = Float[Array, "3 3 *poses"]
"""[column, row]: the first index picks one of the three axes."""
Vector = Float[Array, "3 *poses"]


class Geometry(NamedTuple):
    """Constants of the loops, lengths divided by the characteristic length, in frames about the centroid."""

    between: tuple[Float[Array, "steps 4 4"], ...]
    """For each loop the constant pose before each movement travelled, and last the one behind the last movement."""
    pitch: Float[Array, " joints"]


class Closure(NamedTuple):
    residual: Float[Array, "equations poses"]
    """Rotation and translation of each loop: zero where it closes."""
    jacobian: Float[Array, "equations columns poses"]
    merit: Float[Array, " poses"]
    """Half the sum of squares of Eq. 12, rotation entries weighted by 1/2."""
    gap: Float[Array, " poses"]
    """Square root of Eq. 12 over all twelve equations of all loops, lengths over the characteristic length."""


def closure(system: LoopSystem, geometry: Geometry, state: State) -> Closure:
    """Residual and Jacobian of all loops; columns follow `LoopSystem`, those of balls turn about world axes."""
    poses = state.x.shape[1:]
    identity = jnp.eye(3, dtype=state.x.dtype).reshape(3, 3, *[1] * len(poses))
    nothing = jnp.zeros((6, *poses), state.x.dtype)
    residual, jacobian, rotated, moved = [], [], 0.0, 0.0
    for loop, between in zip(system.loops, geometry.between, strict=True):
        rotation, translation, twists = _travel(system, between, geometry.pitch, state, loop)
        (_, x1, x2), (y0, _, y2), (z0, z1, _) = rotation
        residual += [0.5 * jnp.stack([y2 - z1, z0 - x2, x1 - y0]), translation]
        jacobian.append(jnp.stack([twists.get(column, nothing) for column in range(system.columns)], axis=1))
        # not 3 - trace: that cancels and cannot fall below the square root of the rounding error
        rotated += jnp.sum((rotation - identity) ** 2, axis=(0, 1))
        moved += jnp.sum(translation**2, axis=0)
    return Closure(
        jnp.concatenate(residual),
        jnp.concatenate(jacobian),
        0.5 * (0.5 * rotated + moved),
        jnp.sqrt(rotated + moved),
    )


def _travel(
    system: LoopSystem,
    between: Float[Array, "steps 4 4"],
    pitch: Float[Array, " joints"],
    state: State,
    loop: tuple[tuple[int, int], ...],
) -> tuple[Rotation, Vector, dict[int, Array]]:
    """Displacement of the end of the loop, and for each column the twist (rotation, translation) it gives to that end."""
    poses = state.x.shape[1:]
    rotation = jnp.broadcast_to(between[0, :3, :3].T[..., None], (3, 3, *poses))
    translation = jnp.broadcast_to(between[0, :3, 3, None], (3, *poses))
    turns: list[tuple[int, Vector, Vector, Array | float]] = []
    slides: list[tuple[int, Vector]] = []
    for step, (joint, name, column, ball, sign) in enumerate(_steps(system, loop)):
        if MOVEMENTS[name].ball:
            turned = _product(rotation, rotation_matrix(_conjugate(state.turns[ball], sign)))
            axes = rotation if sign > 0 else turned  # the turn is perturbed on its left, on the side of part 1
            turns += [(column + axis, sign * axes[axis], translation, 0.0) for axis in range(3)]
            rotation = turned
        elements = () if MOVEMENTS[name].ball else MOVEMENTS[name].elements
        for element in elements if sign > 0 else reversed(elements):
            index = column + element.coordinate
            direction = sign * rotation[element.axis]
            if element.kind == "translate":
                slides.append((index, direction))
            else:
                advance = pitch[joint] / (2 * jnp.pi) if element.kind == "screw" else 0.0
                turns.append((index, direction, translation, advance))
            rotation, translation = _move(rotation, translation, element, sign * state.x[index], pitch[joint])
        rotation, translation = _compose(rotation, translation, between[step + 1])

    twists = {index: jnp.concatenate([jnp.zeros_like(direction), direction]) for index, direction in slides}
    for index, direction, point, advance in turns:
        lever = jnp.cross(direction, translation - point, axis=0) + advance * direction
        twists[index] = jnp.concatenate([direction, lever])
    return rotation, translation, twists


def _steps(system: LoopSystem, loop: tuple[tuple[int, int], ...]) -> list[tuple[int, str, int, int, int]]:
    """The movements of a loop in order of travel: joint, key of `MOVEMENTS`, first column, ball, sign."""
    steps = []
    for joint, sign in loop:
        chain = [(joint, name, column, ball, sign) for name, _, column, ball in system.chains[joint]]
        steps += chain if sign > 0 else chain[::-1]
    return steps


def _move(rotation: Rotation, translation: Vector, element: Element, q: Array, pitch: Array) -> tuple[Rotation, Vector]:
    """Rotation and translation followed by an elementary movement of the local frame."""
    i, j, k = element.axis, (element.axis + 1) % 3, (element.axis + 2) % 3
    if element.kind == "translate":
        return rotation, translation + q * rotation[i]
    if element.kind == "screw":
        translation = translation + q * pitch / (2 * jnp.pi) * rotation[i]
    cos, sin = jnp.cos(q), jnp.sin(q)
    columns = {i: rotation[i], j: cos * rotation[j] + sin * rotation[k], k: cos * rotation[k] - sin * rotation[j]}
    return jnp.stack([columns[c] for c in range(3)]), translation


def _compose(rotation: Rotation, translation: Vector, pose: Float[Array, "4 4"]) -> tuple[Rotation, Vector]:
    """Rotation and translation followed by a constant pose."""
    columns = [sum(rotation[j] * pose[j, c] for j in range(3)) for c in range(4)]
    return jnp.stack(columns[:3]), translation + columns[3]


def _product(a: Rotation, b: list[list[Array]]) -> Rotation:
    return jnp.stack([sum(a[j] * b[c][j] for j in range(3)) for c in range(3)])


def _conjugate(turn: Float[Array, "4 poses"], sign: int) -> Float[Array, "4 poses"]:
    return turn if sign > 0 else turn * jnp.array([1.0, -1.0, -1.0, -1.0], turn.dtype)[:, None]


def loop_geometry(
    system: LoopSystem, before: tuple[Array, ...], after: tuple[Array, ...], pitch: tuple[Array, ...]
) -> tuple[Geometry, Float[Array, ""]]:
    """The constants of the loops from the frames of the joints, one entry a joint, and the characteristic length.

    Frames are taken from their centroid and lengths over their root-mean-square distance from it, so that the result
    depends on neither unit nor origin. Both are held constant in derivatives: they cancel.
    """
    origins = lax.stop_gradient(jnp.concatenate([frames[:, :3, 3] for frames in before]))
    centre = jnp.mean(origins, axis=0)
    radius = jnp.sqrt(jnp.mean(jnp.sum((origins - centre) ** 2, axis=1)))
    length = jnp.where(radius > 0, radius, 1.0)

    def scaled(frames: Float[Array, "frames 4 4"]) -> Float[Array, "frames 4 4"]:
        return frames.at[:, :3, 3].set((frames[:, :3, 3] - centre) / length)

    sides = scaled(jnp.concatenate(before)), scaled(jnp.concatenate(after))
    firsts = [sum(len(movements) for movements in system.movements[:joint]) for joint in range(len(system.movements))]
    identity = jnp.eye(4, dtype=sides[0].dtype)[None]
    between = []
    for loop in system.loops:
        enter, leave = [], []
        for joint, sign in loop:
            frames = range(firsts[joint], firsts[joint] + len(system.movements[joint]))
            for frame in frames if sign > 0 else reversed(frames):
                enter.append((0 if sign > 0 else 1, frame))
                leave.append((1 if sign > 0 else 0, frame))
        entered = jnp.stack([sides[side][frame] for side, frame in enter])
        left = _inverses(jnp.stack([sides[side][frame] for side, frame in leave]))
        between.append(jnp.concatenate([identity, left]) @ jnp.concatenate([entered, identity]))
    return Geometry(tuple(between), jnp.stack(pitch) / length), length


def _inverses(poses: Float[Array, "poses 4 4"]) -> Float[Array, "poses 4 4"]:
    """Inverses of rigid poses."""
    turned = jnp.swapaxes(poses[:, :3, :3], 1, 2)
    moved = -jnp.einsum("pij,pj->pi", turned, poses[:, :3, 3])
    return poses.at[:, :3, :3].set(turned).at[:, :3, 3].set(moved)
