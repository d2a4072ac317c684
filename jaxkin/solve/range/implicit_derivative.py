"""Attach the derivatives of closed poses by the implicit function theorem.

A closed pose satisfies r(geometry, inputs, free coordinates) = 0, so its free coordinates change by the least-norm
solution of `J delta = -dr`, which is found block after block, as the pose was. This rule serves forward, reverse and
nested differentiation, and no iteration is differentiated. A pose that did not close has no derivative: it is set to
zero, and no number of such a pose enters the derivative of another one.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Bool, Float

from jaxkin.solve.closure.closure import Geometry, closure, free_jacobian
from jaxkin.solve.linear.blocks import solve_blocks_refined
from jaxkin.solve.linear.least_norm import damping_floor
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, assembled, drive, driven_rate, rate


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def attach_derivative(
    system: LoopSystem,
    geometry: Geometry,
    inputs: Float[Array, "driven poses"],
    solved: State,
    closed: Bool[Array, " poses"],
) -> State:
    """Return the solved state, with derivatives with respect to geometry and inputs at the poses that are `closed`."""
    del geometry, inputs, closed
    return solved


@partial(attach_derivative.defjvp, symbolic_zeros=True)
def _implicit_jvp(system: LoopSystem, primals, tangents):
    geometry, inputs, solved, closed = primals
    d_geometry, d_inputs, _, _ = tangents
    geometry_rests = all(isinstance(each, SymbolicZero) for each in jax.tree.leaves(d_geometry))
    d_geometry, d_inputs = _with_zeros(d_geometry, geometry), _with_zeros(d_inputs, inputs)
    state = attach_derivative(system, geometry, inputs, solved, closed)
    # poses that did not close are replaced before anything is computed from them: a NaN would pass through a mask
    rest = assembled(system, state.x.shape[-1], state.x.dtype)
    safe = jax.tree.map(lambda a, b: jnp.where(closed, a, b), state, rest)
    safe_inputs = jnp.where(closed, inputs, 0.0)

    _, d_driven = jax.jvp(lambda inputs: drive(system, safe, inputs), (safe_inputs,), (d_inputs,))
    if not system.free:
        return state, jax.tree.map(lambda d: jnp.where(closed, d, 0.0), d_driven)
    evaluation = closure(system, geometry, safe)
    # the driven columns of the Jacobian are there already, and the loops are closed: they are those of the residual
    _, columns = driven_rate(system, safe, d_inputs)
    d_residual = jnp.zeros_like(evaluation.residual)
    for column in system.driven:
        d_residual = d_residual + evaluation.jacobian[:, column] * columns[column]
    if not geometry_rests:
        of_geometry = jax.jvp(lambda own: closure(system, own, safe).residual, (geometry,), (d_geometry,))[1]
        d_residual = d_residual + of_geometry
    jacobian = free_jacobian(system, evaluation)
    delta = -solve_blocks_refined(jacobian, d_residual, damping_floor(jacobian.dtype), equation_blocks(system))
    d_state = jax.tree.map(jnp.add, d_driven, rate(system, safe, delta))
    return state, jax.tree.map(lambda d: jnp.where(closed, d, 0.0), d_state)


def _with_zeros(tangents, primals):
    """Put zeros in place of the tangents that are known to be zero."""
    return jax.tree.map(
        lambda tangent, primal: jnp.zeros_like(primal) if isinstance(tangent, SymbolicZero) else tangent,
        tangents,
        primals,
    )
