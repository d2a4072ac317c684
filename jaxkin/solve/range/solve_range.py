"""Solve a whole range of inputs of one loop system: continuation, then all poses at once (Section 5.1, Eq. 12 and 13).

For a single input, the branch is traced once from the assembled pose to both ends of the range, in as few samples as
are safe (`continuation.branch`). Every pose is then predicted between two samples by a cubic with exact slopes, and
corrected; this is done for all poses at once, in any order (`polish`). Of long ranges most poses are interpolated
(`interpolation`). For several inputs, the branch is traced along a smooth curve through the poses, in the order in
which they are given; poses that are not reached along the curve are tried along others (`other_paths`).
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int, Shaped

from jaxkin.solve.closure.closure import Geometry, closure, scaled_geometry
from jaxkin.solve.closure.joint_coordinates import ball_rotations, joint_coordinates, unwrap_ball_angles
from jaxkin.solve.continuation.branch import trace_branch
from jaxkin.solve.continuation.branch_samples import BranchSamples, predict
from jaxkin.solve.continuation.fronts import ContinuationProblem
from jaxkin.solve.continuation.input_path import curve_through
from jaxkin.solve.continuation.reach import reach
from jaxkin.solve.correctors.chord_newton import CHORD_BATCH, chord_newton
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.device import on_cpu
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.options import CONTINUATION, SolverOptions
from jaxkin.solve.range.groups import group_size, in_groups
from jaxkin.solve.range.implicit_derivative import attach_derivative
from jaxkin.solve.range.interpolation import SHARP_ROUNDINGS, interpolate
from jaxkin.solve.range.other_paths import try_other_paths
from jaxkin.solve.range.polish import correct_poses
from jaxkin.solve.range.poses import MAX_CORRECTION, RangePoses
from jaxkin.solve.reference_methods.minimise import minimise_each
from jaxkin.solve.status import (
    CLOSED_ROUNDINGS,
    ClosureTolerance,
    Status,
    classify,
    closes_before_limits,
    rounding_residual,
)
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import assembled, difference, drive, driven

DERIVATIVE_GROUP = 128
"""Number of poses whose displacements and derivatives are computed at once, on CPUs: the Jacobians of so many stay in
the cache while they are eliminated. A derivative of 10,000 poses of the paper's Fig. 7 takes 0.16 s so, and 0.83 s with
all poses at once; of a four-bar without formulas 6 and 10 ms."""


class Shard(NamedTuple):
    """Which poses of a range are to be found, by default all, and how far."""

    count: int = 1
    """Number of shards of the range, each as long."""
    start: Int[Array, ""] | None = None
    """Number of the first pose of the shard; None where the inputs are those of the shard alone."""
    follow_limits: Bool[Array, ""] | bool = True
    """Without it, poses behind a limit may be reported STALLED."""

    def of(self, array: Shaped[Array, "*rows poses"]) -> Shaped[Array, "*rows shard"]:
        """Cut the shard from an array."""
        if self.start is None:
            return array
        return lax.dynamic_slice_in_dim(array, self.start, -(-array.shape[-1] // self.count), axis=-1)


class _Range(NamedTuple):
    """A range to be solved, in radians and lengths over the characteristic length: see `find_poses`."""

    geometry: Geometry
    inputs: Float[Array, "driven poses"]
    tolerance: ClosureTolerance
    shard: Shard


def find_poses(
    system: LoopSystem,
    options: SolverOptions,
    joints: Joints,
    inputs: Float[Array, "driven poses"],
    tolerance: ClosureTolerance,
    shard: Shard,
) -> RangePoses:
    """Find the poses of a range, or of one shard of it, for finite inputs, radians and lengths of the mechanism.

    The rows of `inputs` are in the order of `system.driven`.
    """
    joints, inputs = lax.stop_gradient((joints, inputs))
    geometry, lengths = scaled_geometry(system, joints)
    asked = _Range(geometry, inputs / driven(system, lengths), tolerance, shard)
    poses = _by_method(system, options, asked)
    # correctors take what rounding leaves for closed, whatever tolerance was asked for
    rough = closes_before_limits(poses.status) & (poses.residual_norm > tolerance.max_residual)
    return poses._replace(status=jnp.where(rough, Status.STALLED.value, poses.status).astype(jnp.int32))


def displacements(
    system: LoopSystem,
    joints: Joints,
    inputs: Float[Array, "driven poses"],
    poses: RangePoses,
    size: int | None = DERIVATIVE_GROUP,
) -> Float[Array, "columns poses"]:
    """Compute the displacements of all joints in the poses found, as differentiable functions of joints and inputs.

    Displacements are in radians and lengths of the mechanism. A pose that did not close has derivatives of zero. On
    CPUs, poses are taken in groups of `size`; None for all at once.
    """
    geometry, lengths = scaled_geometry(system, joints)

    def of_group(group: tuple[Array, RangePoses]) -> Float[Array, "columns group"]:
        inputs, poses = group
        state = attach_derivative(system, geometry, inputs, poses.state, closes_before_limits(poses.status))
        rotations = ball_rotations(system, geometry, state)
        return joint_coordinates(system, joints.frames_1, joints.frames_2, state.x * lengths, rotations)

    given = inputs / driven(system, lengths), lax.stop_gradient(poses)
    found = in_groups(of_group, given, size or max(1, inputs.shape[1])) if system.free else of_group(given)
    return unwrap_ball_angles(system, found) if system.balls else found


def _by_method(system: LoopSystem, options: SolverOptions, asked: _Range) -> RangePoses:
    """Find the poses by the method of the options."""
    geometry, tolerance = asked.geometry, asked.tolerance
    inputs = asked.shard.of(asked.inputs)
    if not system.free:
        state = drive(system, assembled(system, inputs.shape[1], inputs.dtype), inputs)
        residual_norm = closure(system, geometry, state).residual_norm
        yes = jnp.ones_like(residual_norm, bool)
        return RangePoses(state, classify(residual_norm, yes, yes, tolerance.max_residual), residual_norm)
    if options.method != CONTINUATION:
        state, status, residual_norm = minimise_each(system, geometry, inputs, options.method, tolerance.max_residual)
        return RangePoses(state, status, residual_norm)
    if len(system.driven) == 1:
        return _of_one_input(system, options, asked._replace(inputs=inputs))
    if system.driven:
        return _of_several_inputs(system, options, asked)
    return RangePoses(*reach(ClosureProblem(system, geometry, options), inputs, inputs))


def _of_one_input(system: LoopSystem, options: SolverOptions, asked: _Range) -> RangePoses:
    """Find the poses of a single input: on CPUs by interpolation if there are at least `options.interpolate_from`."""
    values = asked.inputs[0]

    def identity(at: Float[Array, " fronts"]) -> tuple[Array, Array]:
        return at[None], jnp.ones_like(at)[None]

    problem = ContinuationProblem(system, asked.geometry, options, identity, asked.shard.follow_limits)
    samples = trace_branch(problem, values)
    kept = samples.complete | asked.shard.follow_limits
    values = jnp.where(kept, values, 0.0)

    def corrected(values: Float[Array, " poses"]) -> RangePoses:
        return correct_poses(problem, samples, values, values[None], asked.tolerance)

    one_by_one = partial(in_groups, corrected, size=group_size(system))
    if len(values) < options.interpolate_from or not on_cpu():
        return _stalled_unless(kept, one_by_one(values))
    return _stalled_unless(kept, interpolate(problem, samples, values, one_by_one, asked.shard.count))


def _of_several_inputs(system: LoopSystem, options: SolverOptions, asked: _Range) -> RangePoses:
    """Find the poses of several inputs along a curve through all poses; along other paths where that fails."""
    geometry, follow_limits = asked.geometry, asked.shard.follow_limits
    at, path = curve_through(asked.inputs)
    at, inputs = (asked.shard.of(array) for array in (at, asked.inputs))
    problem = ContinuationProblem(system, geometry, options, path, follow_limits)
    samples = trace_branch(problem, at)
    kept = samples.complete | follow_limits
    at, inputs = jnp.where(kept, at, 0.0), jnp.where(kept, inputs, 0.0)

    def corrected(group: tuple[Array, Array]) -> RangePoses:
        at, inputs = group
        return correct_poses(problem, samples, at, inputs, asked.tolerance)

    one_by_one = partial(in_groups, corrected, size=group_size(system))
    if len(at) < options.interpolate_from or not on_cpu():
        found = one_by_one((at, inputs))
    else:
        found = in_groups(partial(_of_neighbours, problem, samples, one_by_one), (at, inputs), CHORD_BATCH)
    if follow_limits is not False:  # known when the program is made: else it holds no second continuation
        failed = any_in_lockstep(found.status != Status.CLOSED.value) & follow_limits
        found = lax.cond(failed, lambda: try_other_paths(problem, at, inputs, found), lambda: found)
    return _stalled_unless(kept, found)


def _of_neighbours(
    problem: ClosureProblem, samples: BranchSamples, one_by_one, group: tuple[Array, Array]
) -> RangePoses:
    """Correct a group of neighbouring poses by chord steps, or by `one_by_one` if any of them does not close."""
    at, inputs = group
    prediction = predict(problem.system, samples, at)
    begun = drive(problem.system, prediction.state, inputs)
    state, residual_norm = chord_newton(problem, begun, rounding_residual(at.dtype, SHARP_ROUNDINGS))
    closes = residual_norm <= rounding_residual(at.dtype, CLOSED_ROUNDINGS)
    near = difference(state, begun) <= MAX_CORRECTION
    good = closes & near & prediction.covered & (prediction.status == Status.CLOSED.value)
    return lax.cond(
        any_in_lockstep(~good),
        lambda: one_by_one(group),
        lambda: RangePoses(state, prediction.status, residual_norm),
    )


def _stalled_unless(kept: Bool[Array, ""], poses: RangePoses) -> RangePoses:
    """Return the poses, with status STALLED if their range was not traced completely and limits are not followed."""
    return poses._replace(status=jnp.where(kept, poses.status, Status.STALLED.value))
