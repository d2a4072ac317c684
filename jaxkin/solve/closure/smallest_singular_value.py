"""Compute the smallest singular value of the closure Jacobian that is not zero at all poses: the distance to
singularity.

The error of a pose with residual norm `r` is about `r` divided by this value, and the derivatives of the pose grow as
the reciprocal of the value. At a dead point or a change point the value is zero, and the error of a pose is about the
square root of the residual norm.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import closure, free_jacobian, scaled_geometry
from jaxkin.solve.closure.joint_coordinates import as_state
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem


@partial(jax.jit, static_argnums=(0, 1))
def smallest_singular_value(
    system: LoopSystem, rank: int, joints: Joints, displacements: Float[Array, "columns poses"]
) -> Float[Array, " poses"]:
    """Compute the singular value number `rank` (from 1, descending) of the Jacobian with respect to free coordinates.

    `displacements` are in radians and lengths of the mechanism; the singular value is that of the Jacobian for radians
    and lengths over the characteristic length.
    """
    system = system.uncut
    geometry, lengths = scaled_geometry(system, joints, constant=False)  # it does not cancel
    state = as_state(system, joints.frames_1, joints.frames_2, displacements)
    state = state._replace(x=state.x / lengths)
    jacobian = free_jacobian(system, closure(system, geometry, state))
    return jnp.linalg.svd(jnp.moveaxis(jacobian, -1, 0), compute_uv=False)[:, rank - 1]
