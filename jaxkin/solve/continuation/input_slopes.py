"""Differentiate closed poses with respect to the distance along the input path: the slopes of the branch."""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import Closure
from jaxkin.solve.correctors.levenberg_marquardt import damping_floor
from jaxkin.solve.linear.blocks import solve_blocks
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, driven_rate


def input_slopes(
    system: LoopSystem, state: State, closed: Closure, direction: Float[Array, "driven poses"]
) -> Float[Array, "columns poses"]:
    """Differentiate the coordinates of closed states with respect to the distance along the input path.

    `direction` is the derivative of the inputs with respect to that distance, and `closed` the closure at `state`. With
    the driven part `dx_d` of the derivative given, the rest solves `J dx = -J dx_d` with least norm: coordinates that
    the loops leave undetermined stay at rest. Rows of free balls are rotation vectors, as in `retract`.
    """
    change, columns = driven_rate(system, state, direction)
    right = jnp.sum(closed.jacobian * columns[None], axis=1)
    return change - solve_blocks(closed.jacobian, right, damping_floor(right.dtype), equation_blocks(system))
