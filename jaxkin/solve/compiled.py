"""The solver as compiled programs: one finds the poses, with the compiler option that suits it; one gives derivatives.

Only the second is ever differentiated. Where the numbers are there (not inside `jit` or `vmap`), a gradient finds its
poses by the same program as the plain sweep.
"""

from __future__ import annotations

from functools import cache, partial

import jax
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.traced import traced
from jaxkin.solve.sweep import Joints, Poses, displacements, find_poses
from jaxkin.solve.system import LoopSystem

OPTIONS = {"xla_cpu_use_fusion_emitters": False}
"""With its newer emitters XLA takes 1.7 times as long to compile the solver for the CPU, for a program no faster."""


def solve(
    system: LoopSystem, joints: Joints, inputs: Float[Array, "driven poses"]
) -> tuple[Float[Array, "columns poses"], Poses]:
    """Displacements of all joints, and the poses found: compiled once for a system and a number of poses."""
    numbers = lax.stop_gradient((joints, inputs))
    # options are for whole programs only: inside one that is being traced the search becomes part of that
    poses = (_find_inside if traced(numbers) else finder())(system, *numbers)
    return _displacements(system, joints, inputs, poses), poses


_find_inside = partial(jax.jit, static_argnums=0)(find_poses)
_displacements = partial(jax.jit, static_argnums=0)(displacements)


@cache
def finder():
    """The compiled search, with the option where this version of JAX knows it."""
    try:
        jax.jit(lambda x: x, compiler_options=OPTIONS)(0.0)
    except (TypeError, jax.errors.JaxRuntimeError):
        return _find_inside
    return jax.jit(find_poses, static_argnums=0, compiler_options=OPTIONS)
