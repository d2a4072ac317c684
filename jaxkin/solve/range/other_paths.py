"""Try poses of several inputs that a curve through all poses did not reach along other paths of the inputs.

Each leads from the assembled pose to one pose. The first path is a straight line. Poses that close behind an
unreachable interval are then tried along two parabolas, on which one half of the inputs goes ahead of the other: a pose
that none of them reaches may still be on the branch.

A path is followed by a continuation of its own. One that meets a limit takes a hundred steps, and so do all that are
followed beside it: paths are followed in small groups, and as few as tell what the other poses are. Where none leads to
two poses that are no farther apart than `CELL`, and all states between them are close to each other and of one status,
none is tried to the poses between.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.continuation.reach import reach
from jaxkin.solve.continuation.step import BEYOND_LIMIT_STEP
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.device import group_for_device
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.range.poses import MAX_CORRECTION, RangePoses
from jaxkin.solve.status import Status
from jaxkin.solve.system.state import State, difference, select_poses

PATHS = 16
"""Number of paths that are followed together on CPUs: beside one that meets a limit, more would wait for it."""
CELL = BEYOND_LIMIT_STEP
"""Largest distance along the curve, radians or characteristic lengths, between two poses that are tried."""


class _Tried(NamedTuple):
    """What the paths followed so far have told."""

    poses: RangePoses
    tried: Bool[Array, " poses"]
    reached: Bool[Array, " poses"]


def try_other_paths(
    problem: ClosureProblem,
    at: Float[Array, " poses"],
    inputs: Float[Array, "driven poses"],
    found: RangePoses,
) -> RangePoses:
    """Replace poses that are not CLOSED by those to which other paths lead from the assembled pose.

    `at` are the distances of the poses along the curve, which grow; `inputs` are in radians and characteristic lengths.
    """
    leads = (jnp.arange(inputs.shape[0]) < inputs.shape[0] // 2)[:, None]

    def followed(kind: Int[Array, ""], found: RangePoses) -> RangePoses:
        failed = found.status != Status.CLOSED.value
        failed &= (kind == 0) | (found.status == Status.JUMPED.value)
        ahead = jnp.where(kind == 0, 0.5, jnp.where(leads, kind == 1, kind == 2))
        return _follow(problem, at, inputs, ahead * inputs, found, failed)

    return lax.fori_loop(0, 3, followed, found)


def _follow(
    problem: ClosureProblem,
    at: Float[Array, " poses"],
    inputs: Float[Array, "driven poses"],
    bends: Float[Array, "driven poses"],
    found: RangePoses,
    failed: Bool[Array, " poses"],
) -> RangePoses:
    """Replace `failed` poses by those to which the parabolas with control points `bends` lead."""
    poses = failed.shape[0]
    together = group_for_device(PATHS)
    number, run, cell = jnp.arange(poses), _runs(found), jnp.floor(at / (0.5 * CELL))
    parted = jnp.concatenate([jnp.ones(1, bool), (run[1:] != run[:-1])])
    ends = parted | jnp.roll(parted, -1)
    first = ends | jnp.concatenate([jnp.ones(1, bool), cell[1:] != cell[:-1]])

    def left(now: _Tried) -> Bool[Array, " poses"]:
        before = lax.cummax(jnp.where(now.tried, number, 0))
        after = lax.cummin(jnp.where(now.tried, number, poses - 1), reverse=True)
        alone = jnp.ones(poses, bool)
        for end in (before, after):
            alone &= now.tried[end] & ~now.reached[end] & (run[end] == run)
        return failed & ~now.tried & ~(alone & (at[after] - at[before] <= CELL))

    def step(now: _Tried) -> _Tried:
        open_poses = left(now)
        chosen = jnp.where(jnp.any(open_poses & first), open_poses & first, open_poses)
        which = jnp.argsort(~chosen)[:together]
        chosen, begun = chosen[which], jax.tree.map(lambda array: array[..., which], now.poses)
        ends = (jnp.where(chosen, given[:, which], 0.0) for given in (inputs, bends))
        other = RangePoses(*reach(problem, *ends))
        reached = chosen & (other.status == Status.CLOSED.value)
        better = reached | chosen & (begun.status == Status.STALLED.value)
        poses = select_poses(better, other, begun)
        return jax.tree.map(
            lambda whole, part: whole.at[..., which].set(part),
            now,
            _Tried(poses, now.tried[which] | chosen, now.reached[which] | reached),
        )

    nothing = jnp.zeros(poses, bool)
    return lax.while_loop(lambda now: any_in_lockstep(left(now)), step, _Tried(found, nothing, nothing)).poses


def _runs(found: RangePoses) -> Int[Array, " poses"]:
    """Number the runs of neighbouring poses of one status, with states that are close to each other.

    A STALLED pose, whose state says nothing, is a run by itself.
    """
    one, other = (State(*(part[..., cut] for part in found.state)) for cut in (slice(None, -1), slice(1, None)))
    alike = (found.status[1:] == found.status[:-1]) & (found.status[1:] != Status.STALLED.value)
    alike &= difference(one, other) <= MAX_CORRECTION
    return jnp.concatenate([jnp.zeros(1, jnp.int32), jnp.cumsum(~alike, dtype=jnp.int32)])
