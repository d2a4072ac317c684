"""A range of a single input by formulas, with the proof that the motion leads from the assembled pose to its poses.

The formulas give a pose for every input, on the branch of the assembled pose, but they do not know whether the input
can be moved there. It can if all discriminants stay positive up to there (`branch_certificate.py`), for which they are
computed at nodes. Angles are unwrapped along the nodes, too.

| status | when |
|---|---|
| CLOSED | the loops close, and every interval from the assembled pose to the pose is passed |
| UNREACHABLE | the loops do not close at this input |
| JUMPED | the loops close; between the assembled pose and the pose they do not |
| STALLED | the loops close; whether the motion passes to them is in doubt: a change point, or nearly a limit |
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.arithmetic import namespace
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.branch_certificate import at_intervals, certify_line, certify_poses
from jaxkin.solve.closed_form.complex_numbers import Complex
from jaxkin.solve.closed_form.coordinate import REST, FormulaCoordinates
from jaxkin.solve.closed_form.input_line import (
    NODES,
    InputLine,
    PassedLine,
    Windings,
    ends,
    line_and_poses,
    nodes_to_either_side,
    principal_angles,
    turn_nodes,
    unknown_angles,
)
from jaxkin.solve.closed_form.solve_groups import Solved, residual_norm, solve_once
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.range.groups import in_groups
from jaxkin.solve.status import (
    CLOSED_ROUNDINGS,
    ClosureTolerance,
    Status,
    classify,
    rounding_residual,
)
from jaxkin.solve.system.loop_system import LoopSystem

LONG_RANGE = 2**14
"""Number of poses above which poses, and their derivatives, are computed in groups on CPUs: what that needs of 100,000
poses is read from memory in place of the cache, which takes two to three times as long."""
POSE_GROUP = 4096
"""Number of poses of such a group."""


class FormulaPoses(NamedTuple):
    """What the formulas say about a range, without derivatives."""

    rows: tuple[Float[Array, " poses"], ...]
    """The coordinates of every column, radians and characteristic lengths; zero for free balls."""
    turns: dict[int, Complex]
    """Of a planar system the coordinates that turn, by column, as complex numbers of absolute value 1."""
    status: Int[Array, " poses"]
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""
    signs: Float[Array, "groups 1"]
    """The sign of the branch of every group."""
    proven: Bool[Array, ""]
    """Whether all poses are CLOSED, to rounding."""


def line_of(system: LoopSystem, axes: AssembledAxes, inputs: Float[Array | np.ndarray, "1 poses"]) -> InputLine:
    """Compute the line on which inputs are judged: a full turn, if the input is an angle, else the range of the inputs.

    `inputs` are in radians or lengths of the mechanism.
    """
    return line_and_poses(system, axes, _nodes(system, scaled_inputs(system, axes, inputs)[0]), np.zeros(0))[0]


def _nodes(system: LoopSystem, values: Float[Array | np.ndarray, " poses"]) -> Float[Array | np.ndarray, " nodes"]:
    """Space the nodes of the line for some inputs, radians or characteristic lengths."""
    if system.periodic:
        return turn_nodes()
    return nodes_to_either_side(namespace(values).max(abs(values), initial=0.0))


def find_poses_and_line(
    system: LoopSystem, axes: AssembledAxes, inputs: Float[Array, "1 poses"], tolerance: ClosureTolerance
) -> FormulaPoses:
    """Find the poses, as `find_poses_by_formula`, of axes whose line is not known yet."""
    axes, inputs = lax.stop_gradient((axes, inputs))
    values = scaled_inputs(system, axes, inputs)[0]
    nodes = _nodes(system, values)
    if len(values) > LONG_RANGE:
        line = line_and_poses(system, axes, nodes, jnp.zeros(0))[0]
        return _on_line(system, axes, line, values, tolerance)
    line, solved = line_and_poses(system, axes, nodes, values)
    return _judged(system, axes, line, values, solved, tolerance)


def find_poses_by_formula(
    system: LoopSystem,
    axes: AssembledAxes,
    line: InputLine | PassedLine,
    inputs: Float[Array, "1 poses"],
    tolerance: ClosureTolerance,
) -> FormulaPoses:
    """Find the poses for finite inputs in radians or lengths of the mechanism, of a system that is all formulas.

    On a `PassedLine` no pose needs a certificate. Nothing that is found has a derivative; `displacements_by_formula`
    (`formula_displacements`) has.
    """
    axes, line, inputs = lax.stop_gradient((axes, line, inputs))
    values = scaled_inputs(system, axes, inputs)[0]
    return _on_line(system, axes, line, values, tolerance)


def _on_line(
    system: LoopSystem,
    axes: AssembledAxes,
    line: InputLine | PassedLine,
    values: Float[Array, " poses"],
    tolerance: ClosureTolerance,
) -> FormulaPoses:
    """Solve and judge poses of a line, long ranges in groups."""

    def found(values: Float[Array, " group"]) -> FormulaPoses:
        solved = solve_once(system, axes, jnp.asarray(line.signs), values[None])
        return _judged(system, axes, line, values, solved, tolerance)

    def of_group(values: Float[Array, " group"]):
        rows, turns, status, residual, _, proven = found(values)
        return rows, turns, status, residual, jnp.broadcast_to(proven, values.shape)

    if len(values) <= LONG_RANGE:
        return found(values)
    rows, turns, status, residual, proven = in_groups(of_group, values, POSE_GROUP)
    return FormulaPoses(rows, turns, status, residual, jnp.asarray(line.signs), jnp.all(proven))


def _judged(
    system: LoopSystem,
    axes: AssembledAxes,
    line: InputLine | PassedLine,
    values: Float[Array, " poses"],
    solved: Solved,
    tolerance: ClosureTolerance,
) -> FormulaPoses:
    """Judge solved poses by the line: their statuses, and angles with their full turns."""
    if isinstance(line, PassedLine):
        expected = _at_nodes(system, line.windings, values).expected(line.windings)
        passed = known = jnp.ones(values.shape, bool)
    else:
        expected, passed, crossed = _reached(system, line, values, solved.discriminants)
        passed, known = passed & line.begins, line.begins & (passed | crossed)
    angles: dict[int, Array] = {}
    if columns := unknown_angles(system):
        principal = principal_angles(solved, columns)
        angles = dict(zip(columns, principal + TURN * jnp.round((expected - principal) / TURN), strict=True))
    found = FoundAngles(angles, passed, known)
    return judge(system, axes, jnp.asarray(line.signs), found, solved.coordinates, tolerance)


class FoundAngles(NamedTuple):
    """What is known of solved poses beside their turns: angles, and whether the motion leads there."""

    angles: Mapping[int, Float[Array, " poses"]]
    """All unknown angles by column, with their full turns, radians."""
    passed: Bool[Array, " poses"]
    """To which poses the motion leads."""
    known: Bool[Array | np.ndarray, " poses"]
    """Of which poses that is known, whether it does or there surely is a limit before them."""


def judge(
    system: LoopSystem,
    axes: AssembledAxes,
    signs: Float[Array, "groups 1"],
    found: FoundAngles,
    coordinates: FormulaCoordinates,
    tolerance: ClosureTolerance,
) -> FormulaPoses:
    """Find the statuses of solved poses by their residuals too, and put their coordinates together."""
    rows = [found.angles.get(k, REST.value if each is None else each.value) for k, each in enumerate(coordinates)]
    residual = jnp.asarray(residual_norm(system, axes, coordinates))
    closes = residual <= tolerance.max_residual
    status = classify(residual, ~closes, found.passed, tolerance.max_residual)
    status = jnp.where(closes & ~found.known, Status.STALLED.value, status)
    sharp = jnp.maximum(rounding_residual(residual.dtype, CLOSED_ROUNDINGS), tolerance.target_residual)
    proven = jnp.all(found.passed & (residual <= jnp.minimum(tolerance.max_residual, sharp)))
    each = {k: own for k, own in enumerate(coordinates) if system.planar and not system.is_length[k]}
    turns = {k: (REST if own is None else own).turn for k, own in each.items()}
    turns = jax.tree.map(lambda part: jnp.broadcast_to(part, residual.shape), turns)
    return FormulaPoses(tuple(map(jnp.asarray, rows)), turns, status, residual, signs, proven)


class _AtNodes(NamedTuple):
    """Where inputs are among the nodes of a line, and the unknown angles there."""

    turns: Float[Array, " poses"]
    """Number of full turns by which an input is beyond the turn of the line; 0 where the input is a length."""
    interval: Int[Array, " poses"]
    """Number of the interval between two nodes in which the input is."""
    distance: Float[Array, " poses"]
    """Distance of the input from the lower node of its interval, over the spacing of the nodes."""
    nearby: Float[Array, "angles poses"]
    """The unknown angles at the lower node, unwrapped along the line."""

    def expected(self, windings: Windings) -> Float[Array, "angles poses"]:
        """Unwrap the nearby angles along the motion from the assembled pose, which passes the line."""
        start, end = jnp.asarray(windings.begun)[:, None], jnp.asarray(windings.ended)[:, None]
        return self.nearby - start + (end - start) * self.turns


def _at_nodes(system: LoopSystem, windings: Windings, values: Float[Array, " poses"]) -> _AtNodes:
    """Find where inputs are among the nodes of a line, and look up the unknown angles there."""
    turns = jnp.floor(values / TURN) if system.periodic else jnp.zeros_like(values)
    position = (values - TURN * turns - windings.begin) / windings.spacing
    interval = jnp.clip(jnp.floor(position), 0, NODES - 2)
    distance, interval = position - interval, interval.astype(jnp.int32)
    # of a known line all angles are looked up at once; of traced ones, which stem from long formulas, each by itself
    if isinstance(windings.angles, list):
        nearby = [at_intervals(row, interval) for row in windings.angles]
        return _AtNodes(turns, interval, distance, jnp.stack(nearby) if nearby else jnp.zeros((0, *values.shape)))
    return _AtNodes(turns, interval, distance, jnp.asarray(windings.angles).at[:, interval].get(mode="clip"))


def _reached(
    system: LoopSystem, line: InputLine, values: Float[Array, " poses"], discriminants: Sequence[Array | np.ndarray]
) -> tuple[Float[Array, "angles poses"], Bool[Array, " poses"], Bool[Array, " poses"]]:
    """Judge the motion from the assembled pose to poses, upwards and downwards.

    Returns unknown angles nearby, with their full turns; to which poses the motion passes; and before which poses there
    surely is a limit, whichever side they are approached from.
    """
    at_nodes = _at_nodes(system, line.windings, values)
    turns, interval, distance, nearby = at_nodes
    begun, ended = (jnp.asarray(each)[:, None] for each in (line.windings.begun, line.windings.ended))
    every = at_nodes.expected(line.windings)

    def whole_line():
        return every, jnp.ones(values.shape, bool), jnp.zeros(values.shape, bool)

    def parts_of_it():
        rising, judged = values >= 0, certify_line(line.discriminants, jnp.asarray(line.steep), *ends(system))
        reached = certify_poses(judged.table, interval, distance, discriminants)
        (from_below, from_above), (after_limit, before_limit) = reached.passed, reached.crossed
        if not system.periodic:
            passed, crossed = jnp.where(rising, from_below, from_above), jnp.where(rising, after_limit, before_limit)
            return every, passed | judged.passes, crossed
        # the assembled pose is the first node as well as the last
        first_turn = (turns == 0) | (turns == -1)
        direct = jnp.where(rising, from_below, from_above) & first_turn
        limited = jnp.where(first_turn, jnp.where(rising, after_limit, before_limit), judged.limited)
        # behind a limit an input is reached if it is, a full turn less or more, on the near side
        around = limited & (from_below | from_above)
        by_rising = jnp.where(direct, rising, from_below)
        passed = direct | around | judged.passes
        expected = jnp.where(judged.passes, every, nearby - jnp.where(by_rising, begun, ended))
        return expected, passed, after_limit & before_limit

    # most designs pass the whole line, and whole groups of them do
    return lax.cond(any_in_lockstep(~jnp.asarray(line.passes)), parts_of_it, whole_line)


def scaled_inputs(
    system: LoopSystem, axes: AssembledAxes, inputs: Float[Array | np.ndarray, "1 poses"]
) -> Float[Array | np.ndarray, "1 poses"]:
    """Convert inputs to radians and characteristic lengths."""
    return inputs / axes.length if system.is_length[system.driven[0]] else inputs
