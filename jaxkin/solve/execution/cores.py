"""Cut a long range into shards, and solve each on a processor core of its own.

A compiled program of the solver runs on one thread, since its operations take microseconds. Each shard runs its program
in a thread of its own. For a single input, each shard traces the branch from the assembled pose to the shard; for
several inputs, along all poses of the range.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from itertools import pairwise

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


def shard_count(system: LoopSystem, poses: int, options: SolverOptions) -> int:
    """Return the number of shards for a range of `poses`: one if the device is no CPU or nothing is driven."""
    if not system.driven or not on_cpu():
        return 1
    return max(1, min(options.cores or available_cores(), poses // options.min_shard_poses))


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
    length = -(-poses // count)
    # shards of equal length share one program; the last shard therefore overlaps the one before it
    starts = [min(i * length, poses - length) for i in range(count)]
    x64 = dtypes.canonicalize_dtype(float) == jnp.float64
    device = getattr(jax.config, "jax_default_device", None)

    def of_shard(start: int):
        if len(system.driven) == 1:
            return function(inputs[:, start : start + length])
        return function(inputs, np.asarray(start, np.int32))

    def run(start: int):
        with jax.enable_x64(x64), jax.default_device(device):  # these settings are local to a thread
            return jax.block_until_ready(of_shard(start))

    first = of_shard(0)  # compiled and started by the calling thread
    return _joined(system, starts[-2] + length - starts[-1], [first, *_threads(count).map(run, starts[1:])])


@partial(jax.jit, static_argnums=(0, 1))
def _joined(system: LoopSystem, overlap: int, shards: list[tuple]) -> tuple:
    """Join the shards; the angles of balls are unwrapped across their ends."""
    *others, last = shards
    shards = [*others, jax.tree.map(lambda rows: rows[..., overlap:], last)]
    free = turning(system)
    shift = jnp.zeros_like(last[0][:, :1])
    continued = shards[:1]
    for before, here in pairwise(shards):
        if np.any(free):
            leap = jnp.round((before[0][:, -1:] - here[0][:, :1]) / TURN)
            shift = shift + TURN * leap * free
            here = (here[0] + shift, *here[1:])
        continued.append(here)
    return jax.tree.map(lambda *rows: jnp.concatenate(rows, axis=-1), *continued)


@cache
def _threads(count: int) -> ThreadPoolExecutor:
    """Make the pool of threads for a number of shards, once in a process."""
    return ThreadPoolExecutor(count, thread_name_prefix="jaxkin")


def available_cores() -> int:
    """Count the processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
