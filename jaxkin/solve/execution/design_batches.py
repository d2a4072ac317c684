"""Many designs in one batch: a few at a time, and those that hold up the others at the end.

A design of which a limit has to be followed takes ten times as many steps of the continuation as one that goes round.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import TypeVar

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Int

from jaxkin.solve.execution.lockstep import in_lockstep

Result = TypeVar("Result")
TOGETHER = 32
"""Designs that go through the loops at once: their knots stay in the cache."""


def all_designs(function: Callable[..., Result], done: Callable[[Result], Array]) -> Callable[..., Result]:
    """The function of arrays, and of whether it is patient, as one of arrays only that is fit for `vmap`.

    Alone it is patient. In a batch its loops end for some designs together, and few designs can hold up many: those
    that are not `done` without patience are put off, and then found together. Batches of batches are one batch.
    """

    @jax.custom_batching.custom_vmap
    def alone(*args):
        return function(*args, patient=True)

    @alone.def_vmap
    def batch(size: int, batched, *args):
        leaves, tree = jax.tree.flatten(args)

        def one(patient, *leaves):
            return function(*tree.unflatten(leaves), patient=patient)

        found = _flat(one, done, size, tuple(jax.tree.leaves(tuple(batched))))(*leaves)
        return found, jax.tree.map(lambda _: True, found)

    return alone


def _flat(one: Callable, done: Callable, size: int, is_mapped: tuple[bool, ...]) -> Callable:
    """A batch of so many designs, which may share some arrays: again a function of arrays that is fit for `vmap`."""
    run = jax.custom_batching.custom_vmap(lambda *leaves: _in_turn(one, done, size, is_mapped, leaves))

    @run.def_vmap
    def batch(batches: int, batched, *leaves):
        both = tuple(map(operator.or_, is_mapped, batched))

        def spread(array: Array, mapped: bool, again: bool) -> Array:
            if not (mapped or again):
                return array
            own = array.shape[int(mapped) + int(again) :]
            array = array if again else array[None]
            array = array if mapped else array[:, None]
            return jnp.broadcast_to(array, (batches, size, *own)).reshape(-1, *own)

        found = _flat(one, done, batches * size, both)(*map(spread, leaves, is_mapped, batched))
        found = jax.tree.map(lambda array: array.reshape(batches, size, *array.shape[1:]), found)
        return found, jax.tree.map(lambda _: True, found)

    return run


def _in_turn(
    one: Callable[..., Result], done: Callable[[Result], Array], size: int, is_mapped: tuple[bool, ...], leaves: tuple
) -> Result:
    """All designs, in groups; those that were put off after the others."""
    groups = -(-size // TOGETHER)
    length = -(-size // groups)
    together = in_lockstep(one, (None, *(0 if each else None for each in is_mapped)))
    if groups == 1:
        return together(True, *leaves)

    def chosen(which: Int[Array, " group"]) -> list[Array]:
        return [array[which] if each else array for array, each in zip(leaves, is_mapped, strict=True)]

    def padded(order: Int[Array, " size"]) -> Int[Array, " padded"]:
        return jnp.pad(order, (0, groups * length - size), mode="edge")

    def running(carry) -> Array:
        number, _, _, left = carry
        return number * length < groups * length + left

    def step(carry):
        number, order, found, left = carry
        patient = number >= groups
        which = lax.dynamic_slice_in_dim(order, (number - jnp.where(patient, groups, 0)) * length, length)
        here = together(patient, *chosen(which))
        found = jax.tree.map(lambda whole, part: whole.at[which].set(part), found, here)

        def put_off() -> tuple[Array, Array]:
            finished = jax.vmap(done)(found)
            return padded(jnp.argsort(finished)), jnp.sum(~finished)

        order, left = lax.cond(number == groups - 1, put_off, lambda: (order, left))
        return number + 1, order, found, left

    shapes = jax.eval_shape(together, True, *chosen(jnp.arange(length)))
    nothing = jax.tree.map(lambda part: jnp.zeros((size, *part.shape[1:]), part.dtype), shapes)
    return lax.while_loop(running, step, (jnp.asarray(0), padded(jnp.arange(size)), nothing, jnp.asarray(0)))[2]
