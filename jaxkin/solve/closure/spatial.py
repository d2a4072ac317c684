"""Evaluate the closure of loops in space (Eq. 10 and 11): residual and Jacobian of all poses at once.

The steps (elementary motions) of a loop are composed one by one to its displacement, rotation `R` and translation `t`.
Each step gives one column of the Jacobian: the twist of the end of the loop at a unit rate of the step. Of the twelve
equations of Eq. 11 at most six are independent: `vee(R - R^T)/2 = 0` and `t = 0`. Their Gauss-Newton step is that of
all twelve with the rotation rows weighted by sqrt(1/2). They are not enough to accept a pose, since `vee` also vanishes
at half a turn; the residual norm is therefore over all twelve. Some loops need fewer equations:

- A loop that is cut at a ball begins behind the ball and ends before it. It keeps `t = 0`; the ball takes up any `R`.
- A loop that is cut at both balls of a rod is two chains from ball to ball, which must have equal lengths `|t|`. Chains
  of several loops with the same motions are computed once: all legs of a platform are closed through one of them.
- In a loop that turns about one direction only, `vee` is along that direction: its component there is one equation.
- In a loop that turns about one point, the rotation implies the translation: see `_about_points`.

The steps are data of one compiled loop (`lax.scan`) and not straight-line code. Compile time therefore does not grow
with the mechanism, and the compiler cannot compute the chain anew for every column, as it does with straight-line code.
The poses are the last axis of all arrays.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.trig import cos_sin
from jaxkin.solve.closure.along_curves import along_curves, law_numbers
from jaxkin.solve.closure.loop_closure import LoopClosure
from jaxkin.solve.closure.rod_spin import lengths, turn_between, vee
from jaxkin.solve.closure.spatial_geometry import Spatial
from jaxkin.solve.system.chain_tables import ChainTables, chain_tables, distinct_tables
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.scatter import scatter_rows
from jaxkin.solve.system.state import State, rotation_matrix

Rotation = Float[Array, "3 3 *poses"]
"""[column, row]: the first index picks one of the three axes."""
Vector = Float[Array, "3 *poses"]


def spatial_closure(system: LoopSystem, geometry: Spatial, state: State) -> LoopClosure:
    """Evaluate the closure of all loops in space.

    Rows are in the order of `LoopSystem.sections`. Columns are those of `LoopSystem`; the columns of a ball are
    rotations about world axes.
    """
    rotation, translation, twists = _travel(system, geometry, state)
    table, poses, sections = chain_tables(system), state.x.shape[-1], system.sections
    free, spherical, schoenflies, ends = (np.array(loops, int) for loops in sections[:-1])
    # 3 - trace would lose digits by cancellation: its root does not fall below the root of rounding
    uncut = np.sort(np.concatenate([free, spherical, schoenflies]))
    turned = rotation[:, :, uncut] - np.eye(3, dtype=rotation.dtype)[..., None, None]
    residual = [*_of_loops(vee(rotation[:, :, free].swapaxes(0, 1)))]
    rows = [twists[table.source[:, free], :3, free]]
    moved = translation[:, ends]
    squares = jnp.sum(moved**2, axis=(0, 1))
    if spherical.size:
        turns = vee(rotation[:, :, spherical].swapaxes(0, 1))
        weighted, slopes = _about_points(
            geometry.centres[..., None],
            turns,
            translation[:, spherical],
            twists[table.source[:, spherical], :3, spherical],
        )
        squares += jnp.sum(translation[:, spherical] ** 2, axis=(0, 1))
        residual += [*_of_loops(weighted)]
        rows.append(slopes)
    if schoenflies.size:
        # the direction of the loop is the axis of any of its rotations
        turning = len(twists) // len(table.turn) * np.argmax(table.turn > 0, axis=0)
        direction = twists[turning[schoenflies], :3, schoenflies]
        turns = _of_loops(vee(rotation[:, :, schoenflies].swapaxes(0, 1)))
        residual.append(jnp.sum(direction * turns, axis=1))
        rows.append(jnp.sum(direction * twists[table.source[:, schoenflies], :3, schoenflies], axis=2, keepdims=True))
    residual += [*_of_loops(moved)]
    rows.append(twists[table.source[:, ends], 3:, ends])
    if table.rods.size:
        misfit, slopes = _of_rods(table, translation, twists)
        squares += jnp.sum(misfit**2, axis=0)
        residual.append(misfit)
        rows.append(slopes)
    residual = jnp.concatenate(residual)
    slopes = jnp.concatenate([row.reshape(len(table.used), -1, poses) for row in rows], axis=1)
    jacobian = scatter_rows(slopes, table.used, system.columns).swapaxes(0, 1)
    return LoopClosure(residual, jacobian, jnp.sum(turned**2, axis=(0, 1, 2)), squares)


def _about_points(
    centres: Float[Array, "3 loops 1"],
    turns: Float[Array, "3 loops poses"],
    translation: Float[Array, "3 loops poses"],
    slopes: Float[Array, "columns loops 3 poses"],
) -> tuple[Float[Array, "3 loops poses"], Float[Array, "columns loops 3 poses"]]:
    """Reduce the six equations of loops that turn about points `c` to three with the same least-squares solution.

    In such a loop `t = (1 - R) c`. The derivative of `t` with respect to a rotation vector `w` is `d x w`, with
    `d = R c = c - t`. So half the sum of the six squares has the gradient `vee + t x c` with respect to `w`, and its
    normal matrix is the weight `1 + d^2 - d d^T`. The root of the weight is `S = s - d d^T / (1 + s)`, with
    `s^2 = 1 + c^2`. Returns the residuals `S^-1 (vee + t x c)` and their derivatives, `S` times the `slopes` of the
    rotation.
    """
    d = centres - translation
    s = jnp.sqrt(1 + jnp.sum(centres**2, axis=0))
    gradient = turns + jnp.cross(translation, centres, axis=0)
    weighted = (gradient + d * jnp.sum(d * gradient, axis=0) / (1 + s)) / s
    d = _of_loops(d)[None]
    return weighted, s[:, None] * slopes - d * jnp.sum(d * slopes, axis=2, keepdims=True) / (1 + s[:, None])


def _of_loops(vectors: Float[Array, "3 loops poses"]) -> Float[Array, "loops 3 poses"]:
    """Move the axis of the loops to the front."""
    return jnp.moveaxis(vectors, 1, 0)


def _of_rods(
    table: ChainTables, translation: Float[Array, "3 chains poses"], twists: Array
) -> tuple[Float[Array, "rods poses"], Float[Array, "used rods 1 poses"]]:
    """Compute the difference between the lengths of both chains of each rod, and its derivatives."""
    length = lengths(translation)
    # projected before they are gathered: a gather takes longer than the three products
    along = jnp.sum(translation / length * twists[:, 3:], axis=1)
    one, other = jnp.moveaxis(along[table.source[:, table.rods], table.rods], 1, 0)
    first, second = table.rods
    return length[first] - length[second], (one - other)[:, :, None]


def cut_rotations(system: LoopSystem, geometry: Spatial, state: State) -> dict[int, Float[Array, "3 3 poses"]]:
    """Compute for each ball at which a loop is cut the rotation, [row, column], that closes the loop, by ball number.

    The spin of a rod that is cut at both balls is arbitrary.
    """
    if not any(system.cuts):
        return {}
    table = chain_tables(system)
    rotation, translation, _ = _travel(system, geometry, state)
    rotation, translation = _from_own_begin(table, geometry, rotation, translation)
    closing = dict(enumerate(jnp.moveaxis(rotation, 2, 0)))  # the inverse of the rotation of the chain, [row, column]
    if table.rods.size:
        # the second ball makes the two chains point in opposite directions; the first ball closes the loop
        first, second = table.rods
        wanted = -jnp.sum(rotation[:, :, first] * translation[None, :, first], axis=1)
        turn = turn_between(translation[:, second], wanted)
        around = _product(_product(rotation[:, :, first], turn), rotation[:, :, second])
        closing |= dict(zip(first, jnp.moveaxis(around, 2, 0), strict=True))
        closing |= dict(zip(second, jnp.moveaxis(turn.swapaxes(0, 1), 2, 0), strict=True))
    return {
        int(ball): closing[chain] if sign > 0 else closing[chain].swapaxes(0, 1)
        for chain, (ball, sign) in enumerate(zip(table.cut_ball, table.cut_sign, strict=True))
        if sign
    }


class _StepMotions(NamedTuple):
    """How far the steps of chains go at a state, and how fast for a unit rate of their coordinates, as travelled."""

    cos: Float[Array, "steps distinct poses"]
    sin: Float[Array, "steps distinct poses"]
    travel: Float[Array, "steps distinct poses"]
    """Translation along z."""
    turn: Float[np.ndarray, "steps chains 1"]
    """Angle for a unit of the coordinate, or of the law that it follows."""
    advance: Float[Array | np.ndarray, "steps chains 1"]
    """Length for a unit of the same."""
    rates: Float[Array, "steps chains poses"] | None
    """Derivative of the law with respect to the coordinate, 1 without one; None where no step follows a law."""


def _step_motions(system: LoopSystem, geometry: Spatial, state: State) -> _StepMotions:
    """Evaluate the steps of the distinct chains."""
    table, poses, dtype = distinct_tables(system), state.x.shape[-1], state.x.dtype
    turn, advance, screw, sign = (
        np.asarray(entry, dtype)[..., None] for entry in (table.turn, table.slide, table.screw, table.sign)
    )
    if screw.any():
        advance = advance + screw * geometry.pitch[table.joint][..., None] / (2 * np.pi)
    # once a coordinate, and not for each chain that it is in
    turning, place = np.unique(np.where(table.turn > 0, table.column, system.columns), return_inverse=True)
    place = place.reshape(table.turn.shape)
    cos, sin = cos_sin(jnp.concatenate([state.x, jnp.zeros((1, poses), dtype)])[turning])
    moving, lengths = table.column, [state.x, jnp.zeros((1, poses), dtype)]
    rates: Array | None = None
    if geometry.curves:
        number, laws = law_numbers(system).of_steps, along_curves(system, geometry.curves, state)
        moving = np.where(number < 0, moving, system.columns + 1 + number)
        place = np.where(number < 0, place, len(turning) + number)
        lengths.append(laws.length)
        cos, sin = jnp.concatenate([cos, laws.cos]), jnp.concatenate([sin, laws.sin])
        rates = jnp.concatenate([jnp.ones((1, poses), dtype), laws.rate])[number + 1]
    turn, advance = sign * turn, advance * sign
    travel = jnp.asarray(advance) * jnp.concatenate(lengths)[moving]
    return _StepMotions(cos[place], sin[place] * sign, travel, turn, advance, rates)


def _travel(
    system: LoopSystem, geometry: Spatial, state: State
) -> tuple[Float[Array, "3 3 chains poses"], Float[Array, "3 chains poses"], Float[Array, "twists 6 chains poses"]]:
    """Compute rotation [column, row] and translation of the ends of the chains, and the twist of the end by each step.

    Each of the distinct chains is travelled once, for all chains with the same rows. Rotations, translations and twists
    are in the axes in which the distinct chain begins; translations are from the begin of each chain. Twists are
    numbered as in `ChainTables.source`, with a zero twist behind the last one. The first twist of a coordinate that
    drives several steps is the sum of theirs.
    """
    table, poses, dtype = distinct_tables(system), state.x.shape[-1], state.x.dtype
    cos, sin, travel, turn, advance, rates = _step_motions(system, geometry, state)
    side = np.asarray(table.sign * table.side, dtype)[..., None]
    balls = _ball_turns(state, table) if system.turned_balls else None

    def step(carry: tuple[Rotation, Vector], given):
        pose, cos, sin, travel, first_side, ball = given
        rotation, point = _compose(*carry, pose)
        turned = jnp.stack([cos * rotation[0] + sin * rotation[1], cos * rotation[1] - sin * rotation[0], rotation[2]])
        if ball is not None:
            turned = _product(turned, ball)
        # the rotation of a ball is perturbed on its left, about axes of part 1; that of a line of centres on its right
        axes = rotation[2][None] if ball is None else jnp.where(first_side > 0, rotation, turned)
        return (turned, point + travel * rotation[2]), (rotation[2], axes, point)

    count = len(table.distinct)
    first = jnp.broadcast_to(np.eye(3, dtype=dtype)[..., None, None], (3, 3, count, poses))
    start = first, jnp.zeros((3, count, poses), dtype)
    (rotation, point), (along, axes, points) = lax.scan(step, start, (geometry.between, cos, sin, travel, side, balls))
    shared = count < len(table.same_rows_as)
    sign = np.asarray(table.sign, dtype)[..., None]
    if shared:
        rotation, point, along, axes, points = (
            each[..., table.same_rows_as, :] for each in (rotation, point, along, axes, points)
        )
        sign, turn, advance = (each[:, table.same_rows_as] for each in (sign, turn, advance))
        rates = None if rates is None else rates[:, table.same_rows_as]
    rotation, translation = _compose(rotation, point, geometry.end)

    lever = translation - points
    if shared:
        translation = translation - geometry.begin[:, :3, 3].T[..., None]
    turned, moved = turn[:, None] * along, advance[:, None] * along
    if rates is not None:
        turned, moved = rates[:, None] * turned, rates[:, None] * moved
    moved = moved + jnp.cross(turned, lever, axis=1)
    twists = jnp.concatenate([turned, moved], axis=1)
    if system.turned_balls:
        spins = sign[:, None, None] * axes
        spins = jnp.concatenate([spins, jnp.cross(spins, lever[:, None], axis=2)], axis=2)
        twists = jnp.concatenate([twists[:, None], spins], axis=1).reshape(-1, *twists.shape[1:])
    if table.repeats.size:
        first, again, chain = table.repeats
        twists = twists.at[first, :, chain].add(twists[again, :, chain])
    return rotation, translation, jnp.concatenate([twists, jnp.zeros_like(twists[:1])])


def _from_own_begin(
    table: ChainTables,
    geometry: Spatial,
    rotation: Float[Array, "3 3 chains poses"],
    translation: Float[Array, "3 chains poses"],
) -> tuple[Float[Array, "3 3 chains poses"], Float[Array, "3 chains poses"]]:
    """Express rotation [column, row] and translation of the ends of the chains in the axes of their own begins."""
    if len(table.distinct) == len(table.same_rows_as):
        return rotation, translation
    axes = jnp.moveaxis(geometry.begin[:, :3, :3], 0, 2)[..., None]
    return jnp.sum(axes * rotation[:, :, None], axis=1), jnp.sum(axes * translation[:, None], axis=0)


def _ball_turns(state: State, table: ChainTables) -> Float[Array, "steps 3 3 distinct poses"]:
    """Compute the rotation matrix [column, row] of each step that is a ball; the identity for all other steps."""
    poses = state.x.shape[-1]
    still = jnp.broadcast_to(jnp.array([1.0, 0.0, 0.0, 0.0], state.x.dtype)[:, None], (1, 4, poses))
    w_x_y_z = jnp.moveaxis(jnp.concatenate([state.turns, still]), 1, 0)
    there = jnp.stack([jnp.stack(column) for column in rotation_matrix(w_x_y_z)])
    both = jnp.stack([there, there.swapaxes(0, 1)], axis=2)
    return jnp.moveaxis(both[:, :, (table.sign < 0).astype(int), table.ball], 2, 0)


def _compose(rotation: Rotation, translation: Vector, pose: Float[Array, "chains 4 4"]) -> tuple[Rotation, Vector]:
    """Compose rotation and translation with a constant pose that follows, chain by chain."""
    entries = jnp.moveaxis(pose[:, :3], 0, 2)[:, :, None, :, None]  # [row, column, 1, chain, 1]
    columns = rotation[0] * entries[0] + rotation[1] * entries[1] + rotation[2] * entries[2]
    return columns[:3], translation + columns[3]


def _product(a: Rotation, b: Rotation) -> Rotation:
    """Multiply rotation matrices [column, row]."""
    return a[0] * b[:, 0, None] + a[1] * b[:, 1, None] + a[2] * b[:, 2, None]
