"""Spread from the assembled pose over a grid of two inputs, from node to node, past no singular pose.

A step from a closed pose to the inputs of a neighbour is predicted along the tangent and corrected. It is taken where
the corrected pose is near the prediction and no determinant of a block of the closure Jacobian has changed its sign
(as in `solve.continuation.step`); where it is not, once more in shorter steps. Nodes to which no step leads get the
pose of least residual from a neighbour: closed, but not connected on this grid, or out of reach.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.trig import TURN
from jaxkin.mechanism.drive_plan import DrivenElement
from jaxkin.solve.closure.closure import closure, scaled_geometry
from jaxkin.solve.continuation.determinant_sign import determinant_ratio
from jaxkin.solve.continuation.step import MAX_DEVIATION, MAX_TRAVEL, input_slopes
from jaxkin.solve.correctors.levenberg_marquardt import levenberg_marquardt
from jaxkin.solve.correctors.newton import CLOSED_ROUNDINGS
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status, classify, rounding_residual
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, assembled, difference, drive, retract

BATCH = 128
"""Steps that are taken together: a front on a grid of some thousand nodes has about as many."""
SHORT_STEPS = 8
"""Number of steps to a neighbour where one step is not taken."""
SHORTEST_STEPS = 64
"""Number of steps where these are not taken either, although the loops close: a neighbour beside a limit."""
SLACK = 1e-12
"""Deviation from a prediction that is always accepted, radians or characteristic lengths: rounding."""

Inputs = Float[np.ndarray, "driven nodes"]


class Flooded(NamedTuple):
    """The poses of all nodes."""

    states: tuple[State, ...]
    """Of each structure element, with the nodes as the last axis."""
    status: Int[np.ndarray, " nodes"]
    residual: Float[np.ndarray, " nodes"]


class _Steps(NamedTuple):
    """What became of a batch of steps."""

    states: tuple[State, ...]
    taken: Bool[Array, " steps"]
    residual: Float[Array, " steps"]
    stationary: Bool[Array, " steps"]


def flood(
    elements: Sequence[DrivenElement],
    options: SolverOptions,
    inputs: Inputs,
    shape: tuple[int, int],
    max_residual: float,
) -> Flooded:
    """Find the poses of all nodes of a grid, the last input fastest; inputs are radians and lengths of the mechanism.

    It begins at the node that is nearest to the assembled pose, which is reached in a straight line.
    """
    if not elements:  # nothing is to be closed
        count = inputs.shape[1]
        return Flooded((), np.full(count, Status.CLOSED.value, np.int32), np.zeros(count))
    front = _Front(elements, options, inputs, shape, max_residual)
    start = int(np.argmin(np.linalg.norm(inputs, axis=0)))
    front.known[start] = True
    if front.begin(start):
        front.spread(_Wanted.FOLLOWED)
        front.followed = front.known.copy()
    front.spread(_Wanted.LEAST)
    # what is open may close from neighbours that were found later
    front.known = front.residual <= max_residual
    front.spread(_Wanted.CLOSED)
    stationary, followed = jnp.asarray(front.stationary), jnp.asarray(front.followed)
    status = np.asarray(classify(jnp.asarray(front.residual), stationary, followed, max_residual))
    return Flooded(tuple(State(*map(jnp.asarray, state)) for state in front.states), status, front.residual)


class _Wanted(Enum):
    """Which poses of neighbours are kept."""

    FOLLOWED = "closed poses to which the branch leads"
    CLOSED = "closed poses"
    LEAST = "the pose of least residual"


class _Front:
    """The nodes that are known so far, and their states."""

    def __init__(self, elements: Sequence[DrivenElement], options: SolverOptions, inputs, shape, max_residual) -> None:
        self.elements, self.options, self.inputs, self.shape = elements, options, inputs, shape
        self.max_residual = max_residual
        count = inputs.shape[1]
        self.systems = tuple(element.system for element in elements)
        self.joints = tuple(element.joints for element in elements)
        rest = [assembled(system, count, inputs.dtype) for system in self.systems]
        self.states = [[np.array(part) for part in state] for state in rest]
        self.known = np.zeros(count, bool)
        self.residual = np.full(count, np.inf)
        self.stationary = np.zeros(count, bool)
        self.followed = np.zeros(count, bool)
        """To which nodes the branch of the assembled pose leads."""

    def begin(self, start: int) -> bool:
        """Go from the assembled pose to the first node, in steps as long as those of the grid."""
        spacing = [np.ptp(row) / max(max(self.shape) - 1, 1) for row in self.inputs]
        steps = max(
            np.ceil(np.abs(row[start]) / max(step, 1e-3)) for row, step in zip(self.inputs, spacing, strict=True)
        )
        rest = [[part[..., [start]] for part in state] for state in self.states]
        found = self._walked(
            rest, 0.0 * self.inputs[:, [start]], self.inputs[:, [start]], SHORT_STEPS * max(int(steps), 1)
        )
        self._keep(np.array([start]), found, np.array([0]))
        return bool(found.taken[0])

    def spread(self, wanted: _Wanted) -> None:
        """Step from known nodes to their unknown neighbours, and on from these, until no more poses are found."""
        newest = np.flatnonzero(self.known)
        while len(newest):
            begin, end = self._pairs(newest)
            if not len(end):
                return
            found = self._between(begin, end, 1)
            if wanted is _Wanted.FOLLOWED:
                for count, most in ((SHORT_STEPS, np.inf), (SHORTEST_STEPS, self.max_residual)):
                    (failed,) = np.nonzero(~np.asarray(found.taken) & (np.asarray(found.residual) <= most))
                    if len(failed):
                        found = _merged(found, self._between(begin[failed], end[failed], count), failed)
            residual = np.nan_to_num(np.asarray(found.residual), nan=np.inf)
            good = {
                _Wanted.FOLLOWED: np.asarray(found.taken),
                _Wanted.CLOSED: residual <= self.max_residual,
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
        for system, (x, _) in zip(self.systems, self.states, strict=True):
            kept = {*system.driven, *(column for coupling in system.couplings for column in coupling)}
            for movement, _, first, _ in (each for chain in system.chains for each in chain):
                if MOVEMENTS[movement].has_pitch:
                    kept.add(first)
            turning = [c for c, length in enumerate(system.is_length) if not length and c not in kept]
            which = np.array(turning, int)[:, None], nodes
            x[which] -= TURN * np.round(x[which] / TURN)

    def _pairs(self, newest: Int[np.ndarray, " nodes"]) -> tuple[np.ndarray, np.ndarray]:
        """The steps from these nodes to their unknown neighbours in the grid: numbers of their ends."""
        row, column = np.unravel_index(newest, self.shape)
        begin, end = [], []
        for down, right in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            i, j = row + down, column + right
            inside = (i >= 0) & (i < self.shape[0]) & (j >= 0) & (j < self.shape[1])
            there = np.ravel_multi_index((i[inside], j[inside]), self.shape)
            begin.append(newest[inside][~self.known[there]])
            end.append(there[~self.known[there]])
        return np.concatenate(begin), np.concatenate(end)

    def _between(self, begin: np.ndarray, end: np.ndarray, count: int) -> _Steps:
        states = [[part[..., begin] for part in state] for state in self.states]
        return self._walked(states, self.inputs[:, begin], self.inputs[:, end], count)

    def _walked(self, states: Sequence[Sequence[np.ndarray]], begin: Inputs, end: Inputs, count: int) -> _Steps:
        """Walk from poses to others in `count` steps each, a batch at a time."""
        size, parts = begin.shape[1], []
        for first in range(0, size, BATCH):
            which = np.minimum(np.arange(first, first + BATCH), size - 1)
            chosen = tuple(State(*(jnp.asarray(part[..., which]) for part in state)) for state in states)
            rows = [
                tuple(jnp.asarray(each[np.array(e.inputs)][:, which]) for e in self.elements) for each in (begin, end)
            ]
            found = _walk(self.systems, self.options.of_program, self.joints, chosen, *rows, count, self.max_residual)
            parts.append(jax.tree.map(np.asarray, found))
        return jax.tree.map(lambda *each: np.concatenate(each, axis=-1)[..., :size], *parts)

    def _keep(self, nodes: np.ndarray, found: _Steps, chosen: np.ndarray) -> None:
        for own, state in zip(self.states, found.states, strict=True):
            for part, new in zip(own, state, strict=True):
                part[..., nodes] = np.asarray(new)[..., chosen]
        self.known[nodes] = True
        self.residual[nodes] = np.asarray(found.residual)[chosen]
        self.stationary[nodes] = np.asarray(found.stationary)[chosen]


def _merged(found: _Steps, again: _Steps, failed: np.ndarray) -> _Steps:
    """Replace the steps that failed by those that were tried again."""

    def put(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        one = np.array(one)
        one[..., failed] = other
        return one

    return jax.tree.map(put, found, again)


@partial(jax.jit, static_argnums=(0, 1))
def _walk(
    systems: tuple[LoopSystem, ...],
    options: SolverOptions,
    joints: tuple[Joints, ...],
    states: tuple[State, ...],
    begin: tuple[Float[Array, "driven steps"], ...],
    end: tuple[Float[Array, "driven steps"], ...],
    count: int | Array,
    max_residual: float | Array,
) -> _Steps:
    """Move the inputs of closed poses from `begin` to `end` in so many steps; all structure elements have to follow."""
    size = states[0].x.shape[-1]
    yes, zero = jnp.ones(size, bool), jnp.zeros(size)
    taken, square, stationary, found = yes, zero, yes, []
    for system, numbers, state, one, other in zip(systems, joints, states, begin, end, strict=True):
        geometry, lengths = scaled_geometry(system, numbers)
        own = lengths[np.array(system.driven, int)]
        problem = ClosureProblem(system, geometry, options)

        def step(number, carry, system=system, geometry=geometry, problem=problem, ends=(one / own, other / own)):
            state, taken, *_ = carry
            # shorter towards both ends, where a limit may be near: coordinates change as the root of the distance to it
            done, then = (0.5 - 0.5 * jnp.cos(jnp.pi * k / count) for k in (number, number + 1))
            direction = (then - done) * (ends[1] - ends[0])
            before = closure(system, geometry, state)
            slope = input_slopes(system, state, before, direction)
            predicted = drive(system, retract(system, state, slope), ends[0] + then * (ends[1] - ends[0]))
            target = rounding_residual(state.x.dtype, CLOSED_ROUNDINGS)
            there = levenberg_marquardt(problem, predicted, options.rescue_steps, target)
            travel = difference(predicted, state)
            ratio = determinant_ratio(before.jacobian, there.closure.jacobian, equation_blocks(system))
            good = (there.residual_norm <= max_residual) & (travel <= MAX_TRAVEL) & jnp.all(ratio > 0, axis=0)
            good &= difference(there.state, predicted) <= MAX_DEVIATION * travel + SLACK
            return there.state, taken & good, there.residual_norm, there.stationary

        state, taken, residual, still = lax.fori_loop(0, count, step, (state, taken, zero, yes))
        square, stationary = square + residual**2, stationary & still
        found.append(state)
    return _Steps(tuple(found), taken, jnp.sqrt(square), stationary)
