"""Functions of users, told apart by what they compute, so that a search runs the program of an earlier one.

Two functions that were written in one place may differ in what they refer to, and one function may refer to something
that has changed since. So each is traced in every search, by itself, which takes a small part of the time to trace the
program that it becomes part of; functions whose operations and constants are the same are one function.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import jax
import jax.numpy as jnp

from jaxkin._traced import written_with_jax


@jax.tree_util.register_static
@dataclass(frozen=True)
class OwnFunction:
    """A function, equal to every other one that computes the same, with the same derivatives."""

    function: Callable[..., Any] = field(compare=False)
    name: str
    """For messages."""
    operations: Any
    """The text of its program."""

    def __call__(self, *given: Any) -> Any:
        return self.function(*given)


def own_function(function: Callable[..., Any], name: str, shapes: tuple[Any, ...], forward: bool) -> OwnFunction:
    """Trace a function of pytrees of floats and whole numbers, of which `shapes` has the shapes.

    Its derivatives are compared as they are asked for: `forward`, or backward of a function of one output. Raises
    ValueError for a function that asks for numbers which JAX traces.
    """
    leaves, tree = jax.tree.flatten(shapes)
    smooth = [jnp.issubdtype(leaf.dtype, jnp.inexact) for leaf in leaves]

    def of(numbers: list[Any], rest: list[Any]) -> Any:
        left = iter(numbers), iter(rest)
        found = function(*tree.unflatten([next(left[0] if each else left[1]) for each in smooth]))
        return jax.tree.map(lambda each: jnp.asarray(each, float), found)

    def with_derivative(numbers: list[Any], rest: list[Any]) -> Any:
        if forward:
            along = [jnp.ones_like(number) for number in numbers]
            return jax.jvp(lambda numbers: of(numbers, rest), (numbers,), (along,))
        value, back = jax.vjp(lambda numbers: of(numbers, rest), numbers)
        return value, back(jax.tree.map(jnp.ones_like, value))

    numbers, rest = (
        [leaf for leaf, is_smooth in zip(leaves, smooth, strict=True) if is_smooth is side] for side in (True, False)
    )
    with written_with_jax(name):
        text = jax.jit(with_derivative).lower(numbers, rest).as_text()
    # the text does not tell which function of Python is called
    return OwnFunction(function, name, object() if "callback" in text else text)
