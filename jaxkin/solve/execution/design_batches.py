"""Solve many designs in one batch: in groups that run in lockstep, with the designs that have limits at the end.

A design whose range has a limit takes ten times as many steps of the continuation as a design without one. In lockstep,
the other designs of its group would wait for it.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import NamedTuple, TypeVar

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Int

from jaxkin.solve.device import group_for_device
from jaxkin.solve.lockstep import in_lockstep, runs_in_lockstep

Result = TypeVar("Result")
DESIGN_GROUP = 32
"""Largest number of designs that run in lockstep on a CPU: so many samples of branches stay in the cache."""
DEVICE_DESIGNS = 2**12
"""The same on other devices, which compute poses of all of them side by side."""


class _Batch(NamedTuple):
    """A batch of designs as a function of arrays, some of which all designs share."""

    function: Callable
    """The function of `follow_limits` and of the arrays of one design."""
    done: Callable[..., Array]
    """The function that tells whether a result found without following limits is final."""
    size: int
    """Number of designs."""
    is_mapped: tuple[bool, ...]
    """For each array whether its first axis is the designs; other arrays are shared by all designs."""


def all_designs(function: Callable[..., Result], done: Callable[[Result], Array]) -> Callable[..., Result]:
    """Turn a function of arrays and `follow_limits=` into a function of arrays that `vmap` runs in groups of designs.

    Outside `vmap`, limits are followed. In a batch, every design is first solved without following limits; the designs
    whose result is not `done` are then solved again, with limits. Nested batches run as one batch.
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
    """Return the batch as a function of its arrays, which may be batched again by `vmap`."""
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


def _in_groups(batch: _Batch, leaves: tuple[Array, ...]):
    """Solve all designs in groups of equal length, and then again, with limits, the designs that are not done."""
    groups = -(-batch.size // group_for_device(DESIGN_GROUP, DEVICE_DESIGNS))
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


def by_formulas_in_groups(function: Callable[..., Result]) -> Callable[..., Result]:
    """Turn a function of arrays into one that `vmap` runs in groups of designs, one after another.

    Formulas take as long for every design. But all designs at once would write each of some hundred intermediate
    results to memory and read it again; those of a group stay in the cache. Nothing may be differentiated. What runs in
    lockstep is a group already.
    """
    if runs_in_lockstep():
        return function

    @jax.custom_batching.custom_vmap
    def alone(*args):
        return function(*args)

    @alone.def_vmap
    def batch(size: int, batched, *args):
        leaves, tree = jax.tree.flatten(args)
        mapped = jax.tree.leaves(tuple(batched))
        together = group_for_device(DESIGN_GROUP, DEVICE_DESIGNS)
        least = -(-size // together)
        groups = next((count for count in range(least, 2 * size // together + 1) if size % count == 0), least)
        length = -(-size // groups)

        def grouped(array: Array) -> Array:
            padded = jnp.pad(array, [(0, groups * length - size), *[(0, 0)] * (array.ndim - 1)], mode="edge")
            return padded.reshape(groups, length, *array.shape[1:])

        every = [grouped(leaf) for leaf, each in zip(leaves, mapped, strict=True) if each]

        def one(*leaves):
            return function(*tree.unflatten(leaves))

        in_group = in_lockstep(one, tuple(0 if each else None for each in mapped))

        def of_group(rows: list[Array]):
            own = iter(rows)
            return in_group(*[next(own) if each else leaf for leaf, each in zip(leaves, mapped, strict=True)])

        found = lax.map(of_group, every)
        found = jax.tree.map(lambda rows: rows.reshape(groups * length, *rows.shape[2:])[:size], found)
        return found, jax.tree.map(lambda _: True, found)

    return alone
