"""Steps of loops that follow curves: how far they go is a function of the parameter of the contact."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry.curves import Spline
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State


def along_curves(
    system: LoopSystem, curves: Sequence[Spline], state: State, amounts: tuple[Array, Array, Array]
) -> tuple[Array, Array, Array, Float[Array, "steps chains poses"]]:
    """Replace cosine, sine and travel of the steps that follow a curve by those at its parameter.

    `amounts` are those three, each (steps, chains, poses); `curves` are those of `LoopSystem.curves`.

    Also computes the derivative of the angle or length of every step with respect to its coordinate: 1 where no curve
    is followed.
    """
    table = chain_tables(system)
    cos, sin, travel = amounts
    rates = jnp.ones_like(travel)
    for number, curve in enumerate(curves):
        follows = (table.law > 0) & (table.curve == number)
        if not follows.any():
            continue
        at = curve.at(state.x[table.column[follows][0]], jnp)
        for law, value, rate in ((1, at.x, at.dx), (2, at.y, at.dy), (3, None, at.turning)):
            where = np.nonzero(follows & (table.law == law))
            sign = jnp.asarray(table.sign[where], cos.dtype)[:, None]
            rates = rates.at[where].set(rate)
            if value is None:
                cos, sin = cos.at[where].set(at.cos), sin.at[where].set(sign * at.sin)
            else:
                travel = travel.at[where].set(sign * value)
    return cos, sin, travel, rates
