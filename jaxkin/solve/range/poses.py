"""Poses as they are found, and the groups in which they are corrected."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State

CLOSED_ROUNDINGS = 64
"""Units of rounding in the residual of a pose that one correction has closed: above that it is left to a method that
costs more."""
MAX_CORRECTION = 0.1
"""Distance of a corrected pose from its prediction, radians or characteristic lengths, above which it is not trusted to
be on the branch."""
LARGEST_GROUP = 256
"""Poses that are corrected together, at most, however few equations they have."""
SMALLEST_GROUP = 32
"""Poses that are corrected together, at least, however many equations they have: an operation on fewer poses takes
as long."""
GROUP_ENTRIES = 16384
"""Entries of the Jacobians of a group, counted as equations squared a pose: so many stay in the cache."""


class Poses(NamedTuple):
    """Poses as they were found: numbers without derivatives."""

    state: State
    status: Int[Array, " poses"]
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""


def group_size(system: LoopSystem) -> int:
    """The number of poses that are corrected together."""
    return max(SMALLEST_GROUP, min(LARGEST_GROUP, GROUP_ENTRIES // system.equations**2))


def in_groups(function: Callable, poses, size: int):
    """Apply a function of some poses to all of them, in groups of equal length, `size` at most.

    `poses` is a pytree of arrays with the poses as their last axis, and so is what the function returns.
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
