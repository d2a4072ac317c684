"""Numbers that say how well a pose is determined."""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.solve.closure import closure, loop_geometry
from jaxkin.solve.correct import correct
from jaxkin.solve.linear import least_norm, scale
from jaxkin.solve.state import assembled, retract
from jaxkin.solve.system import LoopSystem

_ITERATIONS = 40


def jacobian_near(
    system: LoopSystem,
    before: tuple[Array, ...],
    after: tuple[Array, ...],
    pitch: tuple[Array, ...],
    step: float | Array,
) -> Float[Array, "2 equations columns"]:
    """Closure Jacobians, lengths scaled, at the assembled pose and at a closed pose about `step` away from it.

    The direction is a fixed generic one, taken along the freedoms that the assembled pose has.
    """
    geometry, _ = loop_geometry(system, before, after, pitch)
    dtype = before[0].dtype
    home = correct(system, geometry, assembled(system, 1, dtype), _ITERATIONS)
    jacobian = home.closure.jacobian
    generic = jnp.sin(1.0 + 2.7 * jnp.arange(system.columns, dtype=dtype))[:, None]
    blocked = least_norm(jacobian, jnp.sum(jacobian * generic[None], axis=1), 1e-12 * scale(jacobian))
    away = retract(system, home.state, step * (generic - blocked))
    beside = correct(system, geometry, away, _ITERATIONS)
    return jnp.stack([jacobian[..., 0], closure(system, geometry, beside.state).jacobian[..., 0]])
