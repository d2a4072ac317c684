"""Find the poses of least residual of loops that cannot close because the frames of their joints are inexact.

The iteration begins at the closed poses of ideal joints, which differ from the given ones by the play. A singular value
of the closure Jacobian that is no larger than what the play may bring about holds no coordinate: along its direction
the pose stays where the ideal joints have it.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin.linkage.first_order import LARGEST_UNCERTAIN, SPREAD
from jaxkin.solve.closure.closure import closure, free_jacobian, scaled_geometry
from jaxkin.solve.closure.joint_coordinates import as_state, ball_rotations, joint_coordinates, unwrap_ball_angles
from jaxkin.solve.status import Scalar, Status
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import retract

LEAST_RESIDUAL_STEPS = 4
"""Gauss-Newton steps: the error after the first is the square of the play, and each gains as many digits again."""


@partial(jax.jit, static_argnums=0)
def least_residual(
    system: LoopSystem,
    joints: Joints,
    ideal: Joints,
    displacements: Float[Array, "columns poses"],
    status: Int[Array, " poses"],
    max_residual: Scalar,
) -> tuple[Float[Array, "columns poses"], Int[Array, " poses"], Float[Array, " poses"]]:
    """Compute displacements of least residual of `joints` from the closed `displacements` of the `ideal` joints.

    Returns displacements, status and residual norm (square root of Eq. 12 of the given joints). Displacements are in
    radians and lengths of the mechanism; their derivatives are those of the ideal joints. A pose that was CLOSED is
    MISFIT where its residual norm is above `max_residual`.
    """
    begun = lax.stop_gradient(displacements)
    joints, ideal = lax.stop_gradient((joints, ideal))
    geometry, lengths = scaled_geometry(system, joints)
    cutoff = jnp.minimum(SPREAD * _play(joints, ideal, jnp.max(lengths)), LARGEST_UNCERTAIN)
    state = as_state(system, joints.frames_1, joints.frames_2, begun)
    state = state._replace(x=state.x / lengths)

    def step(_, state):
        found = closure(system, geometry, state)
        jacobian = jnp.moveaxis(free_jacobian(system, found), -1, 0)
        delta = jnp.einsum("pce,ep->cp", jnp.linalg.pinv(jacobian, rtol=cutoff), found.residual)
        return retract(system, state, -delta)

    state = lax.fori_loop(0, LEAST_RESIDUAL_STEPS, step, state)
    found = joint_coordinates(
        system, joints.frames_1, joints.frames_2, state.x * lengths, ball_rotations(system, geometry, state)
    )
    residual_norm = closure(system, geometry, state).residual_norm
    misfit = (status == Status.CLOSED.value) & (residual_norm > max_residual)
    status = jnp.where(misfit, Status.MISFIT.value, status)
    return displacements + lax.stop_gradient(unwrap_ball_angles(system, found) - begun), status, residual_norm


def _play(joints: Joints, ideal: Joints, length: Array) -> Array:
    """Measure the play: the largest difference of an entry of the frames, lengths over the characteristic length."""
    differences = [
        (jnp.asarray(one) - jnp.asarray(other)) / jnp.array([1.0, 1.0, 1.0, length])
        for one, other in zip((*joints.frames_1, *joints.frames_2), (*ideal.frames_1, *ideal.frames_2), strict=True)
    ]
    return jnp.max(jnp.stack([jnp.max(jnp.abs(difference)) for difference in differences]))
