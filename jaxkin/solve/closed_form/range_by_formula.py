"""A range of a single input by formulas, with the proof that the motion leads to every pose of it.

The formulas give a pose for every input, on the branch of the assembled pose, but they do not know whether the input
can be moved there. It can if all discriminants stay positive on the way. They are computed at `NODES` inputs between
the ends of the range and the assembled pose, and bounded between these. Angles are unwrapped along the same nodes.
Where anything is in doubt the range is not `proven`, and the general program is to solve it.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.assembled_axes import Axes
from jaxkin.solve.closed_form.solve_groups import branch_signs, residual_norm, solve_groups
from jaxkin.solve.range.poses import CLOSED_ROUNDINGS, Poses
from jaxkin.solve.status import ClosureTolerance, Status, rounding_residual
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, driven

NODES = 129
"""Inputs at which the discriminants are computed: 2.8 degrees apart on a full turn. Five-link chains of dyads need no
more, and they cost as much as 129 poses."""
LEAST_DISCRIMINANT = 1e-6
"""Discriminant over its largest value below which a range is left to the general program: the coordinates are right to
a thousand roundings there, and a limit or a change point may be near."""
MAX_TURN = 0.7
"""Largest change of an angle from node to node, radians: the unwrapping allows pi, a pose lies half as far from its
node, and beyond a radian the bound between the nodes is none."""
MAX_START_DISTANCE = 0.1
"""Largest coordinate of the pose that the formulas give for the assembled input, radians or characteristic lengths:
dimensions that were changed leave the loops open there, and the general program closes them no farther away."""
CLOSED_START = 1e-9
"""The same for loops that are closed at the assembled pose: rounding, and what files were rounded to."""
OPEN_START_DISCRIMINANT = 0.25
"""Least discriminant at the assembled input for loops that are open there: the other branch is then at least a radian,
or half a link, away, and the general program closes the loops on this one."""


class FormulaPoses(NamedTuple):
    """What the formulas say about a range."""

    poses: Poses
    """All CLOSED, if they are proven."""
    proven: Bool[Array, ""]
    """Whether the poses are closed and the motion from the assembled pose leads to all of them."""


def find_poses_by_formula(
    system: LoopSystem, axes: Axes, inputs: Float[Array, "1 poses"], tolerance: ClosureTolerance
) -> FormulaPoses:
    """Find the poses for finite inputs in radians or lengths of the mechanism, of a system that is all formulas.

    `inputs` is the range, or a shard of it: the way from the assembled pose is judged for what is given.
    """
    lengths = jnp.where(jnp.array(system.is_length, bool), axes.length, 1.0)[:, None]
    values = inputs / driven(system, lengths)
    low, high = jnp.min(values, initial=0.0), jnp.max(values, initial=0.0)
    whole_turn = jnp.asarray(system.periodic) & (high - low > TURN)
    low, high = jnp.where(whole_turn, -TURN / 2, low), jnp.where(whole_turn, TURN / 2, high)
    way = low + (high - low) * jnp.asarray(np.linspace(0.0, 1.0, NODES), values.dtype)
    signs = branch_signs(system, axes)
    every, discriminant = solve_groups(
        system, axes, signs, jnp.concatenate([way, jnp.zeros(1, way.dtype), values[0]])[None]
    )
    nodes, begin, found = every[:, :NODES], every[:, NODES : NODES + 1], every[:, NODES + 1 :]

    turning = jnp.asarray(_unwrapped(system))[:, None]
    steps = jnp.diff(nodes, axis=1)
    steps = steps - turning * TURN * jnp.round(steps / TURN)
    path = nodes[:, :1] + jnp.concatenate([jnp.zeros_like(steps[:, :1]), jnp.cumsum(steps, axis=1)], axis=1)
    path = path - turning * TURN * jnp.round((path[:, _node(jnp.zeros(1), low, high)] - begin) / TURN)
    winding = turning * TURN * jnp.round((path[:, -1:] - path[:, :1]) / TURN)

    turns = jnp.where(whole_turn, jnp.round(values / TURN), 0.0)
    expected = path[:, _node((values - TURN * turns)[0], low, high)] + winding * turns
    x = found + turning * TURN * jnp.round((expected - found) / TURN)
    residual = residual_norm(system, axes, x)

    closes = jnp.maximum(rounding_residual(x.dtype, CLOSED_ROUNDINGS), tolerance.target_residual)
    closes = jnp.all(residual <= jnp.minimum(closes, tolerance.max_residual))
    moves_little = jnp.max(jnp.abs(turning * steps)) <= MAX_TURN
    away = jnp.max(jnp.abs(begin))
    begins = (away <= CLOSED_START) | (
        (away <= MAX_START_DISTANCE) & (jnp.min(discriminant[:, NODES]) >= OPEN_START_DISCRIMINANT)
    )
    positive = jnp.min(least_between(discriminant[:, :NODES])) > LEAST_DISCRIMINANT
    proven = closes & moves_little & begins & positive & (jnp.min(discriminant) > LEAST_DISCRIMINANT)
    status = jnp.where(proven, Status.CLOSED.value, Status.STALLED.value)
    state = State(x, jnp.zeros((0, 4, x.shape[1]), x.dtype))
    return FormulaPoses(Poses(state, jnp.broadcast_to(status, residual.shape), residual), proven)


def least_between(values: Float[Array, "rows nodes"]) -> Float[Array, "rows intervals"]:
    """Estimate a lower bound of smooth functions between equidistant nodes.

    Between two nodes a function f lies above the lesser value by no less than -h^2 / 8 max |f''|. The second difference
    h^2 f'' is taken as the largest of the four nearest ones, and twice that.
    """
    second = jnp.abs(values[:, 2:] - 2 * values[:, 1:-1] + values[:, :-2])
    second = jnp.pad(second, ((0, 0), (2, 2)), mode="edge")  # of the nodes -1 ... n
    nearest = jnp.stack([second[:, k : second.shape[1] - 3 + k] for k in range(4)])
    return jnp.minimum(values[:, 1:], values[:, :-1]) - 0.25 * jnp.max(nearest, axis=0)


def _node(at: Float[Array, " poses"], low: Float[Array, ""], high: Float[Array, ""]) -> Int[Array, " poses"]:
    """The number of the node that is nearest to an input."""
    width = jnp.where(high > low, high - low, 1.0)
    return jnp.clip(jnp.round((NODES - 1) * (at - low) / width), 0, NODES - 1).astype(jnp.int32)


def _unwrapped(system: LoopSystem) -> np.ndarray:
    """1 for columns that are angles and not driven, else 0."""
    return np.array(
        [float(not length and column not in system.driven) for column, length in enumerate(system.is_length)]
    )
