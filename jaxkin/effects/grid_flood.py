"""Spread from the home pose over a grid of two inputs, from node to node, past no singular pose.

Steps are those of `grid_steps`. Nodes to which no step leads get the pose of least residual from a neighbour: closed,
but not connected on this grid, or out of reach.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from jaxkin.effects.grid_steps import GridSteps, NodeInputs, StepResults, neighbours
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.trig import TURN
from jaxkin.mechanism.drive_plan import DrivenLoopGroup
from jaxkin.mobility.home_pose import HomeRows
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status, classify
from jaxkin.solve.system.state import State, assembled

MAX_STEPS_TO_GRID = 1000
"""Steps of the grid from the assembled pose to the first node, at most: of a fine grid far away there would be many."""


class Flooded(NamedTuple):
    """The poses of all nodes."""

    states: tuple[State, ...]
    """Of each loop group, with the nodes as the last axis."""
    status: Int[np.ndarray, " nodes"]
    residual: Float[np.ndarray, " nodes"]


def flood(
    loop_groups: Sequence[DrivenLoopGroup],
    home: HomeRows,
    options: SolverOptions,
    inputs: NodeInputs,
    shape: tuple[int, int],
    max_residual: float,
) -> Flooded:
    """Find the poses of all nodes of a grid, the last input fastest; inputs are radians and lengths of the mechanism.

    It begins at those nodes around the pose `home`, in which the inputs are 0, that straight lines lead to.
    """
    if not loop_groups:  # nothing is to be closed
        count = inputs.shape[1]
        return Flooded((), np.full(count, Status.CLOSED.value, np.int32), np.zeros(count))
    front = _Front(loop_groups, options, inputs, shape, max_residual)
    if front.begin(home, nodes_around(inputs)):
        front.spread(_Wanted.FOLLOWED)
        front.followed = front.known.copy()
    front.spread(_Wanted.LEAST)
    # what is open may close from neighbours that were found later
    front.known = front.residual <= max_residual
    front.spread(_Wanted.CLOSED)
    stationary, followed = jnp.asarray(front.stationary), jnp.asarray(front.followed)
    status = np.asarray(classify(jnp.asarray(front.residual), stationary, followed, max_residual))
    return Flooded(tuple(State(*map(jnp.asarray, state)) for state in front.states), status, front.residual)


def nodes_around(inputs: NodeInputs) -> Int[np.ndarray, " around"]:
    """Find the corners of the cell of a grid that the assembled pose, 0, is in, the nearest one first.

    One of them would not do: near a singular pose, or a limit of a joint, the nearest one may be beyond it. Of an input
    that is 0 at no value of the grid or between two, the value next to 0 counts.
    """
    corner = np.ones(inputs.shape[1], bool)
    for row in inputs:
        below, above = row[row <= 0].max(initial=-np.inf), row[row >= 0].min(initial=np.inf)
        corner &= (row == below) | (row == above)
    (found,) = np.nonzero(corner)
    return found[np.argsort(np.linalg.norm(inputs[:, found], axis=0), kind="stable")]


class _Wanted(Enum):
    """Which poses of neighbours are kept."""

    FOLLOWED = "closed poses to which the branch leads"
    CLOSED = "closed poses"
    LEAST = "the pose of least residual"


class _Front:
    """The nodes that are known so far, and their states."""

    def __init__(
        self, loop_groups: Sequence[DrivenLoopGroup], options: SolverOptions, inputs, shape, max_residual
    ) -> None:
        self.steps, self.inputs, self.shape = GridSteps(loop_groups, options, max_residual), inputs, shape
        count = inputs.shape[1]
        rest = [assembled(system, count, inputs.dtype) for system in self.steps.systems]
        self.states = [[np.array(part) for part in state] for state in rest]
        self.known = np.zeros(count, bool)
        self.residual = np.full(count, np.inf)
        self.stationary = np.zeros(count, bool)
        self.followed = np.zeros(count, bool)
        """To which nodes the branch of the assembled pose leads."""

    def begin(self, home: HomeRows, around: Int[np.ndarray, " around"]) -> bool:
        """Go from the home pose to the nodes around it, in steps of the grid, or, far away, longer ones.

        Those to which the branch leads are known then, or else the first one, and False is returned.
        """
        spacing = np.ptp(self.inputs, axis=1) / max(max(self.shape) - 1, 1)
        ends = self.inputs[:, around]
        far = np.abs(ends).max(axis=1)
        steps = max((a / step for a, step in zip(far, spacing, strict=True) if step > 0), default=0.0)
        count = int(np.ceil(np.clip(steps, 1, MAX_STEPS_TO_GRID)))
        begun = self.steps.states_of([np.tile(row, (len(around), 1)) for row in home])
        found = self.steps.follow(begun, 0.0 * ends, ends, count)
        (taken,) = np.nonzero(np.asarray(found.taken))
        chosen = taken if len(taken) else np.array([0])
        self._keep(around[chosen], found, chosen)
        return len(taken) > 0

    def spread(self, wanted: _Wanted) -> None:
        """Step from known nodes to their unknown neighbours, and on from these, until no more poses are found."""
        newest = np.flatnonzero(self.known)
        while len(newest):
            begin, end = self._pairs(newest)
            if not len(end):
                return
            states = [[part[..., begin] for part in state] for state in self.states]
            ends = self.inputs[:, begin], self.inputs[:, end]
            if wanted is _Wanted.FOLLOWED:
                found = self.steps.follow(states, *ends)
            else:
                found = self.steps.walk(states, *ends, 1)
            residual = np.nan_to_num(np.asarray(found.residual), nan=np.inf)
            good = {
                _Wanted.FOLLOWED: np.asarray(found.taken),
                _Wanted.CLOSED: residual <= self.steps.max_residual,
                _Wanted.LEAST: np.ones(len(end), bool),
            }[wanted]
            order = np.lexsort([residual, ~good])
            newest, first = np.unique(end[order], return_index=True)
            chosen = order[first]
            newest, chosen = newest[good[chosen]], chosen[good[chosen]]
            self._keep(newest, found, chosen)
            if wanted is _Wanted.LEAST:
                self._unwind(newest)

    def _unwind(self, nodes: np.ndarray) -> None:
        """Take full turns off the angles of poses far from closed ones, whose steps may have turned them on and on."""
        for system, (x, _) in zip(self.steps.systems, self.states, strict=True):
            kept = {*system.driven, *(column for coupling in system.couplings for column in coupling)}
            for movement, _, first, _ in (each for chain in system.chains for each in chain):
                if MOVEMENTS[movement].has_pitch:
                    kept.add(first)
            turning = [c for c, length in enumerate(system.is_length) if not length and c not in kept]
            which = np.array(turning, int)[:, None], nodes
            x[which] -= TURN * np.round(x[which] / TURN)

    def _pairs(self, newest: Int[np.ndarray, " nodes"]) -> tuple[np.ndarray, np.ndarray]:
        """List the steps from these nodes to their unknown neighbours in the grid, by the numbers of their ends."""
        which, end = neighbours(newest, self.shape)
        unknown = ~self.known[end]
        return newest[which[unknown]], end[unknown]

    def _keep(self, nodes: np.ndarray, found: StepResults, chosen: np.ndarray) -> None:
        """Keep the poses `chosen` of those `found` as the poses of `nodes`, which are known from then on."""
        for own, state in zip(self.states, found.states, strict=True):
            for part, new in zip(own, state, strict=True):
                part[..., nodes] = np.asarray(new)[..., chosen]
        self.known[nodes] = True
        self.residual[nodes] = np.asarray(found.residual)[chosen]
        self.stationary[nodes] = np.asarray(found.stationary)[chosen]
