"""The solver as compiled programs: one finds the poses, with the compiler option that suits it; one gives derivatives.

Only the second is ever differentiated. Where the numbers are there (not inside `jit` or `vmap`), a gradient finds its
poses by the same program as the plain sweep.
"""

from __future__ import annotations

from functools import cache, partial
from inspect import signature
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin._traced import traced
from jaxkin.solve.execution.cores import pieces, side_by_side
from jaxkin.solve.execution.design_batches import all_designs
from jaxkin.solve.range.solve_range import CONTINUATION, MANY, Joints, Poses, displacements, find_poses, piece
from jaxkin.solve.status import Status, Tolerance
from jaxkin.solve.system.loop_system import LoopSystem

OPTIONS = {
    "xla_cpu_use_fusion_emitters": False,
    "xla_cpu_experimental_ynn_fusion_type": "",
    "xla_cpu_multi_thread_eigen": False,
    "xla_llvm_disable_expensive_passes": True,
    "xla_disable_hlo_passes": "cpu-parallel-task-assigner,tree_reduction_rewriter",
}
"""For the CPU. With its newer emitters XLA takes 1.7 times as long to compile the solver, with the costlier passes of
LLVM 1.4 times, for a program no faster.

It is made of operations of a few microseconds: to hand them to a library of reductions, to make trees of sums of some
forty numbers, or to split them among threads, takes longer than they do, and threads that wait for more of them keep
the core that another piece needs. Several cores have poses of their own: see `pieces`; or are several devices."""


class Outcome(NamedTuple):
    status: Int[Array, " poses"]
    gap: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""


def solve(
    system: LoopSystem,
    method: str,
    joints: Joints,
    inputs: Float[Array | np.ndarray, "driven poses"],
    tolerance: Tolerance,
) -> tuple[Float[Array, "columns poses"], Outcome]:
    """Displacements of all joints, and what became of the poses.

    Compiled once for a system, a method and a number of poses.
    """
    if not traced((joints, inputs, tolerance)):
        if method != CONTINUATION:
            return _program(_solve)(system, method, joints, inputs, tolerance)
        given, order = _in_order(np.asarray(inputs))
        number = pieces(system, given.shape[1])

        def solved(given: np.ndarray, begin: np.ndarray | None = None):
            return _program(_solve)(system, method, joints, given, tolerance, begin, share=number)

        found = side_by_side(system, solved, given, number)
        return found if order is None else jax.tree.map(lambda rows: rows[..., order], found)
    numbers = lax.stop_gradient((joints, inputs, tolerance))
    # options are for whole programs only: inside one that is being traced the search becomes part of that
    poses = (_plain if traced(numbers) else _program)(_of_all_designs)(system, method, *numbers)
    return _plain(displacements)(system, joints, inputs, poses), Outcome(poses.status, poses.gap)


def _of_all_designs(system: LoopSystem, method: str, joints: Joints, inputs: Array, tolerance: Tolerance) -> Poses:
    return all_designs(partial(find_poses, system, method), _all_closed)(joints, inputs, tolerance)


def _all_closed(poses: Poses) -> Array:
    return jnp.all(poses.status == Status.CLOSED.value)


def _solve(
    system: LoopSystem,
    method: str,
    joints: Joints,
    inputs: Float[Array, "driven poses"],
    tolerance: Tolerance,
    begin: Int[Array, ""] | None = None,
    share: int = 1,
) -> tuple[Float[Array, "columns piece"], Outcome]:
    poses = find_poses(system, method, joints, inputs, tolerance, share, begin)
    return displacements(system, joints, piece(inputs, share, begin), poses), Outcome(poses.status, poses.gap)


def _in_order(inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """Many poses of a single input in rising order, as interpolation needs them, and where each is to be put back."""
    if len(inputs) != 1 or inputs.shape[1] < MANY:
        return inputs, None
    before, after = inputs[0, :-1], inputs[0, 1:]
    if np.all(after >= before) or np.all(after <= before):
        return inputs, None
    order = np.argsort(inputs[0], kind="stable")
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    return inputs[:, order], place


@cache
def _plain(function):
    return jax.jit(function, static_argnames=_static(function))


@cache
def _program(function):
    return jax.jit(function, static_argnames=_static(function), **jit_options())


def _static(function) -> tuple[str, ...]:
    return tuple(name for name in ("system", "method", "share") if name in signature(function).parameters)


@cache
def jit_options() -> dict[str, Any]:
    """The options as an argument of `jax.jit`, where this version of JAX knows them; for whole programs only."""
    try:
        jax.jit(lambda x: x, compiler_options=OPTIONS)(0.0)
    except (TypeError, jax.errors.JaxRuntimeError):
        return {}
    return {"compiler_options": OPTIONS}
