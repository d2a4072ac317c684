"""Apply functions to many poses in groups, whose intermediate results stay in the cache."""

from __future__ import annotations

from collections.abc import Callable

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array

from jaxkin.solve.device import group_for_device
from jaxkin.solve.system.loop_system import LoopSystem

LARGEST_GROUP = 256
"""Largest number of poses that are corrected together, however few equations they have."""
SMALLEST_GROUP = 32
"""Least number of poses that are corrected together, however many equations they have: operations on fewer poses take
as long."""
GROUP_ENTRIES = 16384
"""Entries of the Jacobians of a group, counted as equations squared a pose, that stay in the cache."""


def group_size(system: LoopSystem) -> int:
    """Return the number of poses of a system that are corrected together."""
    return max(SMALLEST_GROUP, min(LARGEST_GROUP, GROUP_ENTRIES // system.equations**2))


def in_groups(function: Callable, poses, size: int, axis: int = -1):
    """Apply a function of poses to all `poses`, in groups of equal length of at most `size` poses on a CPU.

    Other devices take all at once, `DEVICE_GROUP` poses at most.

    `poses` is a pytree of arrays whose axis `axis`, the last or the first (0), is the poses; the function takes and
    returns such pytrees. With the poses first, groups are cut and joined without a copy of the arrays.
    """
    count = jax.tree.leaves(poses)[0].shape[axis]
    groups = -(-count // group_for_device(size))
    if groups <= 1:
        return function(poses)
    length = -(-count // groups)

    def cut(array: Array) -> Array:
        at = axis % array.ndim
        missing = [(0, groups * length - count if own == at else 0) for own in range(array.ndim)]
        padded = jnp.pad(array, missing, mode="edge")
        return jnp.moveaxis(padded.reshape(*array.shape[:at], groups, length, *array.shape[at + 1 :]), at, 0)

    def join(array: Array) -> Array:
        at = axis % (array.ndim - 1)
        each = jnp.moveaxis(array, 0, at)
        joined = each.reshape(*each.shape[:at], groups * length, *each.shape[at + 2 :])
        return lax.slice_in_dim(joined, 0, count, axis=at)

    return jax.tree.map(join, lax.map(function, jax.tree.map(cut, poses)))
