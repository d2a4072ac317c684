"""Idle spins: a rod between two balls may turn about the line of their centres, and nothing else moves.

The loops say nothing about such a spin. One equation more for each does: the balls turn as little as they can, counted
from the assembled pose. With the turn `(w, v)` of either ball and the line `n`, which is fixed in the rod, that is
`sum(+-w v.n) = 0`, where the sum of their `|v|^2` is least. So the same input gives the same pose by whatever way;
after a thousand turns no spin is left behind, as it is by least-norm steps alone.
"""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.solve.state import State
from jaxkin.solve.system import LoopSystem

Lines = Float[Array, "spins 2 3"]
"""For each spin the line through its two balls, in the frames of both, with the sign of the turn that a spin gives."""


def spin_lines(system: LoopSystem, frames: Float[Array, "frames 4 4"]) -> Lines:
    """The lines from the frames of the joints; those on their first parts come first, joint by joint."""
    of_ball, first = [], 0
    for chain in system.chains:
        of_ball += [first + frame for _, frame, column, _ in chain if column in system.balls]
        first += len(chain)
    lines = []
    for one, other, sign in system.spins:
        a, b = frames[of_ball[one]], frames[of_ball[other]]
        line = b[:3, 3] - a[:3, 3]
        line = line / jnp.sqrt(jnp.sum(line * line))
        lines.append(jnp.stack([a[:3, :3].T @ line, sign * b[:3, :3].T @ line]))
    return jnp.stack(lines) if lines else jnp.zeros((0, 2, 3), frames.dtype)


def spin_equations(system: LoopSystem, lines: Lines, state: State) -> tuple[Array, Array]:
    """Residual (spins, poses) and Jacobian (spins, columns, poses) of the equations."""
    residuals, rows = [], []
    for (*balls, _), pair in zip(system.spins, lines, strict=True):
        residual, row = 0.0, jnp.zeros((system.columns, state.x.shape[-1]), state.x.dtype)
        for ball, line in zip(balls, pair[..., None], strict=True):
            w, v = state.turns[ball, 0], state.turns[ball, 1:]
            along = jnp.sum(v * line, axis=0)
            residual += 2 * w * along
            first = system.balls[ball]
            derivative = w * w * line + w * jnp.cross(v, line, axis=0) - along * v
            row = row.at[first : first + 3].set(derivative)
        residuals.append(residual)
        rows.append(row)
    return jnp.stack(residuals), jnp.stack(rows)
