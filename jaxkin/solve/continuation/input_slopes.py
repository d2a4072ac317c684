"""Differentiate closed poses with respect to the distance along the input path: the slopes of the branch."""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import Closure
from jaxkin.solve.continuation.fronts import Fronts
from jaxkin.solve.linear.blocks import solve_blocks
from jaxkin.solve.linear.least_norm import damping_floor
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, driven_rate, turning

SINGULAR_RATIO = 1e-3
"""Ratio of the determinants of a block at both ends of a step, below which the step ends at a singular pose: rounding
leaves 1e-7 there in float64, and 1e-4 in float32."""


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


def slopes_of_branch(
    system: LoopSystem,
    slope: Float[Array, "columns fronts"],
    ratio: Float[Array, "blocks fronts"],
    before: Fronts,
    state: State,
    moved: Float[Array, " fronts"],
) -> Float[Array, "columns fronts"]:
    """Replace the slopes of least norm at the ends of steps that are singular, by those of the parabola of the step.

    Where two branches cross, the slope of least norm is that of neither, and predictions would lead to the other one.
    The parabola, from the fronts `before` the step to the `state` a distance `moved` away, has the slope of the branch
    to the square of its length. Free balls keep theirs.
    """
    singular = jnp.any(jnp.abs(ratio) < SINGULAR_RATIO, axis=0) & (moved != 0) & ~turning(system)
    chord = (state.x - before.state.x) / jnp.where(moved != 0, moved, 1.0)
    return jnp.where(singular, 2 * chord - before.slope, slope)
