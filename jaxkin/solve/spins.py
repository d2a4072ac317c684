"""Idle spins: a rod between two balls may turn about the line of their centres, and nothing else moves.

The loops say nothing about such a spin. One equation more for each does: the balls turn as little as they can, counted
from the assembled pose. With the turn `(w, v)` of either ball and the line `n`, which is fixed in the rod, that is
`sum(+-w v.n) = 0`, where the sum of their `|v|^2` is least. So the same input gives the same pose by whatever way;
after a thousand turns no spin is left behind, as it is by least-norm steps alone.
"""

from __future__ import annotations

from functools import lru_cache

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin.geometry.motions import MOVEMENTS
from jaxkin.solve.state import State
from jaxkin.solve.system import LoopSystem

Lines = Float[Array, "spins 2 3"]
"""For each spin the line through its two balls, in the frames of both, with the sign of the turn that a spin gives."""


def spin_lines(system: LoopSystem, frames: Float[Array, "frames 4 4"]) -> Lines:
    """The lines from the frames of the joints; those on their first parts come first, joint by joint."""
    of_ball, first = [], 0
    for chain in system.chains:
        of_ball += [first + frame for name, frame, _, _ in chain if MOVEMENTS[name].ball]
        first += len(chain)
    balls, signs = _pairs(system)
    ends = frames[np.array(of_ball, np.int32)[balls]]
    line = ends[:, 1, :3, 3] - ends[:, 0, :3, 3]
    line = line / jnp.sqrt(jnp.sum(line * line, axis=1, keepdims=True))
    return jnp.einsum("sbij,si->sbj", ends[..., :3, :3], line) * jnp.asarray(signs, frames.dtype)


def spin_equations(
    system: LoopSystem, lines: Lines, state: State
) -> tuple[Float[Array, "spins poses"], Float[Array, "spins columns poses"]]:
    """Residual and Jacobian of the equations."""
    balls, _ = _pairs(system)
    poses = state.x.shape[-1]
    w, v = state.turns[balls, :1], state.turns[balls, 1:]
    line = lines[..., None]
    along = jnp.sum(v * line, axis=2, keepdims=True)
    turned = w * w * line + w * jnp.cross(v, line, axis=2) - along * v
    turned = jnp.concatenate([turned.reshape(-1, poses), jnp.zeros((1, poses), turned.dtype)])
    return jnp.sum(2 * w * along, axis=(1, 2)), turned[_places(system)]


@lru_cache(maxsize=256)
def _pairs(system: LoopSystem) -> tuple[Int[np.ndarray, "spins 2"], Float[np.ndarray, "spins 2 1"]]:
    """The two balls of each spin, and the signs of their turns."""
    table = np.array(system.spins, np.int32).reshape(-1, 3)
    return table[:, :2], np.stack([np.ones(len(table)), table[:, 2]], axis=1)[..., None]


@lru_cache(maxsize=256)
def _places(system: LoopSystem) -> Int[np.ndarray, "spins columns"]:
    """For each entry of the Jacobian its number among the turns of the pairs, three a ball; behind them is a zero."""
    balls, _ = _pairs(system)
    places = np.full((len(balls), system.columns), 6 * len(balls), np.int32)
    for spin, pair in enumerate(balls):
        for end, ball in enumerate(pair):
            places[spin, list(system.balls[ball])] = 6 * spin + 3 * end + np.arange(3)
    return places
