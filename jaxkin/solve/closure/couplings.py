"""Evaluate the couplings of a loop system: one equation each, `sum_i sum_k c_ik q_i^k = d` (see `Coupling`)."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.system.joints import CouplingNumbers
from jaxkin.solve.system.loop_system import LoopSystem


def scaled_couplings(
    system: LoopSystem, given: Sequence[CouplingNumbers], length: Float[Array, ""]
) -> tuple[CouplingNumbers, ...]:
    """Scale couplings to coordinates in radians and lengths over the characteristic `length`.

    Each is divided by its largest coefficient, a constant in derivatives: so its residual is an angle, or a length over
    the characteristic length, whatever units its coefficients have.
    """
    found = []
    for columns, numbers in zip(system.couplings, given, strict=True):
        coefficients = jnp.asarray(numbers.coefficients, float)
        unit = jnp.where(np.array([system.is_length[column] for column in columns])[:, None], length, 1.0)
        scaled = coefficients * unit ** np.arange(1, coefficients.shape[1] + 1)
        largest = lax.stop_gradient(jnp.max(jnp.abs(scaled)))
        found.append(CouplingNumbers(scaled / largest, jnp.asarray(numbers.offset, float) / largest))
    return tuple(found)


def coupling_closure(
    system: LoopSystem, couplings: Sequence[CouplingNumbers], x: Float[Array, "columns poses"]
) -> tuple[Float[Array, "couplings poses"], Float[Array, "couplings columns poses"]]:
    """Evaluate residual and Jacobian of all couplings at scaled coordinates `x`."""
    residual, jacobian = [], []
    for columns, (coefficients, offset) in zip(system.couplings, couplings, strict=True):
        own = x[np.array(columns)]
        value, slope = jnp.zeros_like(own), jnp.zeros_like(own)
        for power in range(coefficients.shape[1], 0, -1):  # Horner's scheme: value is the polynomial over its variable
            factor = coefficients[:, power - 1, None]
            value, slope = value * own + factor, slope * own + power * factor
        residual.append(jnp.sum(value * own, axis=0) - offset)
        jacobian.append(jnp.zeros_like(x).at[np.array(columns)].set(slope, unique_indices=True))
    return jnp.stack(residual), jnp.stack(jacobian)
