"""A whole range of inputs for one loop system: continuation, then all poses at once (Section 5.1, Eq. 12 and 13).

The range of a single input is followed once, from the assembled pose to either end, at as few knots as are safe.
Between two knots every pose is predicted by cubic Hermite interpolation with exact slopes and brought to closure by
Newton steps, all poses at once and in whatever order they come. Poses for which that does not hold are settled by the
damped corrector alone, in small groups, so that they cost the others nothing. Several inputs are followed along the
polyline of the poses in the order in which they are given.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.closure import Geometry, closure, loop_geometry
from jaxkin.solve.continuation import RESCUE_STEPS, visit
from jaxkin.solve.correct import correct
from jaxkin.solve.dense import Poses, interpolate
from jaxkin.solve.implicit import attach
from jaxkin.solve.knots import Knots, follow, guess
from jaxkin.solve.state import State, angles, assembled, difference, drive, driven
from jaxkin.solve.status import Status, classify, is_closed
from jaxkin.solve.system import LoopSystem

FARTHEST_CORRECTION = 0.1
"""Radians, or characteristic lengths: a pose farther from its prediction is not trusted to be on the branch."""
GROUP = 256
MANY = 8192
"""From so many poses on most are interpolated."""


class Joints(NamedTuple):
    """The joints of a loop system, one entry a joint, as in `Joint`."""

    before: tuple[Float[Array, "frames 4 4"], ...]
    after: tuple[Float[Array, "frames 4 4"], ...]
    pitch: tuple[Float[Array, ""], ...]


def find_poses(system: LoopSystem, joints: Joints, inputs: Float[Array, "driven poses"]) -> Poses:
    """The poses for the given inputs, in the order of `system.driven`, radians and lengths of the mechanism."""
    joints, inputs = lax.stop_gradient((joints, inputs))
    geometry, lengths = _scaled(system, joints)
    return _search(system, geometry, inputs / driven(system, lengths))


def displacements(
    system: LoopSystem, joints: Joints, inputs: Float[Array, "driven poses"], poses: Poses
) -> Float[Array, "columns poses"]:
    """Displacements of all joints in the poses found, as the differentiable functions of joints and inputs they are.

    In radians and lengths of the mechanism; those of least residual where a pose did not close.
    """
    geometry, lengths = _scaled(system, joints)
    poses = lax.stop_gradient(poses)
    scaled = inputs / driven(system, lengths)
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
    """Poses of a single input: a few by themselves, the many between them by interpolation."""
    knots = follow(system, geometry, inputs[0])
    if inputs.shape[1] < MANY:
        return _in_groups(lambda values: _settle(system, geometry, knots, values), inputs[0])
    found, trusted = interpolate(system, geometry, knots, inputs[0])

    def settle(group: tuple[Array, Bool[Array, " poses"], Poses]) -> Poses:
        values, trusted, found = group
        return lax.cond(jnp.all(trusted), lambda: found, lambda: _settle(system, geometry, knots, values))

    return _in_groups(settle, (inputs[0], trusted, found))


def _in_groups(function: Callable, poses):
    """The function of some poses applied to all, in groups of equal size, so that hard ones cost only few others."""
    count = jax.tree.leaves(poses)[0].shape[-1]
    groups = -(-count // GROUP)
    if groups <= 1:
        return function(poses)
    length = -(-count // groups)

    def cut(array: Array) -> Array:
        padded = jnp.pad(array, [(0, 0)] * (array.ndim - 1) + [(0, groups * length - count)], mode="edge")
        return jnp.moveaxis(padded.reshape(*array.shape[:-1], groups, length), -2, 0)

    def join(array: Array) -> Array:
        return jnp.moveaxis(array, 0, -2).reshape(*array.shape[1:-1], groups * length)[..., :count]

    return jax.tree.map(join, lax.map(function, jax.tree.map(cut, poses)))


def _settle(system: LoopSystem, geometry: Geometry, knots: Knots, values: Float[Array, " poses"]) -> Poses:
    """Poses begun between the knots and brought to closure by the damped corrector."""
    begin = guess(system, knots, values)
    state = drive(system, begin.state, values[None])
    found = correct(system, geometry, state, RESCUE_STEPS)
    near = difference(found.state, state) <= FARTHEST_CORRECTION
    status = classify(found.closure.gap, found.stationary, near & (begin.status == Status.CLOSED.value))
    return Poses(found.state, jnp.where(begin.covered, status, Status.STALLED.value), found.closure.gap)


def _coordinates(system: LoopSystem, state: State) -> Float[Array, "columns poses"]:
    """The paper's coordinates: those of balls read off as theta, phi, psi and unwrapped along the poses."""
    x = state.x
    for ball, first in enumerate(system.balls):
        if first not in system.driven:
            x = x.at[first : first + 3].set(jnp.unwrap(angles(state.turns[ball]), axis=-1))
    return x
