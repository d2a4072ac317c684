"""Hold the poses that were found, and apply functions to many poses in groups."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State

MAX_CORRECTION = 0.1
"""Largest distance of a corrected pose from its prediction, radians or characteristic lengths, at which the pose is
trusted to be on the branch."""
LARGEST_GROUP = 256
"""Largest number of poses that are corrected together, however few equations they have."""
SMALLEST_GROUP = 32
"""Least number of poses that are corrected together, however many equations they have: operations on fewer poses take
as long."""
GROUP_ENTRIES = 16384
"""Entries of the Jacobians of a group, counted as equations squared a pose, that stay in the cache."""


class Poses(NamedTuple):
    """The poses that were found, without derivatives."""

    state: State
    status: Int[Array, " poses"]
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""


def group_size(system: LoopSystem) -> int:
    """Return the number of poses of a system that are corrected together."""
    return max(SMALLEST_GROUP, min(LARGEST_GROUP, GROUP_ENTRIES // system.equations**2))


def in_groups(function: Callable, poses, size: int):
    """Apply a function of poses to all `poses`, in groups of equal length of at most `size` poses.

    `poses` is a pytree of arrays whose last axis is the poses; the function takes and returns such pytrees.
    """
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
