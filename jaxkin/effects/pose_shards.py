"""Cut the poses of a motion into shards, each on a processor core of its own."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import numpy as np
from jax import lax

from jaxkin._traced import inside_trace, traced
from jaxkin.mechanism.known_motion import KnownMotion
from jaxkin.solve.device import on_cpu
from jaxkin.solve.execution.cores import available_cores, in_threads, shard_starts

OfShard = Callable[[KnownMotion, Any], Any]
"""A function of a motion and of what is given for each of its poses: pytrees of arrays whose first axis is the poses,
as what it returns."""


def in_shards(function: OfShard, known: KnownMotion, rows: Any, least_entries: int) -> Any:
    """Apply a function, which calls programs, to shards of the poses of a motion, and join what it returns.

    `least_entries` is the least number of poses of a shard, times the square of the number of joints. Poses are one
    shard where they are fewer, where numbers are traced, and on a device that is no CPU.
    """
    poses, joints = len(known.status), len(known.displacements)
    count = min(available_cores(), poses * joints**2 // least_entries)
    if count < 2 or not on_cpu() or traced((known, rows)) or inside_trace():
        return function(known, rows)
    host = jax.tree.map(np.asarray, (known.displacements, known.status, rows))
    length, starts = shard_starts(poses, count)

    def of_shard(start: int) -> Any:
        displacements, status, own = jax.tree.map(lambda array: array[start : start + length], host)
        return function(known._replace(displacements=displacements, status=status), own)

    return _joined(starts[-2] + length - starts[-1], in_threads(of_shard, starts, count))


@partial(jax.jit, static_argnums=0)
def _joined(overlap: int, shards: list[Any]) -> Any:
    """Join shards along the poses; the last one begins with `overlap` poses of the one before it."""
    *others, last = shards
    shards = [*others, jax.tree.map(lambda rows: rows[overlap:], last)]
    return jax.tree.map(lambda *rows: lax.concatenate(rows, 0), *shards)
