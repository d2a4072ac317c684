"""Steps of loops that follow curves and surfaces: how far they go is a function of the place of the contact."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry.elementary_motions import law_length, law_rate, law_turn
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import FollowedSpline
from jaxkin.solve.system.chain_tables import LAWS, distinct_tables
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State


def along_curves(
    system: LoopSystem, curves: Sequence[FollowedSpline], state: State, amounts: tuple[Array, Array, Array]
) -> tuple[Array, Array, Array, Float[Array, "steps distinct poses"]]:
    """Replace cosine, sine and travel of the steps that follow a curve or a surface by those at its parameters.

    `amounts` are those three, each (steps, distinct, poses); `curves` are those of `LoopSystem.curves`.

    Also computes the derivative of the angle or length of every step with respect to its coordinate: 1 where nothing
    is followed.
    """
    table = distinct_tables(system)
    cos, sin, travel = amounts
    rates = jnp.ones_like(travel)
    for number, ((joint, frame), curve) in enumerate(zip(system.curves, curves, strict=True)):
        follows = (table.law > 0) & (table.curve == number)
        first, count = system.chains[joint][frame].column, len(MOVEMENTS[system.movements[joint][frame]].coordinates)
        at = curve.at(*state.x[first : first + count], xp=jnp)
        for law_number, law in enumerate(LAWS):
            where = np.nonzero(follows & (table.law == law_number))
            if law is None or not where[0].size:
                continue
            sign = jnp.asarray(table.sign[where], cos.dtype)[:, None]
            rates = rates.at[where].set(law_rate(law, at))
            if law == "turn":
                cosine, sine = law_turn(at)
                cos, sin = cos.at[where].set(cosine), sin.at[where].set(sign * sine)
            else:
                travel = travel.at[where].set(sign * law_length(law, at))
    return cos, sin, travel, rates
