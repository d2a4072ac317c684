"""Attach derivatives to displacements that are known already, without finding their poses anew."""

from __future__ import annotations

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin.solve.closure.closure import closure, free_jacobian, scaled_geometry
from jaxkin.solve.closure.joint_coordinates import as_state
from jaxkin.solve.linear.least_norm import MAX_ALWAYS_UNROLLED_ROWS, damping_floor, solve_least_norm
from jaxkin.solve.range.poses import RangePoses
from jaxkin.solve.range.solve_range import DERIVATIVE_GROUP, displacements
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import drive, driven, retract

CLOSING_STEPS = 2
"""Newton steps that close poses which other joints left open by their play: each squares it, and files have 1e-6."""


def known_displacements(
    system: LoopSystem,
    joints: Joints,
    inputs: Float[Array, "driven poses"],
    known: Float[Array, "columns poses"],
    status: Int[Array, " poses"],
    refined: bool = False,
) -> Float[Array, "columns poses"]:
    """Return the displacements of all joints in known poses, as differentiable functions of joints and inputs.

    `known` are displacements in radians and lengths of the mechanism, finite ones also at poses that did not close, and
    `status` are codes of `Status`: a pose that is not closed has derivatives of zero. With `refined`, poses that are
    open by the play of their joints are closed before they are differentiated.
    """
    geometry, lengths = lax.stop_gradient(scaled_geometry(system, joints))
    state = as_state(system, joints.frames_1, joints.frames_2, lax.stop_gradient(known))
    state = state._replace(x=state.x / lengths)
    if refined and system.free:
        state = drive(system, state, lax.stop_gradient(inputs) / driven(system, lengths))
        for _ in range(CLOSING_STEPS):
            found = closure(system, geometry, state)
            jacobian = free_jacobian(system, found)
            delta = solve_least_norm(jacobian, found.residual, damping_floor(jacobian.dtype), system.used)
            state = retract(system, state, -delta)
    # few equations are solved by straight-line code, which needs no cache
    size = None if system.equations <= MAX_ALWAYS_UNROLLED_ROWS else DERIVATIVE_GROUP
    return displacements(system, joints, inputs, RangePoses(state, status, jnp.zeros_like(state.x[0])), size)
