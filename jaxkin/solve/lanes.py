"""Loops over many designs at once: inside `vmap` one predicate for the whole batch.

Where every design of a batch had a predicate of its own, JAX would copy all that a loop carries, knots included, in
each of its iterations, to undo it for those that are done. The loops of the solver leave alone what is done.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar
from typing import TypeVar

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

Result = TypeVar("Result")
_DESIGNS = "designs of jaxkin"
_together: ContextVar[bool] = ContextVar("_together", default=False)
"""Whether what is being traced is a batch of designs."""
TOGETHER = 32
"""Designs that go through the loops at once: their knots stay in the cache, and hard ones hold up few others."""


def any_lane(mask: Bool[Array, "..."]) -> Array:
    """Whether the mask holds anywhere, in any design of a batch that `all_designs` runs."""
    found = jnp.any(mask)
    return lax.pmax(found.astype(jnp.int32), _DESIGNS) > 0 if _together.get() else found


@jax.custom_batching.custom_vmap
def write_row(table: Float[Array, "rows entries"], row: Float[Array, " entries"], at: Int[Array, ""]) -> Array:
    """The table with a row written over. The place is that of all designs: in a batch, too, it is written in place."""
    return lax.dynamic_update_slice(table, row[None], (at, 0))


@write_row.def_vmap
def _write_rows(size: int, batched, table: Array, row: Array, at: Array) -> tuple[Array, bool]:
    if batched[2]:
        return jax.vmap(lambda table, row, at: table.at[at].set(row), [0 if each else None for each in batched])(
            table, row, at
        ), True
    table, row = (
        array if is_batched else jnp.broadcast_to(array, (size, *array.shape))
        for array, is_batched in zip((table, row), batched, strict=False)
    )
    return lax.dynamic_update_slice(table, row[:, None], (0, at, 0)), True


def all_designs(function: Callable[..., Result]) -> Callable[..., Result]:
    """The function, of arrays only, which inside `vmap` has its loops end for all designs together."""
    alone = jax.custom_batching.custom_vmap(function)

    @alone.def_vmap
    def batch(size: int, batched, *args):
        leaves, tree = jax.tree.flatten(args)
        is_mapped = jax.tree.leaves(tuple(batched))
        groups = max(1, -(-size // TOGETHER))
        length = -(-size // groups)

        def one(own: list[Array]):
            mapped = iter(own)
            token = _together.set(True)
            try:
                return function(
                    *tree.unflatten([next(mapped) if each else leaves[i] for i, each in enumerate(is_mapped)])
                )
            finally:
                _together.reset(token)

        def cut(array: Array) -> Array:
            padded = jnp.pad(array, [(0, groups * length - size)] + [(0, 0)] * (array.ndim - 1), mode="edge")
            return padded.reshape(groups, length, *array.shape[1:])

        mapped = [cut(array) for array, each in zip(leaves, is_mapped, strict=True) if each]
        found = lax.map(jax.vmap(one, axis_name=_DESIGNS), mapped)
        found = jax.tree.map(lambda array: array.reshape(groups * length, *array.shape[2:])[:size], found)
        return found, jax.tree.map(lambda _: True, found)

    return alone
