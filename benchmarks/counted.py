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

from jaxkin.solve.continuation import branch
from jaxkin.solve.correctors import levenberg_marquardt, newton
from jaxkin.solve.execution import compiler, known_numbers, programs
from jaxkin.solve.range import damped_poses, polish

FAST_COMPILATION = {"xla_backend_optimization_level": 0, "xla_llvm_disable_expensive_passes": True}


class Count:
    """What one sweep took."""

    def __init__(self) -> None:
        self.steps = 0
        """Of the continuation, both ways from the assembled pose together with those refused."""
        self.newton = 0
        """Newton's steps, from interpolated poses on, until all of them are closed."""
        self.damped = 0
        """Iterations of the damped corrector, the most that any pose took that was left to it."""

    def __str__(self) -> str:
        return f"{self.steps} + {self.newton} + {self.damped}"


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
        if correcting:
            jax.debug.callback(_damped, made)
        return last

    def improved(condition, body, begin):
        last = lax.while_loop(condition, body, begin)
        if correcting:
            jax.debug.callback(_newton, last.count - 1)  # the first only evaluates the beginning
        return last

    def followed(condition, body, begin):
        def step(carry):
            return body(carry[0]), carry[1] + 1

        last, made = lax.while_loop(lambda carry: condition(carry[0]), step, (begin, jnp.asarray(0)))
        jax.debug.callback(_add, made)
        return last

    def _add(made) -> None:
        count.steps += int(made)

    def _newton(made) -> None:
        count.newton = max(count.newton, int(made))

    def _damped(made) -> None:
        count.damped = max(count.damped, int(np.max(made)))

    correcting: list[bool] = []

    def told(original):
        def traced(*args, **kwargs):
            correcting.append(True)
            try:
                return original(*args, **kwargs)
            finally:
                correcting.pop()

        return traced

    patches: list[tuple[Any, str, Any]] = [
        (levenberg_marquardt, "lax", _with(corrected)),
        (newton, "lax", _with(improved)),
        (branch, "lax", _with(followed)),
        (damped_poses, "levenberg_marquardt", told(damped_poses.levenberg_marquardt)),
        (polish, "newton", told(polish.newton)),
        (compiler, "COMPILER_OPTIONS", compiler.COMPILER_OPTIONS | FAST_COMPILATION),
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
    compiler.jit_options.cache_clear()
    known_numbers._solve_program.cache_clear()
    programs._poses_program.cache_clear()


def _with(while_loop) -> SimpleNamespace:
    return SimpleNamespace(**vars(lax) | {"while_loop": while_loop})
