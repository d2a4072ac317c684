"""Run loops over many designs in lockstep: inside `vmap`, one predicate decides for the whole batch.

With one predicate a design, JAX would copy the whole carry of a loop in each iteration, samples of the branch included,
to undo the iteration for designs that are done. The loops of the solver do not need that: they themselves leave poses
that are done unchanged.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar
from typing import Any, TypeVar

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

Result = TypeVar("Result")
_DESIGNS = "designs of jaxkin"
"""Name of the mapped axis of the designs in a batch, for collective operations."""
_in_lockstep: ContextVar[bool] = ContextVar("_in_lockstep", default=False)
"""Whether JAX is tracing a batch of designs in lockstep."""


def in_lockstep(function: Callable, in_axes: tuple[int | None, ...]) -> Callable:
    """Map a function over designs as `vmap` does; inside it, `any_in_lockstep` is over the whole batch."""

    def one(*args):
        token = _in_lockstep.set(True)
        try:
            return function(*args)
        finally:
            _in_lockstep.reset(token)

    return jax.vmap(one, in_axes, axis_name=_DESIGNS)


def runs_in_lockstep() -> bool:
    """Tell whether JAX is tracing a batch of designs that runs `in_lockstep`."""
    return _in_lockstep.get()


def any_in_lockstep(mask: Bool[Array, "..."]) -> Array:
    """Tell whether the mask holds anywhere, in any design of a batch that runs `in_lockstep`."""
    found = jnp.any(mask)
    return lax.pmax(found.astype(jnp.int32), _DESIGNS) > 0 if runs_in_lockstep() else found


@jax.custom_batching.custom_vmap
def write_row(table: Float[Array, "rows entries"], row: Float[Array, " entries"], at: Int[Array, ""]) -> Array:
    """Overwrite row `at` of the table; `at` is the same for all designs of a batch, whose rows are written in place."""
    return lax.dynamic_update_slice(table, row[None], (at, 0))


@write_row.def_vmap
def _write_rows(size: int, batched, table: Array, row: Array, at: Array) -> tuple[Array, bool]:
    table, row = (
        array if is_batched else jnp.broadcast_to(array, (size, *array.shape))
        for array, is_batched in zip((table, row), batched, strict=False)
    )
    return lax.dynamic_update_slice(table, row[:, None], (0, at, 0)), True


def computed_once(function: Callable[..., Result], *args: Any) -> Result:
    """Call a function of arrays, so that what it returns is computed once, and kept.

    XLA copies a chain of cheap operations into every operation that uses its result, and formulas are such chains. It
    does not look into the branches of a condition that it cannot decide: here whether the smallest array has a finite
    number. Where it has none, what is returned is NaN, zero or False. Nothing may be differentiated.
    """
    smallest = min(jax.tree.leaves(args), key=jnp.size)
    shapes = jax.eval_shape(function, *args)

    def nothing(*_: Any) -> Result:
        return jax.tree.map(
            lambda leaf: jnp.full(leaf.shape, jnp.nan if jnp.issubdtype(leaf.dtype, jnp.inexact) else 0, leaf.dtype),
            shapes,
        )

    return lax.cond(any_in_lockstep(jnp.isfinite(smallest)), function, nothing, *args)
