"""The sweep of a drive whose loop groups all have formulas: one program from the inputs to all displacements.

The program is compiled for a single pose, for `CHUNK` of them and, for long ranges, for `LONG_CHUNK`, and serves ranges
of any length: they are cut into chunks, of `DEVICE_GROUP` poses on a device that is no CPU, and padded. The chunks of
long ranges are shared by the cores. What is found for the chunks is joined, cut to length and collected by joint
afterwards.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._traced import traced
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import InputValues
from jaxkin.mechanism.collect import Collected, DisplacementSources
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.formula_displacements import joint_displacements
from jaxkin.solve.closed_form.input_line import InputLine, PassedLine, passed_range
from jaxkin.solve.closed_form.range_by_formula import find_poses_by_formula, line_of
from jaxkin.solve.device import group_for_device, on_cpu
from jaxkin.solve.execution.compiler import count_trace, jit_options
from jaxkin.solve.execution.cores import available_cores, continue_ball_angles, in_threads
from jaxkin.solve.status import ClosureTolerance, Status
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem

CHUNK = 384
"""Poses of one call of the program, enough for one a degree. A call costs a CPU as much as some 200 poses of a
four-bar."""
LONG_CHUNK = 4096
"""Poses of one call for long ranges: 100,000 poses of a four-bar take half as long as in chunks of `CHUNK`, on one
core, and as long in chunks of 16,384."""
LONG_RANGE = 2 * LONG_CHUNK
"""Least number of poses of a long range: fewer take less time than to compile a program for `LONG_CHUNK` saves."""
OFTEN = 3
"""Calls with the same number of poses from which on a program of its own collects what is found by joint. To do that on
the host takes 0.1 ms longer, to trace and compile that program some 90 of the processor."""


class LoopGroupNumbers(NamedTuple):
    """The numbers of a loop group that its formulas need, on the device."""

    axes: AssembledAxes
    joints: Joints | None
    """Only where balls need them."""


class _KnownLine(NamedTuple):
    """A line of known numbers, and the range of inputs in which every pose that closes is on the branch."""

    line: InputLine
    passed: PassedLine
    """What is asked of the line within that range."""
    lowest: float
    """Radians or characteristic lengths."""
    highest: float

    def on_device(self) -> _KnownLine:
        """Copy to the device what programs are given."""
        return self._replace(line=jax.device_put(self.line), passed=jax.device_put(self.passed))

    def for_inputs(self, values: np.ndarray) -> InputLine | PassedLine:
        """Choose what the program is given for inputs in radians or characteristic lengths."""
        endless = self.lowest == -np.inf
        return self.passed if endless or (self.lowest <= values.min() and values.max() <= self.highest) else self.line


class _Found(NamedTuple):
    """What the program finds for the poses of a chunk."""

    displaced: list[Float[Array, "columns chunk"]]
    """Displacements of the columns of each loop group, radians and lengths of the mechanism."""
    residual: Float[Array, " chunk"]
    """Closure residual over all loop groups."""
    proven: Bool[Array, ""]
    """Whether all poses are closed without doubt; where they are not, what is found is of no use."""


class FormulaSweep:
    """What of a sweep by formulas does not depend on the inputs: static descriptions, and numbers on the device."""

    def __init__(
        self,
        sources: DisplacementSources,
        systems: tuple[LoopSystem, ...],
        inputs: tuple[int, ...],
        axes: Sequence[AssembledAxes],
        turn_lines: Sequence[InputLine | None],
        joints: Sequence[Joints],
    ):
        """`inputs` are for each loop group the number of its input, `turn_lines` its line of a full turn, or None."""
        self.sources, self.systems, self.inputs, self.axes = sources, systems, inputs, tuple(axes)
        needed = [given if system.balls else None for system, given in zip(systems, joints, strict=True)]
        self.numbers = jax.device_put([LoopGroupNumbers(*both) for both in zip(axes, needed, strict=True)])
        self.may_close = all(turn is None or bool(turn.begins) for turn in turn_lines)
        self.turn_lines = [
            turn and _known_line(system, turn).on_device() for system, turn in zip(systems, turn_lines, strict=True)
        ]
        self.last_tolerance: tuple[ClosureTolerance, ClosureTolerance] | None = None
        """The tolerance that was asked for last, and the same on the device."""
        self.program, self.single = _program(systems, inputs), _single(sources, systems, inputs)

    def solve(
        self,
        values: tuple[InputValues, ...],
        finite: Bool[np.ndarray, " poses"] | None,
        tolerance: ClosureTolerance,
        cores: int | None,
    ) -> Collected | None:
        """Find the poses for finite known `values`; None where the formulas do not prove that all of them are closed.

        Poses are NaN where they are not `finite`: their values stand in for others. Long ranges are shared by so many
        `cores`, by all where it is None.
        """
        if not self.may_close:
            return None
        rows = np.stack(values)
        lines = [self._line(number, rows[which]) for number, which in enumerate(self.inputs)]
        asked = self.last_tolerance
        if asked is None or asked[0] is not tolerance:
            asked = self.last_tolerance = tolerance, jax.device_put(tolerance)
        _, on_device = asked
        poses = rows.shape[1]
        if poses == 1:
            collected, *proven = self.single(self.numbers, lines, rows, finite, on_device)
        else:
            long = _is_long(poses)
            if long and not all(isinstance(line, PassedLine) for line in lines):
                return None  # of many poses near a limit or beyond it some are hardly proven
            length = CHUNK if poses <= CHUNK else group_for_device(LONG_CHUNK if long else CHUNK)

            def found(starts: Sequence[int]) -> list[_Found]:
                return [self.program(self.numbers, lines, _chunk(rows, begin, length), on_device) for begin in starts]

            starts = range(0, poses, length)
            chunks = _on_cores(found, starts, cores or available_cores()) if long else found(starts)
            proven = [chunk.proven for chunk in chunks]
            # before it is known whether all are closed: the processor is at it while Python waits for that
            collected = None if traced(proven) else self._collected(chunks, rows, finite)
        # inside a function that is being traced, what a program returns is traced, though it is given numbers
        return None if traced(proven) or not all(map(np.asarray, proven)) else collected

    def passes(self, inputs: Mapping[str, Array | np.ndarray]) -> bool:
        """Tell whether all inputs are angles, in radians, within the range that the motion passes without doubt.

        No pose is singular then: a range that does not begin is the assembled pose alone, which may be.
        """
        rows = [np.asarray(row) for row in inputs.values()]
        return all(
            turn is not None
            and turn.lowest < turn.highest
            and rows[which].size > 0
            and turn.for_inputs(rows[which]) is turn.passed
            for turn, which in zip(self.turn_lines, self.inputs, strict=True)
        )

    def _line(self, number: int, values: np.ndarray) -> InputLine | PassedLine:
        """Choose the line of the input of a loop group: the one that is kept, or that of a displacement."""
        if (turn := self.turn_lines[number]) is not None:
            return turn.for_inputs(values)
        system, axes = self.systems[number], self.axes[number]
        return _known_line(system, line_of(system, axes, values[None])).for_inputs(values / axes.length)

    def _collected(self, chunks: list[_Found], rows: np.ndarray, finite: np.ndarray | None) -> Collected:
        """Collect what was found for the chunks: by a program, or on the host where so many poses are rare, or long."""
        several = self.systems if len(chunks) > 1 else None
        found = [(chunk.displaced, chunk.residual) for chunk in chunks]
        _uses[id(self.program), rows.shape[1]] += 1
        if _is_long(rows.shape[1]) or _uses[id(self.program), rows.shape[1]] < OFTEN:
            collected = _collect_chunks(self.sources, several, jax.tree.map(np.asarray, found), rows, finite, np)
            return jax.device_put(collected)
        return _collect_program(self.sources, several, found, rows, finite)


def _known_line(system: LoopSystem, line: InputLine) -> _KnownLine:
    """Find the range of inputs that the motion passes without doubt along a line."""
    return _KnownLine(line, PassedLine(line.signs, line.windings), *passed_range(system, line))


def _is_long(poses: int) -> bool:
    """Tell whether a range is cut into long chunks, which cores share; other devices take all poses at once."""
    return poses >= LONG_RANGE and on_cpu()


def _on_cores(found: Callable[[Sequence[int]], list[_Found]], starts: Sequence[int], cores: int) -> list[_Found]:
    """Find the chunks that begin at `starts` on several cores, behind the first one, for which the program is
    compiled."""
    share = max(1, -(-(len(starts) - 1) // cores))
    shares = [starts[:1], *(starts[begin : begin + share] for begin in range(1, len(starts), share))]
    return [chunk for own in in_threads(found, shares, cores) for chunk in own]


def _chunk(rows: np.ndarray, begin: int, length: int) -> np.ndarray:
    """Cut `length` poses out of the inputs from `begin` on, the last pose repeated."""
    chunk = rows[:, begin : begin + length]
    padded = np.empty((len(rows), length), rows.dtype)
    padded[:, : chunk.shape[1]], padded[:, chunk.shape[1] :] = chunk, chunk[:, -1:]
    return padded


def _find(
    systems: tuple[LoopSystem, ...],
    which: tuple[int, ...],
    numbers: Sequence[LoopGroupNumbers],
    lines: Sequence[InputLine | PassedLine],
    rows: Float[Array, "driven poses"],
    tolerance: ClosureTolerance,
) -> _Found:
    """Find the poses of all loop groups."""
    count_trace()
    displaced, square, proven = [], jnp.zeros(()), jnp.ones((), bool)
    for system, own, line, row in zip(systems, numbers, lines, which, strict=True):
        found = find_poses_by_formula(system, own.axes, line, rows[row][None], tolerance)
        displaced.append(joint_displacements(system, own.joints, own.axes, found.rows))
        square = square + found.residual_norm**2
        proven &= found.proven
    return _Found(displaced, jnp.sqrt(square), proven)


def _collect_chunks(
    sources: DisplacementSources,
    systems: tuple[LoopSystem, ...] | None,
    found: Sequence[tuple[Sequence[Array | np.ndarray], Array | np.ndarray]],
    rows: Float[Array | np.ndarray, "driven poses"],
    finite: Bool[Array | np.ndarray, " poses"] | None,
    xp: Any = jnp,
) -> Collected:
    """Join what was found for chunks of poses, cut it to length, and collect it by joint; all poses are closed.

    It is to formulas what `collect` is to the general solver.

    Where `systems` are given, angles of their balls go on from chunk to chunk. Poses that are not `finite` become NaN.
    `xp` is jax.numpy or numpy.
    """
    poses = rows.shape[1]

    def whole(*pieces):
        return xp.concatenate(pieces, axis=-1)[..., :poses]

    displaced, residuals = zip(*found, strict=True)
    of_groups = list(zip(*displaced, strict=True))  # the chunks of each loop group
    if systems:
        of_groups = [continue_ball_angles(system, own, xp) for system, own in zip(systems, of_groups, strict=True)]
    residual = whole(*residuals)
    nothing = xp.zeros((poses,), rows.dtype)
    place: dict[JointCoordinate, Any] = {}
    for columns, own in zip(sources.columns, of_groups, strict=True):
        place |= dict(zip(columns, whole(*own), strict=True))
    place |= dict(zip(sources.driven, rows, strict=True))  # inputs as they were given

    def finished(row, otherwise: float | int = np.nan):
        return row if finite is None else xp.where(finite if row.ndim == 1 else finite[:, None], row, otherwise)

    def beside_each_other(rows):
        return rows[0][:, None] if len(rows) == 1 else xp.stack(rows, axis=1)  # in NumPy a stack is a copy

    moved = {
        joint: finished(beside_each_other([place.get((joint, k), nothing) for k in range(sources.freedoms[joint])]))
        for joint in sorted({joint for joint, _ in place})
    }
    resting = {
        freedoms: finished(xp.zeros((poses, freedoms), rows.dtype))
        for freedoms in sorted({f for joint, f in enumerate(sources.freedoms) if joint not in moved})
    }
    status = finished(xp.full(poses, Status.CLOSED.value, np.int32), Status.NONFINITE.value)
    return Collected(tuple(rows), moved, resting, status, finished(residual))


_uses: Counter[tuple[int, int]] = Counter()
"""How often the results of a program (by its identity: they live as long as the process) had a number of poses."""
_collect_program = jax.jit(_collect_chunks, static_argnums=(0, 1))


@cache
def _program(systems: tuple[LoopSystem, ...], which: tuple[int, ...]):
    """Make the program of a chunk of poses, for inputs of which each loop group has one."""
    return jax.jit(partial(_find, systems, which), **jit_options())


@cache
def _single(sources: DisplacementSources, systems: tuple[LoopSystem, ...], which: tuple[int, ...]):
    """Make the program of a single pose, which also collects it by joint."""

    def single(numbers, lines, rows, finite, tolerance: ClosureTolerance) -> tuple[Collected, Array]:
        found = _find(systems, which, numbers, lines, rows, tolerance)
        return _collect_chunks(sources, None, [(found.displaced, found.residual)], rows, finite), found.proven

    return jax.jit(single, **jit_options())
