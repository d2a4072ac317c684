"""The options of the compiler that whole programs of the solver and of effects are compiled with."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, wraps
from typing import Any

import jax

from jaxkin._traced import inside_trace, traced

COMPILER_OPTIONS = {
    "xla_cpu_use_fusion_emitters": False,
    "xla_cpu_experimental_ynn_fusion_type": "",
    "xla_cpu_multi_thread_eigen": False,
    "xla_cpu_parallel_codegen_split_count": 4,
    "xla_llvm_disable_expensive_passes": True,
    "xla_disable_hlo_passes": "cpu-parallel-task-assigner,tree_reduction_rewriter",
}
"""Options of XLA for the CPU. With its newer emitters XLA takes 1.7 times as long to compile the solver, with the
costlier passes of LLVM 1.4 times, for a program that is no faster. Four modules of code, which two cores compile at the
same time, take 0.6 to 0.8 of the seconds of one module; 32 modules gain no more.

The operations of the program take a few microseconds each. To call a library for reductions, to rewrite sums of about
forty numbers as trees, or to split an operation among threads takes longer than the operation; and threads that wait
for work occupy the core that another shard needs. Several cores work on shards of their own instead (`run_on_cores`).
"""

FEW_OPTIMISATIONS = {"xla_backend_optimization_level": 0}
"""Options of XLA with which LLVM translates, and does not optimise."""
FEW_POSES = 512
"""Most poses for which effects are compiled with few optimisations, as they are computed in milliseconds either way:
reactions in 361 poses of a four-bar take 2.1 s of the processor to compile in place of 5.8, and 4.8 ms in place of 2.5
a call, so that 1,600 calls cost as much; the limit of a four-bar takes 0.6 s in place of 1.5."""

_traces = 0
"""Number of programs that find poses and were traced in this process."""


def whole_program(function: Callable, static: tuple[int, ...]) -> Callable:
    """Compile a function of arrays with the options of the solver, which are those of whole programs; for up to
    `FEW_POSES` poses with `FEW_OPTIMISATIONS`.

    `static` are the places of its arguments that are hashed, and not arrays. Where numbers are traced, the function is
    part of another program, and compiled as that is.
    """
    part = jax.jit(function, static_argnums=static)
    whole = cache(lambda quick: jax.jit(function, static_argnums=static, **jit_options(quick)))

    @wraps(function)
    def call(*given):
        leaves = jax.tree.leaves(given)
        if traced(leaves) or inside_trace():
            return part(*given)
        longest = max((length for leaf in leaves for length in getattr(leaf, "shape", ())), default=1)
        return whole(longest <= FEW_POSES)(*given)

    return call


@cache
def jit_options(quick: bool = False) -> dict[str, Any]:
    """Return the compiler options, `quick` ones with few optimisations, as an argument of `jax.jit`; empty where this
    version of JAX knows none of them."""
    known = known_options(COMPILER_OPTIONS | (FEW_OPTIMISATIONS if quick else {}))
    return {"compiler_options": known} if known else {}


def known_options(options: dict[str, Any]) -> dict[str, Any]:
    """Leave out the compiler options that this version of JAX does not know."""
    if _are_known(*options.items()):
        return options
    return {name: value for name, value in options.items() if _are_known((name, value))}


@cache
def _are_known(*options: tuple[str, Any]) -> bool:
    """Tell whether JAX takes compiler options, given by name and value."""
    try:
        jax.jit(lambda x: x, compiler_options=dict(options))(0.0)
    except (TypeError, jax.errors.JaxRuntimeError):
        return False
    return True


def compilations() -> int:
    """Count the programs that find poses and were compiled in this process: an increase shows a recompilation."""
    return _traces


def count_trace() -> None:
    """Count a program that finds poses and is being traced: see `compilations`."""
    global _traces  # noqa: PLW0603
    _traces += 1
