"""The solver as a compiled program of its own, with the compiler option that suits it."""

from __future__ import annotations

from functools import cache, partial

import jax

from jaxkin.geometry.traced import traced
from jaxkin.solve.sweep import Solution, solve_system
from jaxkin.solve.system import LoopSystem

OPTIONS = {"xla_cpu_use_fusion_emitters": False}
"""With its newer emitters XLA takes 1.7 times as long to compile the solver for the CPU, for a program no faster."""


def solve(system: LoopSystem, before, after, pitch, inputs) -> Solution:
    """`solve_system`, compiled once for a system and a number of poses.

    Inside a program that is being traced it becomes part of that: options are for whole programs only.
    """
    arrays = (before, after, pitch, inputs)
    return (part if traced(arrays) else whole())(system, *arrays)


part = partial(jax.jit, static_argnums=0)(solve_system)


@cache
def whole():
    """The compiled solver, with the option where this version of JAX knows it."""
    try:
        jax.jit(lambda x: x, compiler_options=OPTIONS)(0.0)
    except (TypeError, jax.errors.JaxRuntimeError):
        return part
    return jax.jit(solve_system, static_argnums=0, compiler_options=OPTIONS)
