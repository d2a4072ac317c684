"""Telling numbers that are there from numbers that JAX will only know later."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, wraps
from typing import Any

import jax
import numpy as np
from jax.core import Tracer


def traced(*trees: object) -> bool:
    """Tell whether JAX traces any of the arrays (inside `jit`, `vmap` or `grad`): their numbers cannot be looked at."""
    return any(issubclass(kind, Tracer) for kind in {*map(type, jax.tree.leaves(trees))})


def inside_trace() -> bool:
    """Tell whether JAX traces the function that calls, though all it is given may be numbers: what is computed there
    from an array is traced."""
    return isinstance(_unchanged(_known_array()), Tracer)


def tell_known_numbers(result: type) -> None:
    """Let results of a class say that JAX traces their numbers where these are looked at.

    Printed, such a result is named; what else it tells or writes raises ValueError.
    """

    def guarded(name: str, method: Any) -> Any:
        @wraps(method)
        def told(self: Any, *args: Any, **kwargs: Any) -> Any:
            # the values of dictionaries: their keys may be names and pairs, which JAX cannot sort
            held = [[*each.values()] if isinstance(each, dict) else each for each in vars(self).values()]
            if not traced(held, args, [*kwargs.values()]):
                return method(self, *args, **kwargs)
            if name == "__str__":
                return f"{result.__name__}: traced by JAX, its numbers are known outside of jit, vmap and grad"
            where = "outside of jit, vmap and grad"
            raise ValueError(f"{name} of {result.__name__} is given numbers that JAX traces: call it {where}")

        return told

    for name in ("__str__", "plot", "save", "allowed"):
        if name in vars(result):
            setattr(result, name, guarded(name, vars(result)[name]))


@contextmanager
def written_with_jax(what: str) -> Iterator[None]:
    """Call a function of the user, which messages call `what`; ValueError where it asks for numbers that JAX traces, as
    numpy does."""
    try:
        yield
    except (jax.errors.TracerArrayConversionError, jax.errors.ConcretizationTypeError) as error:
        raise ValueError(
            f"{what} is differentiated by JAX: write it with jax.numpy in place of numpy, math, float(...) and "
            "conditions on values"
        ) from error


_unchanged = jax.jit(lambda array: array)
"""A compiled program, which JAX calls in less than half the time of any other operation."""


@cache
def _known_array() -> jax.Array:
    """Make an array that is never traced, and keep it: that takes six times as long as to ask what becomes of it."""
    with jax.ensure_compile_time_eval():
        return jax.device_put(np.zeros(0))
