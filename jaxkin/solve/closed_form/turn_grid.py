"""Equally spaced inputs over most of a turn, which are nodes of its line themselves: see `poses_on_grid`."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Bool, Float, Shaped

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.arithmetic import namespace
from jaxkin.solve.closed_form.input_line import NODES

MAX_FINER = 2
"""Largest number of intervals between two poses: an angle at a node that is no pose is an arc tangent for nothing."""
MAX_INTERVALS = 1024
"""Largest number of intervals of a grid: full turns are summed over all of them. Beside more poses the nodes of another
line are few."""
ROUNDINGS = 8
"""Largest distance of an input from its node, in units of rounding of a full turn."""


class TurnGrid(NamedTuple):
    """Nodes over a full turn, and which of them are poses: numbers of the host."""

    values: Float[np.ndarray, " poses"]
    """The inputs, radians."""
    nodes: Float[np.ndarray, " nodes"]
    """Equally spaced from the assembled pose to where it is again, radians: at most as far apart as other `NODES`."""
    runs: tuple[slice, ...]
    """Where the poses are among the nodes, one run after another."""
    rising: Bool[np.ndarray, " poses"]
    """Which inputs are not negative. Negative ones are a full turn less than their nodes."""

    def poses_of(self, row: Shaped[Array | np.ndarray, "_"]) -> Shaped[Array | np.ndarray, "_"]:
        """Select the entries of the poses from those of the nodes; a single entry stands for all of them."""
        if row.shape[0] == 1:
            return row
        parts = [row[run] for run in self.runs]
        return parts[0] if len(parts) == 1 else namespace(row).concatenate(parts)


def turn_grid(values: Float[np.ndarray, " poses"]) -> TurnGrid | None:
    """Find the grid of rising inputs in radians; None where they are not equally spaced from or through the assembled
    pose, or where a grid has more nodes to solve than the inputs and `NODES` beside them."""
    poses = len(values)
    if poses < 2 or not 0 < values[1] - values[0] < TURN:
        return None
    per_turn = round(TURN / (values[1] - values[0]))
    finer = math.ceil((NODES - 1) / per_turn)
    intervals = finer * per_turn
    if finer > MAX_FINER or intervals > min(MAX_INTERVALS, poses + NODES):
        return None
    first = round(values[0] / TURN * per_turn)
    numbers = np.arange(first, first + poses)
    if first < -per_turn or numbers[-1] > per_turn or poses > per_turn + 1:
        return None
    if np.any(np.abs(values - TURN / per_turn * numbers) > ROUNDINGS * np.finfo(float).eps * TURN):
        return None
    nodes, rising = np.linspace(0.0, TURN, intervals + 1), numbers >= 0
    places = finer * np.where(rising, numbers, numbers + per_turn)
    nodes[places[rising & (numbers > 0)]] = values[rising & (numbers > 0)]
    runs = [places[mask] for mask in (~rising, rising) if np.any(mask)]
    return TurnGrid(values, nodes, tuple(slice(run[0], run[-1] + 1, finer) for run in runs), rising)
