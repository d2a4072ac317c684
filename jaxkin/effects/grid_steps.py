"""Step from pose to pose over a grid of inputs, past no singular pose.

A step from a closed pose to the inputs of a neighbour is predicted along the tangent and corrected. It is taken where
the corrected pose is near the prediction and no determinant of a block of the closure Jacobian has changed its sign
(as in `solve.continuation.step`); where it is not, once more in shorter steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.mechanism.drive_plan import DrivenLoopGroup
from jaxkin.solve.closure.closure import closure, scaled_geometry
from jaxkin.solve.closure.joint_coordinates import as_state
from jaxkin.solve.continuation.determinant_sign import determinant_ratio
from jaxkin.solve.continuation.input_slopes import input_slopes
from jaxkin.solve.continuation.step import MAX_DEVIATION, MAX_TRAVEL
from jaxkin.solve.correctors.levenberg_marquardt import levenberg_marquardt
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import CLOSED_ROUNDINGS, rounding_residual
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, difference, drive, retract

NodeInputs = Float[np.ndarray, "driven nodes"]

BATCH = 128
"""Steps that are taken together: a front on a grid of some thousand nodes has about as many."""
SHORT_STEPS = 8
"""Number of steps in place of one that is not taken."""
SHORTEST_STEPS = 64
"""Number of steps where these are not taken either, although the loops close: a neighbour beside a limit."""
SLACK = 1e-12
"""Deviation from a prediction that is always accepted, radians or characteristic lengths: rounding."""


class StepResults(NamedTuple):
    """What became of a batch of steps."""

    states: tuple[State, ...]
    taken: Bool[Array, " steps"]
    residual: Float[Array, " steps"]
    stationary: Bool[Array, " steps"]


class _Leg(NamedTuple):
    """The inputs from which and to which steps lead, for each loop group those that drive it, and how."""

    begin: tuple[Float[Array, "driven steps"], ...]
    end: tuple[Float[Array, "driven steps"], ...]
    count: int | Array
    """Steps in all."""
    to_end: bool | Array
    """Whether loops are closed also behind a step that is not taken."""


def neighbours(
    nodes: Int[np.ndarray, " nodes"], shape: tuple[int, int]
) -> tuple[Int[np.ndarray, " pairs"], Int[np.ndarray, " pairs"]]:
    """List the neighbours of nodes in a grid: for each which of the nodes it belongs to, and its own number."""
    row, column = np.unravel_index(nodes, shape)
    which, found = [], []
    for down, right in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        i, j = row + down, column + right
        inside = (i >= 0) & (i < shape[0]) & (j >= 0) & (j < shape[1])
        which.append(np.flatnonzero(inside))
        found.append(np.ravel_multi_index((i[inside], j[inside]), shape))
    return np.concatenate(which), np.concatenate(found)


class GridSteps:
    """Steps between closed poses of the loop groups that the inputs move."""

    def __init__(self, loop_groups: Sequence[DrivenLoopGroup], options: SolverOptions, max_residual: float) -> None:
        self.loop_groups, self.options, self.max_residual = loop_groups, options, max_residual
        self.systems = tuple(loop_group.system for loop_group in loop_groups)
        self.joints = tuple(loop_group.joints for loop_group in loop_groups)

    def states_of(self, displacements: Sequence[Float[Array | np.ndarray, "poses _"]]) -> list[list[np.ndarray]]:
        """Compute the states of the loop groups in closed poses, from the displacements of all joints there."""
        found = []
        for loop_group in self.loop_groups:
            system, joints = loop_group.system, loop_group.joints
            rows = jnp.stack([jnp.asarray(displacements[joint][:, k], float) for joint, k in loop_group.columns])
            state = as_state(system, joints.frames_1, joints.frames_2, rows)
            found.append([np.asarray(state.x / _scales(system, joints)), np.asarray(state.turns)])
        return found

    def follow(
        self, states: Sequence[Sequence[np.ndarray]], begin: NodeInputs, end: NodeInputs, count: int = 1
    ) -> StepResults:
        """Go from poses to others in `count` steps each, once more in shorter steps where one is not taken."""
        found = self.walk(states, begin, end, count)
        for pieces, most in ((SHORT_STEPS, np.inf), (SHORTEST_STEPS, self.max_residual)):
            (failed,) = np.nonzero(~np.asarray(found.taken) & (np.asarray(found.residual) <= most))
            if len(failed):
                chosen = [[part[..., failed] for part in state] for state in states]
                to_end = pieces < SHORTEST_STEPS
                again = self.walk(chosen, begin[:, failed], end[:, failed], pieces * count, to_end)
                found = _merged(found, again, failed)
        return found

    def walk(
        self,
        states: Sequence[Sequence[np.ndarray]],
        begin: NodeInputs,
        end: NodeInputs,
        count: int,
        to_end: bool = True,
    ) -> StepResults:
        """Walk from poses to others in `count` steps each, a batch at a time.

        Unless `to_end`, loops are not closed any more behind a step that is not taken: their residual tells nothing.
        """
        size, parts = begin.shape[1], []
        for first in range(0, size, BATCH):
            which = np.minimum(np.arange(first, first + BATCH), size - 1)
            chosen = tuple(State(*(jnp.asarray(part[..., which]) for part in state)) for state in states)
            ends = [
                tuple(jnp.asarray(each[np.array(e.inputs)][:, which]) for e in self.loop_groups)
                for each in (begin, end)
            ]
            leg = _Leg(ends[0], ends[1], count, to_end)
            found = _walk(self.systems, self.options.of_program, self.joints, chosen, leg, self.max_residual)
            parts.append(jax.tree.map(np.asarray, found))
        return jax.tree.map(lambda *each: np.concatenate(each, axis=-1)[..., :size], *parts)


def _merged(found: StepResults, again: StepResults, failed: np.ndarray) -> StepResults:
    """Replace the steps that failed by those that were tried again."""

    def put(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        one = np.array(one)
        one[..., failed] = other
        return one

    return jax.tree.map(put, found, again)


@partial(jax.jit, static_argnums=0)  # op by op, the geometry would be some hundred programs
def _scales(system: LoopSystem, joints: Joints) -> Float[Array, "columns 1"]:
    """Compute the factor of each column from its scaled coordinate to that of the mechanism."""
    return scaled_geometry(system, joints)[1]


@partial(whole_program, static=(0, 1))
def _walk(
    systems: tuple[LoopSystem, ...],
    options: SolverOptions,
    joints: tuple[Joints, ...],
    states: tuple[State, ...],
    leg: _Leg,
    max_residual: float | Array,
) -> StepResults:
    """Move the inputs of closed poses along a leg; all loop groups have to follow."""
    size = states[0].x.shape[-1]
    yes, zero = jnp.ones(size, bool), jnp.zeros(size)
    taken, square, stationary, found = yes, zero, yes, []
    for system, numbers, state, one, other in zip(systems, joints, states, leg.begin, leg.end, strict=True):
        geometry, lengths = scaled_geometry(system, numbers)
        own = lengths[np.array(system.driven, int)]
        problem = ClosureProblem(system, geometry, options)

        def step(number, carry, system=system, geometry=geometry, problem=problem, ends=(one / own, other / own)):
            """Move the inputs by step `number` of `leg.count`, and close the loops there."""
            state, taken, *_ = carry
            # shorter towards both ends, where a limit may be near: coordinates change as the root of the distance to it
            done, then = (0.5 - 0.5 * jnp.cos(jnp.pi * k / leg.count) for k in (number, number + 1))
            direction = (then - done) * (ends[1] - ends[0])
            before = closure(system, geometry, state)
            slope = input_slopes(system, state, before, direction)
            predicted = drive(system, retract(system, state, slope), ends[0] + then * (ends[1] - ends[0]))
            target = rounding_residual(state.x.dtype, CLOSED_ROUNDINGS)
            most = jnp.where(taken | leg.to_end, options.rescue_steps, 0)
            there = levenberg_marquardt(problem, predicted, most, target)
            travel = difference(predicted, state)
            ratio = determinant_ratio(before.jacobian, there.closure.jacobian, equation_blocks(system))
            good = (there.residual_norm <= max_residual) & (travel <= MAX_TRAVEL) & jnp.all(ratio > 0, axis=0)
            good &= difference(there.state, predicted) <= MAX_DEVIATION * travel + SLACK
            return there.state, taken & good, there.residual_norm, there.stationary

        state, taken, residual, still = lax.fori_loop(0, leg.count, step, (state, taken, zero, yes))
        square, stationary = square + residual**2, stationary & still
        found.append(state)
    return StepResults(tuple(found), taken, jnp.sqrt(square), stationary)
