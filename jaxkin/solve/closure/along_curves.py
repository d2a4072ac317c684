"""Steps of loops that follow curves and surfaces: how far they go is a function of the place of the contact."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin.geometry.elementary_motions import FollowedLaw, law_length, law_rate, law_turn
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import FollowedSpline
from jaxkin.solve.system.chain_tables import LAWS, distinct_tables
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State


class FollowedLaws(NamedTuple):
    """What each law of a curve or a surface says that steps follow, once a law, however many steps follow it."""

    length: Float[Array, "laws poses"]
    """0 for the angle of a tangent."""
    cos: Float[Array, "laws poses"]
    """1 for a length."""
    sin: Float[Array, "laws poses"]
    rate: Float[Array, "laws poses"]
    """Derivative of the length or the angle with respect to the coordinate of the step."""


class LawNumbers(NamedTuple):
    """Which laws the steps follow."""

    of_steps: Int[np.ndarray, "steps distinct"]
    """Number of the law of a step; -1 for none."""
    laws: tuple[tuple[int, FollowedLaw], ...]
    """Number of the curve in `LoopSystem.curves`, and the law."""


@lru_cache(maxsize=256)
def law_numbers(system: LoopSystem) -> LawNumbers:
    """Number the laws that steps of the distinct chains follow: host data."""
    table = distinct_tables(system)
    of_steps, laws = np.full(table.law.shape, -1), {}
    for place in zip(*np.nonzero(table.law), strict=True):
        law = LAWS[table.law[place]]
        if law is not None:
            of_steps[place] = laws.setdefault((int(table.curve[place]), law), len(laws))
    return LawNumbers(of_steps, tuple(laws))


def along_curves(system: LoopSystem, curves: Sequence[FollowedSpline], state: State) -> FollowedLaws:
    """Evaluate the laws of `law_numbers` at the places of the contacts; `curves` are those of `LoopSystem.curves`."""
    points = []
    for (joint, frame), curve in zip(system.curves, curves, strict=True):
        first, count = system.chains[joint][frame].column, len(MOVEMENTS[system.movements[joint][frame]].coordinates)
        points.append(curve.at(*state.x[first : first + count], xp=jnp))
    said = []
    for curve, law in law_numbers(system).laws:
        at = points[curve]
        amounts = (0.0, *law_turn(at)) if law == "turn" else (law_length(law, at), 1.0, 0.0)
        said.append((*amounts, law_rate(law, at)))
    poses, dtype = state.x.shape[-1:], state.x.dtype
    of_rows = ([jnp.broadcast_to(jnp.asarray(each, dtype), poses) for each in row] for row in zip(*said, strict=True))
    return FollowedLaws(*map(jnp.stack, of_rows))
