"""Many designs in one batch: a group at a time, and designs that need more work than the others at the end.

A design with a limit that has to be followed takes ten times as many steps of the continuation as one without, and in
lockstep the others would wait for it.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import NamedTuple, TypeVar

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Int

from jaxkin.solve.lockstep import in_lockstep

Result = TypeVar("Result")
DESIGN_GROUP = 32
"""Designs that go through the loops in lockstep, at most: their samples of the branch stay in the cache."""


class _Batch(NamedTuple):
    """A batch of designs as a function of arrays, some of which all designs share."""

    function: Callable
    """Of `follow_limits`, and of the arrays of one design."""
    done: Callable[..., Array]
    """Whether a result is final that was found without following limits."""
    size: int
    is_mapped: tuple[bool, ...]
    """Which arrays have a leading axis of designs."""


def all_designs(function: Callable[..., Result], done: Callable[[Result], Array]) -> Callable[..., Result]:
    """Make a function of arrays and of `follow_limits=` one of arrays only, which `vmap` runs in groups of designs.

    Outside `vmap` limits are followed. In a batch every design is first solved without following limits; designs of
    which the result is not `done` are then solved again, together. Nested batches are run as one.
    """

    @jax.custom_batching.custom_vmap
    def alone(*args):
        return function(*args, follow_limits=True)

    @alone.def_vmap
    def batch(size: int, batched, *args):
        leaves, tree = jax.tree.flatten(args)

        def one(follow_limits, *leaves):
            return function(*tree.unflatten(leaves), follow_limits=follow_limits)

        found = _mapped(_Batch(one, done, size, tuple(jax.tree.leaves(tuple(batched)))))(*leaves)
        return found, jax.tree.map(lambda _: True, found)

    return alone


def _mapped(batch: _Batch) -> Callable:
    """The batch as a function of its arrays that may be batched again."""
    run = jax.custom_batching.custom_vmap(lambda *leaves: _in_groups(batch, leaves))

    @run.def_vmap
    def nested(batches: int, batched, *leaves):
        both = tuple(map(operator.or_, batch.is_mapped, batched))

        def flattened(array: Array, mapped: bool, again: bool) -> Array:
            if not (mapped or again):
                return array
            own = array.shape[int(mapped) + int(again) :]
            array = array if again else array[None]
            array = array if mapped else array[:, None]
            return jnp.broadcast_to(array, (batches, batch.size, *own)).reshape(-1, *own)

        flat = batch._replace(size=batches * batch.size, is_mapped=both)
        found = _mapped(flat)(*map(flattened, leaves, batch.is_mapped, batched))
        found = jax.tree.map(lambda array: array.reshape(batches, batch.size, *array.shape[1:]), found)
        return found, jax.tree.map(lambda _: True, found)

    return run


def _one_design(batch: _Batch, leaves: tuple[Array, ...]):
    """Solve a batch of one design as that design alone.

    Not only because it is cheaper: the algebraic simplifier of XLA (jaxlib 0.10.2, on a CPU) makes a program of a
    batch of one, with two loop groups or more, whose poses are wrong.
    """
    alone = (array[0] if each else array for array, each in zip(leaves, batch.is_mapped, strict=True))
    return jax.tree.map(lambda array: array[None], batch.function(True, *alone))


def _in_groups(batch: _Batch, leaves: tuple[Array, ...]):
    """Solve all designs in groups of equal length; then again, with limits, those that are not done."""
    if batch.size == 1:
        return _one_design(batch, leaves)
    groups = -(-batch.size // DESIGN_GROUP)
    length = -(-batch.size // groups)
    group_of = in_lockstep(batch.function, (None, *(0 if each else None for each in batch.is_mapped)))
    if groups == 1:
        return group_of(True, *leaves)

    def chosen(which: Int[Array, " group"]) -> list[Array]:
        return [array[which] if each else array for array, each in zip(leaves, batch.is_mapped, strict=True)]

    def padded(order: Int[Array, " size"]) -> Int[Array, " padded"]:
        return jnp.pad(order, (0, groups * length - batch.size), mode="edge")

    def running(carry) -> Array:
        number, _, _, undone = carry
        return number * length < groups * length + undone

    def step(carry):
        number, order, found, undone = carry
        follow_limits = number >= groups
        which = lax.dynamic_slice_in_dim(order, (number - jnp.where(follow_limits, groups, 0)) * length, length)
        here = group_of(follow_limits, *chosen(which))
        found = jax.tree.map(lambda whole, part: whole.at[which].set(part), found, here)

        def undone_first() -> tuple[Array, Array]:
            finished = jax.vmap(batch.done)(found)
            return padded(jnp.argsort(finished)), jnp.sum(~finished)

        order, undone = lax.cond(number == groups - 1, undone_first, lambda: (order, undone))
        return number + 1, order, found, undone

    shapes = jax.eval_shape(group_of, True, *chosen(jnp.arange(length)))
    nothing = jax.tree.map(lambda part: jnp.zeros((batch.size, *part.shape[1:]), part.dtype), shapes)
    begin = jnp.asarray(0), padded(jnp.arange(batch.size)), nothing, jnp.asarray(0)
    return lax.while_loop(running, step, begin)[2]
