"""A whole range of inputs for one loop system: continuation, then all poses at once (Section 5.1, Eq. 12 and 13).

The range of a single input is followed once, from the assembled pose to either end, at as few knots as are safe.
Between two knots every pose is predicted by cubic Hermite interpolation with exact slopes and brought to closure, all
poses at once and in whatever order they come: see `settle`; of many most are interpolated: see `dense`. Several inputs
are followed in the same way along a smooth curve through the poses in the order in which they are given; what that does
not reach is tried in a straight line from the assembled pose.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int, Shaped

from jaxkin.solve.closure.closure import Geometry, closure, loop_geometry
from jaxkin.solve.closure.joint_coordinates import ball_turns, read_off, unwrapped
from jaxkin.solve.continuation.branch import follow, guess
from jaxkin.solve.continuation.input_path import curve_through
from jaxkin.solve.continuation.step import reach
from jaxkin.solve.correctors.chord_newton import TOGETHER, shared_steps
from jaxkin.solve.correctors.levenberg_marquardt import choose
from jaxkin.solve.execution.lockstep import any_lane
from jaxkin.solve.methods import CONTINUATION
from jaxkin.solve.range.implicit_derivative import attach
from jaxkin.solve.range.interpolation import CLOSED, SHARP, Poses, interpolate
from jaxkin.solve.range.polish import FARTHEST_CORRECTION, group_size, in_groups, settle
from jaxkin.solve.reference_methods.minimise import minimised
from jaxkin.solve.status import Status, Tolerance, classify, is_closed, roundings
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import assembled, difference, drive, driven

MANY, CHUNK = 8192, 256
"""From so many poses on most are interpolated; poses whose balls are read off at once."""


class Joints(NamedTuple):
    """The joints of a loop system, one entry a joint, as in `Joint`."""

    frames_1: tuple[Float[Array, "frames 4 4"], ...]
    frames_2: tuple[Float[Array, "frames 4 4"], ...]
    pitch: tuple[Float[Array, ""], ...]


def find_poses(
    system: LoopSystem,
    method: str,
    joints: Joints,
    inputs: Float[Array, "driven poses"],
    tolerance: Tolerance,
    share: int = 1,
    begin: Int[Array, ""] | None = None,
    patient: Bool[Array, ""] | bool = True,
) -> Poses:
    """The poses for the given finite inputs, in the order of `system.driven`, radians and lengths of the mechanism.

    `method` is one of `methods.METHODS`. The inputs are one of so many pieces of a range: `share`; or those of the
    whole range, of which the piece that begins with this number is asked for. Who is not patient may find poses STALLED
    that would close.
    """
    joints, inputs = lax.stop_gradient((joints, inputs))
    geometry, lengths = scaled(system, joints)
    return _search(system, method, geometry, inputs / driven(system, lengths), tolerance, share, begin, patient)


def piece(
    array: Shaped[Array, "*rows poses"], share: int, begin: Int[Array, ""] | None
) -> Shaped[Array, "*rows piece"]:
    """The piece of the poses that begins with this number, of so many of equal length; all of them without one."""
    if begin is None:
        return array
    return lax.dynamic_slice_in_dim(array, begin, -(-array.shape[-1] // share), axis=-1)


def displacements(
    system: LoopSystem, joints: Joints, inputs: Float[Array, "driven poses"], poses: Poses
) -> Float[Array, "columns poses"]:
    """Displacements of all joints in the poses found, as the differentiable functions of joints and inputs they are.

    In radians and lengths of the mechanism; those of least residual where a pose did not close.
    """
    geometry, lengths = scaled(system, joints)

    def read(group: tuple[Array, Poses]) -> Float[Array, "columns group"]:
        inputs, poses = group
        state = attach(system, geometry, inputs, poses.state, is_closed(poses.status))
        turns = ball_turns(system, geometry, state)
        return read_off(system, joints.frames_1, joints.frames_2, state.x * lengths, turns)

    given = inputs / driven(system, lengths), lax.stop_gradient(poses)
    if not system.balls:
        return read(given)
    return unwrapped(system, in_groups(read, given, CHUNK))  # of all poses at once the matrices leave the cache


def scaled(system: LoopSystem, joints: Joints) -> tuple[Geometry, Float[Array, "columns 1"]]:
    """The geometry, and what the coordinates of the solver are multiplied by to be those of the mechanism."""
    geometry, length = loop_geometry(system, *joints)
    return geometry, jnp.where(jnp.array(system.is_length, bool), length, 1.0)[:, None]


def _search(
    system: LoopSystem,
    method: str,
    geometry: Geometry,
    inputs: Float[Array, "driven poses"],
    tolerance: Tolerance,
    share: int,
    begin: Int[Array, ""] | None,
    patient: Bool[Array, ""] | bool,
) -> Poses:
    """The same in lengths over the characteristic length."""
    whole, inputs = inputs, piece(inputs, share, begin)
    if not system.free:
        state = drive(system, assembled(system, inputs.shape[1], inputs.dtype), inputs)
        gap = closure(system, geometry, state).gap
        yes = jnp.ones_like(gap, bool)
        poses = Poses(state, classify(gap, yes, yes, tolerance.closed), gap)
    elif method != CONTINUATION:
        state, gap, status = minimised(system, geometry, inputs, method, tolerance.closed)
        poses = Poses(state, status, gap)
    elif len(system.driven) == 1:
        poses = _of_one_input(system, geometry, inputs[0], tolerance, share, patient)
    elif system.driven:
        poses = _of_several_inputs(system, geometry, whole, tolerance, share, begin, patient)
    else:
        poses = Poses(*reach(system, geometry, inputs))
    return poses._replace(status=poses.status.astype(jnp.int32))


def _of_one_input(
    system: LoopSystem,
    geometry: Geometry,
    values: Float[Array, " poses"],
    tolerance: Tolerance,
    share: int,
    patient: Bool[Array, ""] | bool,
) -> Poses:
    """A few poses by themselves, the many between them by interpolation."""
    knots = follow(system, geometry, lambda at: (at[None], jnp.ones_like(at)[None]), values, patient)
    worth = knots.whole | patient
    values = jnp.where(worth, values, 0.0)

    def settled(values: Float[Array, " poses"]) -> Poses:
        return settle(system, geometry, knots, values, values[None], tolerance, patient)

    one_by_one = partial(in_groups, settled, size=group_size(system))
    few = len(values) < MANY
    poses = one_by_one(values) if few else interpolate(system, geometry, knots, values, one_by_one, share)
    return _only(worth, poses)


def _only(worth: Bool[Array, ""], poses: Poses) -> Poses:
    """The poses, STALLED where a range was not worth the while."""
    return poses._replace(status=jnp.where(worth, poses.status, Status.STALLED.value))


def _of_several_inputs(
    system: LoopSystem,
    geometry: Geometry,
    inputs: Float[Array, "driven poses"],
    tolerance: Tolerance,
    share: int,
    begin: Int[Array, ""] | None,
    patient: Bool[Array, ""] | bool,
) -> Poses:
    """The poses along a curve through all of them, and those that it does not reach."""
    at, way = curve_through(inputs)
    at, inputs = (piece(array, share, begin) for array in (at, inputs))
    knots = follow(system, geometry, way, at, patient)
    worth = knots.whole | patient
    at, inputs = jnp.where(worth, at, 0.0), jnp.where(worth, inputs, 0.0)

    def settled(group: tuple[Array, Array]) -> Poses:
        at, inputs = group
        found = settle(system, geometry, knots, at, inputs, tolerance, patient)
        failed = found.status != Status.CLOSED.value

        def otherwise() -> Poses:
            straight = Poses(*reach(system, geometry, jnp.where(failed, inputs, 0.0)))
            better = failed & ((straight.status == Status.CLOSED.value) | (found.status == Status.STALLED.value))
            return choose(better, straight, found)

        return lax.cond(any_lane(failed) & patient, otherwise, lambda: found)

    if len(at) < MANY:
        return _only(worth, in_groups(settled, (at, inputs), group_size(system)))

    def neighbours(group: tuple[Array, Array]) -> Poses:
        at, inputs = group
        begin = guess(system, knots, at)
        begun = drive(system, begin.state, inputs)
        state, gap = shared_steps(system, geometry, begun, roundings(at.dtype, SHARP))
        near = difference(state, begun) <= FARTHEST_CORRECTION
        good = (gap <= roundings(at.dtype, CLOSED)) & near & begin.covered & (begin.status == Status.CLOSED.value)
        return lax.cond(
            any_lane(~good),
            lambda: in_groups(settled, group, group_size(system)),
            lambda: Poses(state, begin.status, gap),
        )

    return _only(worth, in_groups(neighbours, (at, inputs), TOGETHER))
