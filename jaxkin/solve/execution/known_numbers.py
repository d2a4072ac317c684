"""Solve ranges of known (not traced) numbers by whole programs: with or without limits, in shards, compiled together.

Most ranges need only the program that follows no limits, which takes half as long to compile.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin._traced import traced
from jaxkin.solve.device import on_cpu
from jaxkin.solve.execution.compiler import count_trace, jit_options
from jaxkin.solve.execution.cores import available_cores, first_shard, is_monotonic, run_on_cores, shard_count
from jaxkin.solve.options import CONTINUATION, SolverOptions
from jaxkin.solve.range.solve_range import Shard, displacements, find_poses
from jaxkin.solve.status import ClosureTolerance, Status
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem

_together: set[tuple[Any, ...]] = set()
"""Systems, options and sizes of the ranges whose programs were compiled together."""
_limited: set[tuple[Any, ...]] = set()
"""Systems, options and sizes of the ranges that were found to have limits on their way."""


class Outcome(NamedTuple):
    """The status and the residual norm of each pose."""

    status: Int[Array, " poses"]
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""


class KnownRange(NamedTuple):
    """A range of known numbers of one loop system."""

    system: LoopSystem
    options: SolverOptions
    joints: Joints
    inputs: np.ndarray
    """(driven, poses), radians or lengths of the mechanism."""
    tolerance: ClosureTolerance

    @property
    def key(self) -> tuple[Any, ...]:
        """What decides which program is compiled."""
        return self.system, self.options.of_program, self.inputs.shape, self.inputs.dtype

    @property
    def shards(self) -> int:
        """Number of shards in which the range is solved."""
        return shard_count(self.system, self.inputs, self.options)

    def solve_shard(
        self, function: Callable[..., Any], follow_limits: bool, inputs: np.ndarray, start: Any = None
    ) -> Any:
        """Call the program of the range, or what lowers it, for one shard and the number of its first pose."""
        settings = {"shard_count": self.shards, "follow_limits": follow_limits}
        return function(self.system, self.options.of_program, self.joints, inputs, self.tolerance, start, **settings)

    def lowered(self) -> Any:
        """Lower the program that follows no limits for the first shard, and with that for all."""
        shard = first_shard(self.system, _in_order(self.inputs, self.options.interpolate_from)[0], self.shards)
        return self.solve_shard(_solve_program().lower, False, *shard)


def solve_numbers(asked: KnownRange, limits_ahead: bool) -> tuple[Float[Array, "columns poses"], Outcome]:
    """Solve a range, a long one in shards.

    The program that follows limits is compiled where the other one leaves a pose open, or with `limits_ahead`, and
    solves ranges of the same size from then on.
    """
    system, options, joints, inputs, tolerance = asked
    if options.method != CONTINUATION:
        return _solve_program()(system, options.of_program, joints, inputs, tolerance)
    ordered, places = _in_order(inputs, options.interpolate_from)
    asked = asked._replace(inputs=ordered)

    def solved(follow_limits: bool) -> tuple[Float[Array, "columns poses"], Outcome]:
        return run_on_cores(system, partial(asked.solve_shard, _solve_program(), follow_limits), ordered, asked.shards)

    key = asked.key
    found = None if limits_ahead or key in _limited else solved(follow_limits=False)
    if found is None or (np.asarray(found[1].status) != Status.CLOSED.value).any():
        _limited.add(key)
        found = solved(follow_limits=True)
    return found if places is None else jax.tree.map(lambda rows: rows[..., places], found)


def compile_together(ranges: Iterable[KnownRange]) -> None:
    """Compile the programs of several ranges at the same time, one a core, before these are solved in turn.

    JAX keeps what it has compiled for a call of the same arguments. Ranges of equal systems share a program, and a
    single one is compiled where it is called, as are those of traced joints.
    """
    new = {
        key: each
        for each in ranges
        if each.options.method == CONTINUATION
        and (key := each.key) not in _together
        and key not in _limited
        and not traced(each)
    }
    if len(new) < 2 or any((each.options.cores or available_cores()) < 2 for each in new.values()):
        return
    with ThreadPoolExecutor(available_cores(), thread_name_prefix="jaxkin") as threads:
        # lowered here, while those before are compiled: Python runs one thread at a time, and settings are local to it
        compiled = [threads.submit(each.lowered().compile) for each in new.values()]
    for program in compiled:
        program.result()
    _together.update(new)


def _solve(
    system: LoopSystem,
    options: SolverOptions,
    joints: Joints,
    inputs: Float[Array, "driven poses"],
    tolerance: ClosureTolerance,
    shard_start: Int[Array, ""] | None = None,
    shard_count: int = 1,
    follow_limits: bool = True,
) -> tuple[Float[Array, "columns shard"], Outcome]:
    """Find poses and displacements of a shard: the program of a plain sweep."""
    count_trace()
    shard = Shard(shard_count, shard_start, follow_limits)
    poses = find_poses(system, options, joints, inputs, tolerance, shard)
    return displacements(system, joints, shard.of(inputs), poses), Outcome(poses.status, poses.residual_norm)


def _in_order(inputs: np.ndarray, interpolate_from: int) -> tuple[np.ndarray, np.ndarray | None]:
    """Sort many poses of a single input, as interpolation needs them, and tell where each is to be put back."""
    if len(inputs) != 1 or inputs.shape[1] < interpolate_from or not on_cpu():
        return inputs, None
    if is_monotonic(inputs[0]):
        return inputs, None
    order = np.argsort(inputs[0], kind="stable")
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    return inputs[:, order], places


@cache
def _solve_program():
    """Make the program of a plain sweep: poses and displacements."""
    return jax.jit(_solve, static_argnames=("system", "options", "shard_count", "follow_limits"), **jit_options())
