"""A whole range of inputs for one loop system: continuation, then all poses at once (Section 5.1, Eq. 12 and 13).

The range of a single input is followed once, from the assembled pose to either end, at as few knots as are safe.
Between two knots every pose is predicted by cubic Hermite interpolation with exact slopes and brought to closure by
Newton steps, all poses at once and in whatever order they come. Poses for which that does not hold are settled by the
damped corrector alone, in small groups, so that they cost the others nothing. Several inputs are followed in the same
way along a smooth curve through the poses in the order in which they are given; what that does not reach is tried in a
straight line from the assembled pose.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.chords import TOGETHER, shared_steps
from jaxkin.solve.closure import Geometry, closure, loop_geometry
from jaxkin.solve.continuation import RESCUE_STEPS, reach
from jaxkin.solve.correct import choose, correct
from jaxkin.solve.dense import CLOSED, SHARP, Poses, interpolate
from jaxkin.solve.implicit import attach
from jaxkin.solve.knots import Knots, follow, guess
from jaxkin.solve.lanes import any_lane
from jaxkin.solve.methods import CONTINUATION
from jaxkin.solve.minimise import minimised
from jaxkin.solve.newton import newton
from jaxkin.solve.reading import ball_turns, read_off, unwrapped
from jaxkin.solve.state import State, assembled, difference, drive, driven
from jaxkin.solve.status import Scalar, Status, Tolerance, classify, is_closed, roundings
from jaxkin.solve.system import LoopSystem
from jaxkin.solve.way import curve_through

FARTHEST_CORRECTION = 0.1
"""Radians, or characteristic lengths: a pose farther from its prediction is not trusted to be on the branch."""
GROUP, LEAST_GROUP, ENTRIES, CHUNK = 256, 32, 16384, 256
"""Poses that are settled together: so few that hard ones cost only few others, and that their matrices, of so many
entries, stay in the cache; and poses whose balls are read off at once."""
FEW = 32
"""Hard poses that the damped corrector goes on with at once: most groups hold no more."""
MANY = 8192
"""From so many poses on most are interpolated."""


class Joints(NamedTuple):
    """The joints of a loop system, one entry a joint, as in `Joint`."""

    before: tuple[Float[Array, "frames 4 4"], ...]
    after: tuple[Float[Array, "frames 4 4"], ...]
    pitch: tuple[Float[Array, ""], ...]


def find_poses(
    system: LoopSystem,
    method: str,
    joints: Joints,
    inputs: Float[Array, "driven poses"],
    tolerance: Tolerance,
    share: int = 1,
    patient: Bool[Array, ""] | bool = True,
) -> Poses:
    """The poses for the given inputs, in the order of `system.driven`, radians and lengths of the mechanism.

    `method` is one of `methods.METHODS`. The inputs are one of so many pieces of a range: `share`. Who is not patient
    may find poses STALLED that would close.
    """
    joints, inputs = lax.stop_gradient((joints, inputs))
    geometry, lengths = scaled(system, joints)
    return _search(system, method, geometry, inputs / driven(system, lengths), tolerance, share, patient)


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
        return read_off(system, joints.before, joints.after, state.x * lengths, turns)

    given = inputs / driven(system, lengths), lax.stop_gradient(poses)
    if not system.balls:
        return read(given)
    return unwrapped(system, _in_groups(read, given, CHUNK))  # of all poses at once the matrices leave the cache


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
    patient: Bool[Array, ""] | bool,
) -> Poses:
    """The same in lengths over the characteristic length; NONFINITE where an input is."""
    finite = jnp.all(jnp.isfinite(inputs), axis=0)
    inputs = jnp.where(finite, inputs, 0.0)  # one NaN would keep every other pose waiting
    if not system.free:
        state = drive(system, assembled(system, inputs.shape[1], inputs.dtype), inputs)
        gap = closure(system, geometry, state).gap
        poses = Poses(state, classify(gap, finite, finite, tolerance.closed), gap)
    elif method != CONTINUATION:
        state, gap, status = minimised(system, geometry, inputs, method, tolerance.closed)
        poses = Poses(state, status, gap)
    elif len(system.driven) == 1:
        poses = _of_one_input(system, geometry, inputs[0], tolerance, share, patient)
    elif system.driven:
        poses = _of_several_inputs(system, geometry, inputs, tolerance, patient)
    else:
        poses = Poses(*reach(system, geometry, inputs))
    return poses._replace(status=jnp.where(finite, poses.status, Status.NONFINITE.value).astype(jnp.int32))


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
        return _settle(system, geometry, knots, values, values[None], tolerance, patient)

    settle = partial(_in_groups, settled, size=_group(system))
    poses = settle(values) if len(values) < MANY else interpolate(system, geometry, knots, values, settle, share)
    return _only(worth, poses)


def _only(worth: Bool[Array, ""], poses: Poses) -> Poses:
    """The poses, STALLED where a range was not worth the while."""
    return poses._replace(status=jnp.where(worth, poses.status, Status.STALLED.value))


def _of_several_inputs(
    system: LoopSystem,
    geometry: Geometry,
    inputs: Float[Array, "driven poses"],
    tolerance: Tolerance,
    patient: Bool[Array, ""] | bool,
) -> Poses:
    """The poses along a curve through all of them, and those that it does not reach."""
    at, way = curve_through(inputs)
    knots = follow(system, geometry, way, at, patient)
    worth = knots.whole | patient
    at, inputs = jnp.where(worth, at, 0.0), jnp.where(worth, inputs, 0.0)

    def settled(group: tuple[Array, Array]) -> Poses:
        at, inputs = group
        found = _settle(system, geometry, knots, at, inputs, tolerance, patient)
        failed = found.status != Status.CLOSED.value

        def otherwise() -> Poses:
            straight = Poses(*reach(system, geometry, jnp.where(failed, inputs, 0.0)))
            better = failed & ((straight.status == Status.CLOSED.value) | (found.status == Status.STALLED.value))
            return choose(better, straight, found)

        return lax.cond(any_lane(failed) & patient, otherwise, lambda: found)

    if len(at) < MANY:
        return _only(worth, _in_groups(settled, (at, inputs), _group(system)))

    def neighbours(group: tuple[Array, Array]) -> Poses:
        at, inputs = group
        begin = guess(system, knots, at)
        begun = drive(system, begin.state, inputs)
        state, gap = shared_steps(system, geometry, begun, roundings(at.dtype, SHARP))
        near = difference(state, begun) <= FARTHEST_CORRECTION
        good = (gap <= roundings(at.dtype, CLOSED)) & near & begin.covered & (begin.status == Status.CLOSED.value)
        return lax.cond(
            any_lane(~good),
            lambda: _in_groups(settled, group, _group(system)),
            lambda: Poses(state, begin.status, gap),
        )

    return _only(worth, _in_groups(neighbours, (at, inputs), TOGETHER))


def _group(system: LoopSystem) -> int:
    """Poses that are settled together."""
    return max(LEAST_GROUP, min(GROUP, ENTRIES // system.equations**2))


def _in_groups(function: Callable, poses, size: int):
    """The function of some poses applied to all, in groups of equal size."""
    count = jax.tree.leaves(poses)[0].shape[-1]
    groups = -(-count // size)
    if groups <= 1:
        return function(poses)
    length = -(-count // groups)

    def cut(array: Array) -> Array:
        padded = jnp.pad(array, [(0, 0)] * (array.ndim - 1) + [(0, groups * length - count)], mode="edge")
        return jnp.moveaxis(padded.reshape(*array.shape[:-1], groups, length), -2, 0)

    def join(array: Array) -> Array:
        return jnp.moveaxis(array, 0, -2).reshape(*array.shape[1:-1], groups * length)[..., :count]

    return jax.tree.map(join, lax.map(function, jax.tree.map(cut, poses)))


def _settle(
    system: LoopSystem,
    geometry: Geometry,
    knots: Knots,
    at: Float[Array, " poses"],
    inputs: Float[Array, "driven poses"],
    tolerance: Tolerance,
    patient: Bool[Array, ""] | bool,
) -> Poses:
    """Poses so far along the way, begun between the knots and brought to closure by the damped corrector."""
    begin = guess(system, knots, at)
    state = drive(system, begin.state, inputs)
    quick, _, gap = newton(system, geometry, state, tolerance.enough)
    near = difference(quick, state) <= FARTHEST_CORRECTION
    closes = gap <= jnp.maximum(roundings(at.dtype, CLOSED), tolerance.enough)
    good = closes & near & begin.covered & is_closed(begin.status)
    found = Poses(quick, jnp.where(good, begin.status, Status.STALLED.value), gap)

    def with_care() -> Poses:
        careful, gap, stationary = _correct_few(system, geometry, state, ~good, tolerance.enough)
        near = difference(careful, state) <= FARTHEST_CORRECTION
        same = near & (begin.status == Status.CLOSED.value)
        status = classify(gap, stationary, same, tolerance.closed)
        status = jnp.where(begin.covered, status, Status.STALLED.value)
        return choose(good, found, Poses(careful, status, gap))

    return lax.cond(any_lane(~good) & patient, with_care, lambda: found)


def _correct_few(
    system: LoopSystem, geometry: Geometry, state: State, hard: Bool[Array, " poses"], enough: Scalar | float
) -> tuple[State, Float[Array, " poses"], Bool[Array, " poses"]]:
    """The hard ones of some poses as `correct` leaves them, a few at a time; their gaps; which are stationary."""
    poses = hard.shape[0]
    few = min(FEW, poses)
    order = jnp.argsort(~hard)
    count = jnp.sum(hard)
    begin = jax.tree.map(lambda array: array[..., order], state)

    def running(carry) -> Array:
        return any_lane(carry[0] < count)

    def step(carry):
        number, found = carry
        own = jax.tree.map(lambda array: lax.dynamic_slice_in_dim(array, number, few, axis=-1), begin)
        here = correct(system, geometry, own, RESCUE_STEPS, enough)
        found = jax.tree.map(
            lambda whole, part: lax.dynamic_update_slice_in_dim(whole, part, number, axis=-1),
            found,
            (here.state, here.gap, here.stationary),
        )
        return number + few, found

    nothing = begin, jnp.zeros(poses, state.x.dtype), jnp.zeros(poses, bool)
    found = lax.while_loop(running, step, (jnp.asarray(0), nothing))[1]
    back = jnp.argsort(order)
    return jax.tree.map(lambda array: array[..., back], found)
