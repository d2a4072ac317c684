"""Trace the branch of the assembled pose to both ends of a range, in as few steps as are safe.

If the input is an angle, the forward and the backward front meet a full turn apart (`MEETING`). If they are in the same
pose there, the mechanism repeats after a full turn of the input, and no more than one turn is traced.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closure.joint_coordinates import ball_rotations
from jaxkin.solve.continuation.branch_samples import MEETING, BranchSamples, sample_rows, winding
from jaxkin.solve.continuation.fronts import ContinuationProblem, Fronts, arrived, assembled_fronts, stopped_at_limit
from jaxkin.solve.continuation.step import substep
from jaxkin.solve.lockstep import any_in_lockstep, write_row
from jaxkin.solve.status import Status
from jaxkin.solve.system.state import State

LEAST_MAX_STEPS = 1024
"""Least number of steps to either side of the assembled pose that `max_steps=None` allows: a full turn takes about 25,
and about 50 more for each of its limits."""
COUNTED_POSES = 1024
"""Largest number of poses for which `max_steps=None` allows further steps: in longer ranges one step passes several
poses."""
STEPS_A_POSE = 2
"""Steps that `max_steps=None` allows for each pose of a single input, up to `COUNTED_POSES`."""
STEPS_A_POSE_OF_SEVERAL = 12
"""Steps that `max_steps=None` allows for each pose of several inputs, up to `COUNTED_POSES`: inputs in random order
take about eight steps a pose."""
MAX_STEPS_TO_LIMITS = 48
"""Largest number of steps if limits are not followed: nine of ten ranges without a limit take no more. A program that
never follows limits has room for as many samples only: to clear room for 1024 takes a tenth of a short sweep."""
SAME_POSE = 1e-9
"""Largest difference of coordinates, radians or characteristic lengths, of two fronts in one pose in float64: far above
the residual to which poses of the trace are closed, about 1e-14."""
SAME_POSE_SINGLE = 1e-4
"""Largest difference of coordinates of two fronts in one pose in float32, radians or characteristic lengths."""


class _Trace(NamedTuple):
    """The carry of the loop over the steps."""

    fronts: Fronts
    count: Int[Array, ""]
    limits: Float[Array, "2"]
    """Distance along the path that each front closed last before it met a limit; -inf and inf where it has met none."""
    parted: Bool[Array, ""]
    """Whether the fronts, a full turn apart, were found in different poses."""
    table: Float[Array, "samples entries"]


def trace_branch(problem: ContinuationProblem, values: Float[Array, " poses"]) -> BranchSamples:
    """Sample the branch from the assembled pose to the least and the greatest of `values`, distances along the path.

    If the input is an angle and one front meets a limit, the other front goes on to a full turn from that limit: poses
    behind the limit may be reached from the other side. With `follow_limits=False` of the problem, both fronts stop at
    limits, and after `MAX_STEPS_TO_LIMITS` steps.
    """
    system, dtype = problem.system, values.dtype
    room = _max_steps(problem, values.shape[0])
    ends = jnp.stack([jnp.min(values, initial=0.0), jnp.max(values, initial=0.0)])
    turn, meeting = jnp.array([-TURN, TURN], dtype), jnp.array(MEETING, dtype)
    beyond_meeting = (ends[0] < meeting[0]) | (ends[1] > meeting[1])
    fronts = assembled_fronts(system, 2, dtype)
    table = jnp.zeros((2 * room + 2, sample_rows(system, fronts).shape[1]), dtype)
    no_limits, no = jnp.array([-jnp.inf, jnp.inf], dtype), jnp.asarray(False)

    def target(trace: _Trace) -> Float[Array, "2"]:
        if not system.periodic:
            return ends
        at, limits = trace.fronts.at, trace.limits
        turn_from_limits = (limits - turn)[::-1]
        outer = jnp.where(jnp.isfinite(turn_from_limits), turn_from_limits, ends)
        wider = jnp.stack([jnp.minimum(ends[0], outer[0]), jnp.maximum(ends[1], outer[1])])
        goal = jnp.where(beyond_meeting & ~trace.parted & ~jnp.any(jnp.isfinite(limits)), meeting, wider)
        return jnp.stack([jnp.minimum(goal[0], at[0]), jnp.maximum(goal[1], at[1])])  # no front turns back

    def running(trace: _Trace) -> Array:
        max_steps = jnp.where(problem.follow_limits, room, min(room, MAX_STEPS_TO_LIMITS))
        stopped = stopped_at_limit(trace.fronts, problem.follow_limits)
        return (trace.count < max_steps) & any_in_lockstep(~arrived(trace.fronts, target(trace)) & ~stopped)

    def step(trace: _Trace) -> _Trace:
        fronts = substep(problem, trace.fronts, target(trace))
        # falling samples before the middle, rising ones behind it; after a step that was refused the same sample again,
        # so that all fronts, those of other designs in the batch too, write at one place
        row = sample_rows(system, fronts)
        table = write_row(write_row(trace.table, row[0], room - trace.count), row[1], room + 1 + trace.count)
        at_limit = fronts.anchored & (fronts.status != Status.CLOSED.value) & ~jnp.isfinite(trace.limits)
        parted = trace.parted
        if system.periodic:
            met = jnp.all(fronts.at == meeting)
            apart = lax.cond(any_in_lockstep(met), lambda: ~_same_pose(problem, fronts.state), lambda: no)
            parted |= met & apart
        # the limit is behind the front before this step, which may have passed all of a narrow gap
        limits = jnp.where(at_limit, trace.fronts.at, trace.limits)
        return _Trace(fronts, trace.count + 1, limits, parted, table)

    trace = lax.while_loop(running, step, _Trace(fronts, jnp.asarray(0), no_limits, no, table))
    fronts, count, limits, parted, table = trace
    number, first, last = jnp.arange(2 * room + 2), room + 1 - count, room + count
    at = jnp.where(number < first, -jnp.inf, jnp.where(number > last, jnp.inf, table[:, 0]))
    complete = jnp.all(arrived(fronts, target(trace)) & ~jnp.isfinite(limits))
    repeats = ~parted & jnp.all(fronts.at == meeting) & ~jnp.any(jnp.isfinite(limits)) & system.periodic
    return BranchSamples(at, table, first, last, repeats, winding(system, problem.geometry, fronts.state), complete)


def _max_steps(problem: ContinuationProblem, poses: int) -> int:
    """Return the largest number of steps to either side of the assembled pose for a number of poses."""
    steps = problem.options.max_steps
    if steps is None:
        each = STEPS_A_POSE if len(problem.system.driven) == 1 else STEPS_A_POSE_OF_SEVERAL
        steps = max(LEAST_MAX_STEPS, each * min(poses, COUNTED_POSES))
    return min(steps, MAX_STEPS_TO_LIMITS) if problem.follow_limits is False else steps


def _same_pose(problem: ContinuationProblem, state: State) -> Bool[Array, ""]:
    """Tell whether two fronts are in the same pose, up to full turns of coordinates and idle spins of rods.

    The rotations of balls at which loops are cut follow from the other coordinates.
    """
    system = problem.system
    same = SAME_POSE if jnp.finfo(state.x.dtype).bits == 64 else SAME_POSE_SINGLE
    rest = jnp.max(jnp.abs(state.x[:, 1] - state.x[:, 0] - winding(system, problem.geometry, state)))
    if system.turned_balls:
        for rotation in ball_rotations(system, problem.geometry, state).values():
            rest = jnp.maximum(rest, jnp.max(jnp.abs(rotation[..., 1] - rotation[..., 0])))
    return rest <= same
