"""Poses one by one: from where the knots put them to closure, whatever lies between them.

Newton's method closes nearly all. Those that it does not, for they lie beside a limit or beyond one, are left to the
damped corrector, which goes on with them alone, so that they cost the others nothing.
"""

from __future__ import annotations

from collections.abc import Callable

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.solve.closure.closure import Geometry
from jaxkin.solve.continuation.branch import Knots, guess
from jaxkin.solve.continuation.step import RESCUE_STEPS
from jaxkin.solve.correctors.levenberg_marquardt import choose, correct
from jaxkin.solve.correctors.newton import newton
from jaxkin.solve.execution.lockstep import any_lane
from jaxkin.solve.range.interpolation import CLOSED, Poses
from jaxkin.solve.status import Scalar, Status, Tolerance, classify, is_closed, roundings
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, difference, drive

FARTHEST_CORRECTION = 0.1
"""Radians, or characteristic lengths: a pose farther from its prediction is not trusted to be on the branch."""
GROUP, LEAST_GROUP, ENTRIES = 256, 32, 16384
"""Poses that are settled together: so many that their matrices, of so many entries, stay in the cache."""
FEW = 32
"""Hard poses that the damped corrector goes on with at once: most groups hold no more."""


def group_size(system: LoopSystem) -> int:
    """Poses that are settled together."""
    return max(LEAST_GROUP, min(GROUP, ENTRIES // system.equations**2))


def in_groups(function: Callable, poses, size: int):
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


def settle(
    system: LoopSystem,
    geometry: Geometry,
    knots: Knots,
    at: Float[Array, " poses"],
    inputs: Float[Array, "driven poses"],
    tolerance: Tolerance,
    patient: Bool[Array, ""] | bool,
) -> Poses:
    """Poses so far along the way, begun between the knots and brought to closure by Newton's method.

    Where that fails, the patient go on with the damped corrector; without it such poses are STALLED.
    """
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
