"""Many poses in pieces, one for each core.

A compiled program of the solver runs on one thread, since its operations take microseconds. Each piece of a range is
followed to from the assembled pose, in a thread and a program of its own; that of several inputs along all of them.
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
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import turning

LEAST = 2**14
"""Poses of a piece: of fewer, to follow the motion takes longer than to find them."""


def pieces(system: LoopSystem, poses: int) -> int:
    """Number of pieces of so many poses: one off the CPU."""
    device = getattr(jax.config, "jax_default_device", None) or jax.default_backend()
    if not system.driven or getattr(device, "platform", device) != "cpu":
        return 1
    return max(1, min(_cores(), poses // LEAST))


def side_by_side(
    system: LoopSystem, function: Callable, inputs: Float[np.ndarray, "driven poses"], number: int
) -> tuple:
    """What a function makes of inputs in order: displacements of poses in rows of columns, and what else there is.

    A piece of a single input is given as its own inputs, one of several as the number of its first among all.
    """
    if number == 1:
        return function(inputs)
    poses = inputs.shape[1]
    length = -(-poses // number)
    # all of one length, for which one program is compiled: the last one overlaps the one before it
    first = [min(i * length, poses - length) for i in range(number)]
    x64 = dtypes.canonicalize_dtype(float) == jnp.float64
    device = getattr(jax.config, "jax_default_device", None)

    def of(begin: int):
        if len(system.driven) == 1:
            return function(inputs[:, begin : begin + length])
        return function(inputs, np.asarray(begin, np.int32))

    def run(begin: int):
        with jax.enable_x64(x64), jax.default_device(device):  # settings that hold for the thread that made them
            return jax.block_until_ready(of(begin))

    begun = of(0)  # compiled, and begun, by the thread that asks for it
    return _joined(system, first[-2] + length - first[-1], [begun, *_threads().map(run, first[1:])])


@partial(jax.jit, static_argnums=(0, 1))
def _joined(system: LoopSystem, overlap: int, found: list[tuple]) -> tuple:
    """One array of each of those of the pieces; angles of balls go on without a leap."""
    *others, last = found
    found = [*others, jax.tree.map(lambda rows: rows[..., overlap:], last)]
    free = turning(system)
    shift = jnp.zeros_like(last[0][:, :1])
    whole = found[:1]
    for before, here in pairwise(found):
        if np.any(free):
            leap = jnp.round((before[0][:, -1:] - here[0][:, :1]) / TURN)
            shift = shift + TURN * leap * free
            here = (here[0] + shift, *here[1:])
        whole.append(here)
    return jax.tree.map(lambda *rows: jnp.concatenate(rows, axis=-1), *whole)


@cache
def _threads() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(_cores(), thread_name_prefix="jaxkin")


def _cores() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
