"""Steps and iterations of the solver, counted from outside: it returns none, and must not pay for them.

While a sweep is traced, the loops of the solver are made to tell how often they ran; the programs so compiled, with few
optimisations, are forgotten afterwards. They do what the others do, but for rounding.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from jaxkin.solve import compiled, correct, knots, sweep

FEW = {"xla_backend_optimization_level": 0, "xla_llvm_disable_expensive_passes": True}


class Count:
    """What one sweep took."""

    def __init__(self) -> None:
        self.steps = 0
        """Of the continuation, both ways from the assembled pose together with those refused."""
        self.iterations: list[np.ndarray] = []
        """Of the damped corrector from the interpolated pose on, for each pose that it was given."""

    def __str__(self) -> str:
        if not self.iterations:
            return f"{self.steps} + 0"
        each = np.concatenate(self.iterations)
        return f"{self.steps} + {np.median(each):.0f} to {each.max()}"


@contextmanager
def counted() -> Iterator[Count]:
    """Counts the sweeps inside, which are traced and compiled for it."""
    count = Count()

    def corrected(condition, body, begin):
        def step(carry):
            iterate, made = carry
            return body(iterate), made + ~iterate.done

        made = jnp.full(begin.done.shape, -1, jnp.int32)  # the first only evaluates the beginning
        last, made = lax.while_loop(lambda carry: condition(carry[0]), step, (begin, made))
        if settling:
            jax.debug.callback(lambda made: count.iterations.append(np.asarray(made)), made)
        return last

    def followed(condition, body, begin):
        def step(carry):
            return body(carry[0]), carry[1] + 1

        last, made = lax.while_loop(lambda carry: condition(carry[0]), step, (begin, jnp.asarray(0)))
        jax.debug.callback(_add, made)
        return last

    def _add(made) -> None:
        count.steps += int(made)

    settling: list[bool] = []

    def settle(*args, **kwargs):
        settling.append(True)
        try:
            return original(*args, **kwargs)
        finally:
            settling.pop()

    original = sweep.correct
    patches: list[tuple[Any, str, Any]] = [
        (correct, "lax", _with(corrected)),
        (knots, "lax", _with(followed)),
        (sweep, "correct", settle),
        (compiled, "OPTIONS", compiled.OPTIONS | FEW),
    ]
    before = [(module, name, getattr(module, name)) for module, name, _ in patches]
    _forget()
    try:
        for module, name, value in patches:
            setattr(module, name, value)
        yield count
        jax.effects_barrier()
    finally:
        for module, name, value in before:
            setattr(module, name, value)
        _forget()


def _forget() -> None:
    """All that was compiled, and with which options."""
    jax.clear_caches()
    compiled.jit_options.cache_clear()
    compiled._program.cache_clear()


def _with(while_loop) -> SimpleNamespace:
    return SimpleNamespace(**vars(lax) | {"while_loop": while_loop})
