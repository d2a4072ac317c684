"""Poses of least residual of loops that do not close, begun at the poses of joints nearby whose loops do.

The two sets of joints differ by their play. Singular values of the closure Jacobian that the play may have brought
about hold nothing: along their directions the pose stays where the loops that close have it.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin.linkage.first_order import LARGEST_DOUBT, SPREAD
from jaxkin.solve.closure.closure import closure
from jaxkin.solve.closure.joint_coordinates import as_state, ball_turns, read_off, unwrapped
from jaxkin.solve.correctors.levenberg_marquardt import free_jacobian
from jaxkin.solve.range.solve_range import Joints, scaled
from jaxkin.solve.status import Scalar, Status
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import retract

STEPS = 4
"""Gauss-Newton steps: each gains as many digits as the play has, and the first leaves its square."""


@partial(jax.jit, static_argnums=0)
def least_residual(
    system: LoopSystem,
    joints: Joints,
    ideal: Joints,
    displacements: Float[Array, "columns poses"],
    status: Int[Array, " poses"],
    largest: Scalar,
) -> tuple[Float[Array, "columns poses"], Int[Array, " poses"], Float[Array, " poses"]]:
    """Displacements of least residual from those of the `ideal` joints; status and closure gap of the given `joints`.

    Displacements are in radians and lengths of the mechanism, and their derivatives those of the ideal joints. Poses
    that were CLOSED are MISFIT where their gap is more than the `largest` of a closed pose.
    """
    begun = lax.stop_gradient(displacements)
    joints, ideal = lax.stop_gradient((joints, ideal))
    geometry, lengths = scaled(system, joints)
    cutoff = jnp.minimum(SPREAD * _play(joints, ideal, jnp.max(lengths)), LARGEST_DOUBT)
    state = as_state(system, joints.frames_1, joints.frames_2, begun)
    state = state._replace(x=state.x / lengths)

    def step(_, state):
        found = closure(system, geometry, state)
        jacobian = jnp.moveaxis(free_jacobian(system, found), -1, 0)
        delta = jnp.einsum("pce,ep->cp", jnp.linalg.pinv(jacobian, rtol=cutoff), found.residual)
        return retract(system, state, -delta)

    state = lax.fori_loop(0, STEPS, step, state)
    found = read_off(system, joints.frames_1, joints.frames_2, state.x * lengths, ball_turns(system, geometry, state))
    gap = closure(system, geometry, state).gap
    misfit = (status == Status.CLOSED.value) & (gap > largest)
    status = jnp.where(misfit, Status.MISFIT.value, status)
    return displacements + lax.stop_gradient(unwrapped(system, found) - begun), status, gap


def _play(joints: Joints, ideal: Joints, length: Array) -> Array:
    """The largest difference of the frames, lengths over the characteristic one."""
    differences = [
        (jnp.asarray(one) - jnp.asarray(other)) / jnp.array([1.0, 1.0, 1.0, length])
        for one, other in zip((*joints.frames_1, *joints.frames_2), (*ideal.frames_1, *ideal.frames_2), strict=True)
    ]
    return jnp.max(jnp.stack([jnp.max(jnp.abs(difference)) for difference in differences]))
