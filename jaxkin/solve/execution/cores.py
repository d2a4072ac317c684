"""Cut a range into shards, and solve each on a processor core of its own.

A compiled program of the solver runs on one thread, since its operations take microseconds. Each shard runs its program
in a thread of its own. For a single input, each shard traces the branch from the assembled pose to the shard; for
several inputs, along all poses of the range.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jaxtyping import Float

from jaxkin.geometry.trig import TURN
from jaxkin.solve.device import on_cpu
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import turning

MIN_SHARD_POSES = 2**14
"""Least number of poses of a shard: long ranges are interpolated, at some 0.1 to 0.6 us a pose."""
MIN_COSTLY_SHARD_POSES = 128
"""Least number of poses of a shard of a costly system, whose poses take 5 us and more each, before they are
interpolated: 128 of them take longer than the threads and the joining of their results, some 0.2 ms."""
COSTLY_JOINTS = 20
"""Number of joints in the loops of a system, counted once a loop, from which on it is costly: the paper's Fig. 7 has 21
and a platform on six legs 30, at 8.5 and 5.6 us a pose; systems of up to 16 take at most 1.6 us."""


def shard_count(system: LoopSystem, inputs: Float[np.ndarray, "driven poses"], options: SolverOptions) -> int:
    """Return the number of shards for a range: one if the device is no CPU or nothing is driven.

    A short range whose single input does not rise or fall throughout is left whole: the angles of its balls are counted
    on from pose to pose in the order given.
    """
    if not system.driven or not on_cpu():
        return 1
    least, poses = options.min_shard_poses, inputs.shape[1]
    if least is None:
        several = len(inputs) > 1  # whose poses are costly however many they are: none is interpolated
        short = several or (poses < options.interpolate_from and is_monotonic(inputs[0]))
        costly = short and sum(map(len, system.loops)) >= COSTLY_JOINTS
        least = MIN_COSTLY_SHARD_POSES if costly else MIN_SHARD_POSES
    return max(1, min(options.cores or available_cores(), poses // least))


def is_monotonic(values: Float[np.ndarray, " poses"]) -> bool:
    """Tell whether values rise or fall throughout."""
    before, after = values[:-1], values[1:]
    return bool(np.all(after >= before) or np.all(after <= before))


def first_shard(system: LoopSystem, inputs: Float[np.ndarray, "driven poses"], count: int) -> tuple:
    """Return the arguments of the first of `count` shards, with which `run_on_cores` calls its function first."""
    return _shard(system, inputs, -(-inputs.shape[1] // count), 0) if count > 1 else (inputs,)


def _shard(system: LoopSystem, inputs: Float[np.ndarray, "driven poses"], length: int, start: int) -> tuple:
    """Return the arguments of a shard: its inputs if there is a single input, else all inputs and its first pose."""
    if len(system.driven) == 1:
        return (inputs[:, start : start + length],)
    return inputs, np.asarray(start, np.int32)


def run_on_cores(
    system: LoopSystem, function: Callable, inputs: Float[np.ndarray, "driven poses"], count: int
) -> tuple:
    """Apply `function` to `count` shards of the inputs in parallel, and join its results along the poses.

    `function` returns a tuple of arrays whose last axis is the poses; the first array holds the displacements (columns,
    poses). It is called with the inputs of a shard if there is a single input, else with all inputs and the number of
    the first pose of the shard.
    """
    if count == 1:
        return function(inputs)
    poses = inputs.shape[1]
    length, starts = shard_starts(poses, count)
    shards = in_threads(lambda start: function(*_shard(system, inputs, length, start)), starts, count)
    return _joined(system, starts[-2] + length - starts[-1], shards)


def shard_starts(poses: int, count: int) -> tuple[int, list[int]]:
    """Cut a range into shards: their length, which is that of all, and the first pose of each.

    Shards of equal length share one program; the last one therefore overlaps the one before it.
    """
    length = -(-poses // count)
    return length, [min(shard * length, poses - length) for shard in range(count)]


def in_threads(function: Callable[[Any], Any], each: Sequence[Any], threads: int) -> list[Any]:
    """Apply a function to each of some arguments, as many at the same time as there are `threads`.

    To the first of them it is applied in the calling thread, which compiles what all of them share.
    """
    x64 = dtypes.canonicalize_dtype(float) == jnp.float64
    device = getattr(jax.config, "jax_default_device", None)

    def run(one: Any) -> Any:
        with jax.enable_x64(x64), jax.default_device(device):  # these settings are local to a thread
            return jax.block_until_ready(function(one))

    first = function(each[0])
    return [first, *_threads(threads).map(run, each[1:])]


@partial(jax.jit, static_argnums=(0, 1))
def _joined(system: LoopSystem, overlap: int, shards: list[tuple]) -> tuple:
    """Join the shards; the angles of balls go on across their ends."""
    *others, last = shards
    shards = [*others, jax.tree.map(lambda rows: rows[..., overlap:], last)]
    rows, *rest = zip(*shards, strict=True)
    joined = (continue_ball_angles(system, rows), *rest)
    return tuple(jax.tree.map(lambda *each: jnp.concatenate(each, axis=-1), *pieces) for pieces in joined)


def continue_ball_angles(system: LoopSystem, pieces: Sequence[Any], xp: Any = jnp) -> list[Any]:
    """Add to the angles of balls in each piece of a range the full turns by which they go on from the piece before.

    The pieces are displacements (columns, poses), arrays of `xp`, jax.numpy or numpy.
    """
    free = turning(system)
    continued = list(pieces[:1])
    for here in pieces[1:]:
        if np.any(free):
            here = here + TURN * free * xp.round((continued[-1][:, -1:] - here[:, :1]) / TURN)
        continued.append(here)
    return continued


@cache
def _threads(count: int) -> ThreadPoolExecutor:
    """Make the pool of threads for a number of shards, once in a process."""
    return ThreadPoolExecutor(count, thread_name_prefix="jaxkin")


def available_cores() -> int:
    """Count the processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
