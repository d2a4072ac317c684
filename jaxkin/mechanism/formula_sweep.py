"""The sweep of a drive whose loop groups all have formulas: one program from the inputs to all displacements.

The program is compiled for a single pose and for `CHUNK` of them, and serves ranges of any length: short ones are
padded, long ones cut into chunks, and the results are cut to length and joined on the host.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import cache, partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._traced import traced
from jaxkin.linkage.coordinates import Given
from jaxkin.mechanism.collect import Collected, DisplacementSources, collect
from jaxkin.solve.closed_form.assembled_axes import Axes
from jaxkin.solve.closed_form.line import Line
from jaxkin.solve.closed_form.range_by_formula import find_poses_by_formula, joint_displacements, line_of
from jaxkin.solve.execution.compiler import count_trace, jit_options
from jaxkin.solve.execution.known_numbers import Outcome
from jaxkin.solve.status import ClosureTolerance
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import turning

CHUNK = 384
"""Poses of one call of the program, enough for one a degree. A call costs as much as some 200 poses of a four-bar."""
OFTEN = 3
"""Calls with the same number of poses from which on a program of its own joins and cuts their results. To copy them on
the host takes 0.1 ms longer, to compile that program some 40."""


class ElementNumbers(NamedTuple):
    """The numbers of a loop group."""

    axes: Axes
    joints: Joints | None
    """Only where balls need them."""


class FormulaSweep:
    """What of a sweep by formulas does not depend on the inputs: static descriptions, and numbers on the device."""

    def __init__(
        self,
        layout: DisplacementSources,
        systems: tuple[LoopSystem, ...],
        inputs: tuple[int, ...],
        axes: Sequence[Axes],
        turns: Sequence[Line | None],
        joints: Sequence[Joints],
    ):
        """`inputs` has for each loop group the number of its input, `turns` the line of one that turns."""
        self.layout, self.systems, self.inputs, self.axes = layout, systems, inputs, tuple(axes)
        needed = [given if system.balls else None for system, given in zip(systems, joints, strict=True)]
        self.numbers = jax.device_put([ElementNumbers(*both) for both in zip(axes, needed, strict=True)])
        self.may_close = all(turn is None or bool(turn.begins) for turn in turns)
        self.turns = jax.device_put(turns)
        self.tolerances: dict[int, tuple[ClosureTolerance, ClosureTolerance]] = {}
        self.program = _program(layout, systems, inputs)
        self.balls = tuple(
            columns[column]
            for system, columns in zip(systems, layout.columns, strict=True)
            for column in np.flatnonzero(turning(system))
        )
        """(joint, coordinate) of the angles of balls, which are unwrapped from pose to pose."""

    def solve(
        self, values: tuple[Given, ...], finite: Bool[np.ndarray, " poses"] | None, tolerance: ClosureTolerance
    ) -> Collected | None:
        """Find the poses for finite known `values`; None where the formulas do not prove that all of them are closed.

        Poses are NaN where they are not `finite`: their values stand in for others.
        """
        if not self.may_close:
            return None
        lines = [line or self._line(number, values) for number, line in enumerate(self.turns)]
        if id(tolerance) not in self.tolerances:
            self.tolerances[id(tolerance)] = tolerance, jax.device_put(tolerance)
        _, on_device = self.tolerances[id(tolerance)]
        poses = len(values[0])
        length = 1 if poses == 1 else CHUNK
        chunks, proven = [], []
        for begin in range(0, poses, length):
            rows = _padded(values, begin, length)
            mask = None if finite is None else _padded([finite], begin, length)[0]
            found, sure = self.program(self.numbers, lines, rows, mask, on_device)
            chunks.append(found)
            proven.append(sure)
        # inside a function that is being traced, what a program returns is traced, though it is given numbers
        if traced(proven) or not all(proven):
            return None
        return self._joined(chunks, poses)

    def _line(self, number: int, values: tuple[Given, ...]) -> Line:
        """Compute the line of an input that is a displacement."""
        return line_of(self.systems[number], self.axes[number], np.asarray(values[self.inputs[number]])[None])

    def _joined(self, chunks: list[Collected], poses: int) -> Collected:
        """Join the chunks, and cut the last one to length."""
        if len(chunks) == 1 and len(chunks[0].status) == poses:
            return chunks[0]
        balls = self.balls if len(chunks) > 1 else ()
        _asked[id(self.program), poses] += 1
        if _asked[id(self.program), poses] < OFTEN:
            return jax.tree.map(jnp.asarray, _join(jax.tree.map(np.asarray, chunks), poses, balls, np))
        return _join_program(chunks, poses, balls)


def _padded(rows: Sequence[Any], begin: int, length: int) -> np.ndarray:
    """Stack so many entries of some rows from `begin` on, the last one repeated."""
    stop = min(begin + length, len(rows[0]))
    padded = np.empty((len(rows), length), rows[0].dtype)
    for whole, row in zip(padded, rows, strict=True):
        whole[: stop - begin], whole[stop - begin :] = row[begin:stop], row[stop - 1]
    return padded


@cache
def _program(layout: DisplacementSources, systems: tuple[LoopSystem, ...], inputs: tuple[int, ...]):
    """Make the program: poses, and whether all are closed without doubt."""

    @partial(jax.jit, **jit_options())
    def program(numbers, lines, values: Float[Array, "driven chunk"], finite, tolerance: ClosureTolerance):
        count_trace()
        solutions, proven = [], jnp.ones((), bool)
        for system, own, line, which in zip(systems, numbers, lines, inputs, strict=True):
            found = find_poses_by_formula(system, own.axes, line, values[which][None], tolerance)
            displaced = joint_displacements(system, own.joints, own.axes, found.rows)
            solutions.append((displaced, Outcome(found.status, found.residual_norm)))
            proven &= found.proven
        return collect(layout, tuple(values), finite, solutions), proven

    return program


_asked: Counter[tuple[int, int]] = Counter()
"""How often the results of a program (by its identity: they live as long as the process) had a number of poses."""


def _join(chunks: list[Collected], poses: int, balls: Sequence[tuple[int, int]], xp: Any = jnp) -> Collected:
    """Join chunks by `xp`, jax.numpy or numpy, and cut them to length; angles of balls are unwrapped across them."""
    joined = jax.tree.map(lambda one, *more: (xp.concatenate([one, *more]) if more else one)[:poses], *chunks)
    moved = dict(joined.moved)
    for joint in {joint for joint, _ in balls}:
        columns = [
            xp.unwrap(row) if (joint, coordinate) in balls else row for coordinate, row in enumerate(moved[joint].T)
        ]
        moved[joint] = xp.stack(columns, axis=1)
    return joined._replace(moved=moved)


_join_program = jax.jit(_join, static_argnums=(1, 2))
