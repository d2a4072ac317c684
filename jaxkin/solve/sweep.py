"""A whole range of inputs for one loop system: continuation, then all poses at once (Section 5.1, Eq. 12 and 13).

The range of a single input is followed once, from the assembled pose to either end, at as few knots as are safe.
Between two knots every pose is predicted by cubic Hermite interpolation with exact slopes and brought to closure by
Newton steps, all poses at once and in whatever order they come. Poses for which that does not hold are settled by the
damped corrector alone, in small groups, so that they cost the others nothing. Several inputs are followed along the
polyline of the poses in the order in which they are given.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure import Geometry, closure, loop_geometry
from jaxkin.solve.continuation import RESCUE_STEPS, Orientation, arrived, orientation_sign, start, substep, visit
from jaxkin.solve.correct import choose, correct, free_jacobian, newton_step
from jaxkin.solve.implicit import attach
from jaxkin.solve.state import State, angles, assembled, difference, drive, rate, retract
from jaxkin.solve.status import Status, classify, is_closed, tolerance
from jaxkin.solve.system import LoopSystem

FEWEST_KNOTS, MOST_KNOTS = 512, 65536
"""Room for the knots to either side of the assembled pose: twice the number of poses within these bounds. A full turn
takes about fifty."""
NEWTON_STEPS = 2
FARTHEST_CORRECTION = 0.02
"""Radians, or characteristic lengths: a pose farther from its prediction is not trusted to be on the branch."""
GROUP = 256


class Poses(NamedTuple):
    """Poses as they were found: numbers without derivatives."""

    state: State
    status: Int[Array, " poses"]
    gap: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""


class Joints(NamedTuple):
    """The joints of a loop system, one entry a joint, as in `Joint`."""

    before: tuple[Float[Array, "frames 4 4"], ...]
    after: tuple[Float[Array, "frames 4 4"], ...]
    pitch: tuple[Float[Array, ""], ...]


class _Knots(NamedTuple):
    """Poses along the range in rising order of the input; both lanes start with the assembled pose."""

    at: Float[Array, " knots"]
    state: State
    slope: State
    status: Int[Array, " knots"]


def find_poses(system: LoopSystem, joints: Joints, inputs: Float[Array, "driven poses"]) -> Poses:
    """The poses for the given inputs, in the order of `system.driven`, radians and lengths of the mechanism."""
    joints, inputs = lax.stop_gradient((joints, inputs))
    geometry, lengths = _scaled(system, joints)
    return _search(system, geometry, inputs / lengths[jnp.array(system.driven, int)])


def displacements(
    system: LoopSystem, joints: Joints, inputs: Float[Array, "driven poses"], poses: Poses
) -> Float[Array, "columns poses"]:
    """Displacements of all joints in the poses found, as the differentiable functions of joints and inputs they are.

    In radians and lengths of the mechanism; those of least residual where a pose did not close.
    """
    geometry, lengths = _scaled(system, joints)
    poses = lax.stop_gradient(poses)
    scaled = inputs / lengths[jnp.array(system.driven, int)]
    state = attach(system, geometry, scaled, poses.state, is_closed(poses.status))
    return _coordinates(system, state) * lengths


def _scaled(system: LoopSystem, joints: Joints) -> tuple[Geometry, Float[Array, "columns 1"]]:
    """The geometry, and what the coordinates of the solver are multiplied by to be those of the mechanism."""
    geometry, length = loop_geometry(system, *joints)
    return geometry, jnp.where(jnp.array(system.is_length, bool), length, 1.0)[:, None]


def _search(system: LoopSystem, geometry: Geometry, inputs: Float[Array, "driven poses"]) -> Poses:
    """Closed poses, by continuation from the assembled pose."""
    finite = jnp.all(jnp.isfinite(inputs), axis=0)
    inputs = jnp.where(finite, inputs, 0.0)  # one NaN would keep every other pose waiting
    if not system.free:
        state = drive(system, assembled(system, inputs.shape[1], inputs.dtype), inputs)
        gap = closure(system, geometry, state).gap
        poses = Poses(state, classify(gap, finite, finite), gap)
    elif len(system.driven) != 1:
        states, status, gap = visit(system, geometry, inputs.T[:, :, None])
        poses = Poses(State(states.x[..., 0].T, jnp.moveaxis(states.turns[..., 0], 0, -1)), status[:, 0], gap[:, 0])
    else:
        poses = _at_once(system, geometry, inputs)
    return poses._replace(status=jnp.where(finite, poses.status, Status.NONFINITE.value).astype(jnp.int32))


def _at_once(system: LoopSystem, geometry: Geometry, inputs: Float[Array, "1 poses"]) -> Poses:
    values = inputs[0]
    knots, bases = _follow(system, geometry, values)
    left = jnp.clip(jnp.searchsorted(knots.at, values, side="right") - 1, 0, knots.at.shape[0] - 2)
    predicted = drive(system, _hermite(system, knots, left, values), inputs)

    def newton(_, carry: tuple[State, Array, State, Array]):
        state, _, best, least = carry
        closed = closure(system, geometry, state)
        better = closed.gap < least
        best = jax.tree.map(lambda new, old: jnp.where(better, new, old), state, best)
        return (
            retract(system, state, newton_step(system, closed)),
            closed.gap,
            best,
            jnp.where(better, closed.gap, least),
        )

    unknown = jnp.full_like(values, jnp.inf)
    _, _, state, gap = lax.fori_loop(0, NEWTON_STEPS + 1, newton, (predicted, unknown, predicted, unknown))
    good = is_closed(knots.status)
    near = difference(state, predicted) <= FARTHEST_CORRECTION
    trusted = (gap <= tolerance(gap.dtype)) & near & good[left] & good[left + 1]
    status = jnp.maximum(knots.status[left], knots.status[left + 1])
    covered = (values >= knots.at[0]) & (values <= knots.at[-1])
    between = good[left] & good[left + 1]
    nearest = jnp.where(good[left] | ~good[left + 1], left, left + 1)
    begin = choose(between, predicted, jax.tree.map(lambda knot: knot[..., nearest], knots.state))
    poses = Poses(state, status, gap)
    settled = _rescue(system, geometry, bases, drive(system, begin, inputs), between, poses, ~trusted & covered)
    return settled._replace(status=jnp.where(covered, settled.status, Status.STALLED.value))


def _follow(system: LoopSystem, geometry: Geometry, values: Float[Array, " poses"]) -> tuple[_Knots, Orientation]:
    """The range from the assembled pose to its two ends, at knots as far apart as is safe."""
    room = min(max(FEWEST_KNOTS, 2 * values.shape[0]), MOST_KNOTS)
    target = jnp.stack([jnp.min(values, initial=0.0), jnp.max(values, initial=0.0)])[None]
    lanes = jnp.arange(2)
    front = start(system, 2, values.dtype)
    entry = (front.state, front.slope, front.status)
    kept = jax.tree.map(lambda array: jnp.zeros((room, *array.shape), array.dtype), entry)

    def running(carry) -> Array:
        front, count, _ = carry
        return jnp.any(~arrived(system, front, target) & (count < room))

    def step(carry):
        front, count, kept = carry
        front, final = substep(system, geometry, front, target)
        row = jnp.where(final & (count < room), count, room)  # out of bounds is dropped
        entry = (front.state, front.slope, front.status)
        kept = jax.tree.map(
            lambda store, new: store.at[row, ..., lanes].set(jnp.moveaxis(new, -1, 0), mode="drop"), kept, entry
        )
        return front, count + final, kept

    front, count, kept = lax.while_loop(running, step, (front, jnp.zeros(2, int), kept))
    used = jnp.minimum(
        jnp.arange(room)[:, None], jnp.minimum(count, room) - 1
    )  # rows that were not used repeat the last

    def row(store: Array) -> Array:
        falling, rising = store[used[::-1, 0], ..., 0], store[used[:, 1], ..., 1]
        return jnp.moveaxis(jnp.concatenate([falling, rising]), 0, -1)

    state, slope, status = jax.tree.map(row, kept)
    return _Knots(state.x[system.driven[0]], state, rate(system, state, slope), status), front.bases


def _rescue(
    system: LoopSystem,
    geometry: Geometry,
    bases: Orientation,
    begin: State,
    between: Bool[Array, " poses"],
    poses: Poses,
    open_: Bool[Array, " poses"],
) -> Poses:
    """The open poses, a group at a time, by the damped corrector.

    `between` tells the poses that lie between two closed knots: those are on their branch if they end near where they
    began, at the interpolation. Of the others the orientation tells the branch.
    """
    count = open_.shape[0]

    def settle(carry):
        open_, poses = carry
        group = jnp.nonzero(open_, size=GROUP, fill_value=count)[0]
        chosen = jnp.minimum(group, count - 1)
        guess = jax.tree.map(lambda row: row[..., chosen], begin)
        found = correct(system, geometry, guess, RESCUE_STEPS)
        near = difference(found.state, guess) <= 5 * FARTHEST_CORRECTION
        sign = orientation_sign(bases, free_jacobian(system, found.closure))
        same = jnp.where(between[chosen] & near, poses.status[chosen] != Status.JUMPED.value, sign >= 0)
        settled = Poses(found.state, classify(found.closure.gap, found.stationary, same), found.closure.gap)
        merged = jax.tree.map(lambda old, new: old.at[..., group].set(new, mode="drop"), poses, settled)
        return open_.at[group].set(False, mode="drop"), merged

    return lax.while_loop(lambda carry: jnp.any(carry[0]), settle, (open_, poses))[1]


def _hermite(system: LoopSystem, knots: _Knots, left: Int[Array, " poses"], values: Float[Array, " poses"]) -> State:
    """Cubic Hermite interpolation of the knots' states, turns of balls brought back to unit quaternions."""
    width = knots.at[left + 1] - knots.at[left]
    t = (values - knots.at[left]) / jnp.where(width > 0, width, 1.0)
    weights = ((1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2 * width, t * t * (3 - 2 * t), t * t * (t - 1) * width)

    def blend(x: Array, d: Array) -> Array:
        start, end = weights[0] * x[..., left] + weights[1] * d[..., left], weights[2] * x[..., left + 1]
        return start + end + weights[3] * d[..., left + 1]

    curve = jax.tree.map(blend, knots.state, knots.slope)
    first = jax.tree.map(lambda x: x[..., left], knots.state)
    last = jax.tree.map(lambda x: x[..., left + 1], knots.state)
    chord = jax.tree.map(lambda a, b: a + t * (b - a), first, last)
    # at a change point the tangent is not unique and the slope of its knot says nothing: keep to the chord there
    smooth = difference(curve, chord) <= 0.25 * difference(first, last)
    state = choose(smooth, curve, chord)
    return retract(system, state, jnp.zeros_like(state.x))


def _coordinates(system: LoopSystem, state: State) -> Float[Array, "columns poses"]:
    """The paper's coordinates: those of balls read off as theta, phi, psi and unwrapped along the poses."""
    x = state.x
    for ball, first in enumerate(system.balls):
        if first not in system.driven:
            x = x.at[first : first + 3].set(jnp.unwrap(angles(state.turns[ball]), axis=-1))
    return x
