"""Loops over many designs at once: inside `vmap` one predicate for the whole batch.

Where every design of a batch had a predicate of its own, JAX would copy all that a loop carries, knots included, in
each of its iterations, to undo it for those that are done. The loops of the solver leave alone what is done.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

_DESIGNS = "designs of jaxkin"
_together: ContextVar[bool] = ContextVar("_together", default=False)
"""Whether what is being traced is a batch of designs."""


def in_lockstep(function: Callable, in_axes: tuple[int | None, ...]) -> Callable:
    """The function under `vmap`, its predicates by `any_lane` those of the whole batch."""

    def one(*args):
        token = _together.set(True)
        try:
            return function(*args)
        finally:
            _together.reset(token)

    return jax.vmap(one, in_axes, axis_name=_DESIGNS)


def any_lane(mask: Bool[Array, "..."]) -> Array:
    """Whether the mask holds anywhere, in any design of a batch that runs `in_lockstep`."""
    found = jnp.any(mask)
    return lax.pmax(found.astype(jnp.int32), _DESIGNS) > 0 if _together.get() else found


@jax.custom_batching.custom_vmap
def write_row(table: Float[Array, "rows entries"], row: Float[Array, " entries"], at: Int[Array, ""]) -> Array:
    """The table with a row written over. The place is that of all designs: in a batch, too, it is written in place."""
    return lax.dynamic_update_slice(table, row[None], (at, 0))


@write_row.def_vmap
def _write_rows(size: int, batched, table: Array, row: Array, at: Array) -> tuple[Array, bool]:
    table, row = (
        array if is_batched else jnp.broadcast_to(array, (size, *array.shape))
        for array, is_batched in zip((table, row), batched, strict=False)
    )
    return lax.dynamic_update_slice(table, row[:, None], (0, at, 0)), True
