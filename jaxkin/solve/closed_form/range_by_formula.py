"""A range of a single input by formulas, with the proof that the motion leads from the assembled pose to its poses.

The formulas give a pose for every input, on the branch of the assembled pose, but they do not know whether the input
can be moved there. It can if all discriminants stay positive on the way. They are computed at `NODES` inputs of the
range, the assembled one included, and bounded between these (`positive_between`). Angles are unwrapped along the nodes.

| status | when |
|---|---|
| CLOSED | the loops close, and every interval from the assembled pose to the pose is passed |
| UNREACHABLE | the loops do not close at this input |
| JUMPED | the loops close; between the assembled pose and the pose they do not |
| STALLED | the loops close; whether the way is passed is in doubt: a change point, or nearly a limit |
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.assembled_axes import Axes, assembled_axes
from jaxkin.solve.closed_form.equations import Number, ratio
from jaxkin.solve.closed_form.solve_groups import Solved, assembled_roots, residual_norm, solve_groups
from jaxkin.solve.closure.closure import scaled_geometry
from jaxkin.solve.closure.joint_coordinates import ball_turns, joint_coordinates, unwrap_ball_angles
from jaxkin.solve.range.poses import CLOSED_ROUNDINGS, Poses
from jaxkin.solve.status import ClosureTolerance, Status, classify, is_closed, rounding_residual
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State

NODES = 129
"""Inputs at which the discriminants are computed, 2.8 degrees apart on a full turn: they cost as much as 129 poses."""
LEAST_DISCRIMINANT = 1e-6
"""Discriminant over its largest value below which an interval is not passed: a change point, where it is zero, is
passed on another branch, and 1e-6 away the coordinates are still right to a thousand roundings."""
MAX_TURN = 1.5
"""Largest change of an angle from node to node, radians: the unwrapping allows pi, a pose lies half as far from its
node, and beyond a radian the bound between the nodes is none."""
CLOSED_START = 1e-9
"""Largest coordinate that the formulas give for the assembled input, radians or characteristic lengths, of loops that
are closed there: rounding, and what files were rounded to."""
LEAST_ASSEMBLED_ROOT = 0.05
"""Least absolute value of the signed root in the assembled pose (such as the sine of an elbow) of loops that changed
dimensions leave open there: nearer to zero, its sign does not tell which branch the pose is on."""


class FormulaPoses(NamedTuple):
    """What the formulas say about a range."""

    poses: Poses
    signs: list[Number]
    """The sign of the branch of every group."""
    proven: Bool[Array, ""]
    """Whether all poses are CLOSED, to rounding."""
    passes_a_turn: Bool[Array, ""]
    """Whether the input makes full turns."""


def find_poses_by_formula(
    system: LoopSystem, axes: Axes, inputs: Float[Array, "1 poses"], tolerance: ClosureTolerance
) -> FormulaPoses:
    """Find the poses for finite inputs in radians or lengths of the mechanism, of a system that is all formulas.

    The way from the assembled pose is judged over a full turn, if the input is an angle, else over the range of the
    inputs. Nothing that is found has a derivative; `displacements_by_formula` has.
    """
    axes, inputs = lax.stop_gradient((axes, inputs))
    values = _scaled(system, axes, inputs)[0]
    roots = assembled_roots(system, axes)
    signs: list[Number] = [jnp.sign(root) for root in roots]
    turns = jnp.floor(values / TURN) if system.periodic else jnp.zeros_like(values)
    within = values - TURN * turns
    if system.periodic:
        low, high = jnp.zeros((), values.dtype), jnp.full((), TURN, values.dtype)
    else:
        low, high = jnp.min(values, initial=0.0), jnp.max(values, initial=0.0)
    nodes = low + (high - low) * jnp.asarray(np.linspace(0.0, 1.0, NODES), values.dtype)
    every = jnp.concatenate([nodes, jnp.zeros(1, nodes.dtype), values])
    solved = solve_groups(system, axes, signs, every[None])
    of_nodes, start, found = (
        Solved(*rows) for rows in zip(*(jnp.split(each, [NODES, NODES + 1], axis=-1) for each in solved), strict=True)
    )

    turning = _unwrapped(system)
    steps = jnp.diff(of_nodes.x, axis=1)
    steps = steps - turning * TURN * jnp.round(steps / TURN)
    path = of_nodes.x[:, :1] + _sum_before(steps)
    intervals = _intervals(of_nodes.discriminant, jnp.max(jnp.abs(turning * steps), axis=0) > MAX_TURN)
    spacing = jnp.where(high > low, (high - low) / (NODES - 1), 1.0)
    position = jnp.clip((within - low) / spacing, 0.0, NODES - 1.0)

    def way(start_position: Array) -> _Way:
        """The way to all poses from the assembled pose, which has that position among the nodes."""
        at_start = path[:, _nearest(start_position)][:, None]
        begun = path - turning * TURN * jnp.round((at_start - start.x) / TURN)
        between = _between(intervals, start_position, start.discriminant, position, found.discriminant)
        return _Way(begun, begun[:, _nearest(position)], *between)

    if system.periodic:
        # the assembled pose is the first node as well as the last
        forward, backward = way(jnp.zeros_like(low)), way(jnp.full_like(low, NODES - 1.0))
        passes_a_turn, any_limit = intervals.blocked[-1] == 0, intervals.beyond[-1] > 0
        rising, first_turn = values >= 0, (turns == 0) | (turns == -1)
        direct = jnp.where(rising, forward.passed, backward.passed) & first_turn | passes_a_turn
        crossed = jnp.where(first_turn, jnp.where(rising, forward.crossed, backward.crossed), any_limit)
        # behind a limit, but in the same place as a pose on the other side of the assembled one
        around = crossed & (forward.passed | backward.passed)
        crossed = forward.crossed & backward.crossed
        passed = direct | around
        of_turns = jnp.where(passes_a_turn, forward.path[:, -1:] - backward.path[:, -1:], 0.0) * turns
        by_forward = jnp.where(direct & ~passes_a_turn, rising, forward.passed)
        expected = jnp.where(by_forward, forward.expected + of_turns, backward.expected)
    else:
        _, expected, passed, crossed = way(jnp.clip(-low / spacing, 0.0, NODES - 1.0))
        passes_a_turn = jnp.zeros((), bool)
    x = found.x + turning * TURN * jnp.round((expected - found.x) / TURN)

    is_open = jnp.max(jnp.abs(start.x)) > CLOSED_START
    clear = jnp.min(jnp.abs(jnp.stack([jnp.ravel(root)[0] for root in roots]))) > LEAST_ASSEMBLED_ROOT
    begins = (jnp.min(start.discriminant) > LEAST_DISCRIMINANT) & (clear | ~is_open)
    residual = residual_norm(system, axes, x)
    closes = residual <= tolerance.max_residual
    status = classify(residual, ~closes, passed & begins, tolerance.max_residual)
    in_doubt = closes & ~(begins & (passed | crossed))
    status = jnp.where(in_doubt, Status.STALLED.value, status)
    poses = Poses(State(x, jnp.zeros((0, 4, x.shape[1]), x.dtype)), status, residual)
    sharp = jnp.maximum(rounding_residual(x.dtype, CLOSED_ROUNDINGS), tolerance.target_residual)
    proven = jnp.all((status == Status.CLOSED.value) & (residual <= sharp))
    return FormulaPoses(poses, signs, proven, passes_a_turn & begins)


def displacements_by_formula(
    system: LoopSystem, joints: Joints, inputs: Float[Array, "1 poses"], found: FormulaPoses
) -> Float[Array, "columns poses"]:
    """Compute the displacements of all joints in the poses found, as differentiable functions of joints and inputs.

    Displacements are in radians and lengths of the mechanism. The derivatives are those of the formulas; a pose that
    did not close has derivatives of zero.
    """
    axes = assembled_axes(system, joints)
    closed = is_closed(found.poses.status)
    values = jnp.where(closed, _scaled(system, axes, inputs), 0.0)
    solved = solve_groups(system, axes, lax.stop_gradient(found.signs), values).x
    x = lax.stop_gradient(found.poses.state.x) + jnp.where(closed, solved - lax.stop_gradient(solved), 0.0)
    return joint_displacements(system, joints, axes, x)


def joint_displacements(
    system: LoopSystem, joints: Joints, axes: Axes, x: Float[Array, "columns poses"]
) -> Float[Array, "columns poses"]:
    """Compute the displacements of all joints, balls included, from coordinates in radians and characteristic lengths.

    Displacements are in radians and lengths of the mechanism.
    """
    lengths = jnp.where(jnp.array(system.is_length, bool), axes.length, 1.0)[:, None]
    if not system.balls:
        return x * lengths
    geometry, _ = scaled_geometry(system, joints)
    turns = ball_turns(system, geometry, State(x, jnp.zeros((0, 4, x.shape[1]), x.dtype)))
    found = joint_coordinates(system, joints.frames_1, joints.frames_2, x * lengths, turns)
    return unwrap_ball_angles(system, found)


class _Way(NamedTuple):
    """The way from the assembled pose to the poses of a range."""

    path: Float[Array, "columns nodes"]
    """Coordinates of all nodes, unwrapped along the way."""
    expected: Float[Array, "columns poses"]
    """Those of the node that is nearest to each pose."""
    passed: Bool[Array, " poses"]
    """To which poses the motion passes."""
    crossed: Bool[Array, " poses"]
    """Before which poses there surely is a limit."""


class _Intervals(NamedTuple):
    """What is known of the discriminants f in the intervals between neighbouring nodes, h apart."""

    discriminant: Float[Array, "groups nodes"]
    curvature: Float[Array, "groups intervals"]
    """Upper bound of h^2 |f''|."""
    monotone: Bool[Array, "groups intervals"]
    steep: Bool[Array, " intervals"]
    """Where an angle changes by more than `MAX_TURN`."""
    blocked: Float[Array, " nodes"]
    """How many intervals before each node are not passed."""
    beyond: Float[Array, " nodes"]
    """How many nodes before each node are beyond a limit."""


def _intervals(discriminant: Float[Array, "groups nodes"], steep: Bool[Array, " intervals"]) -> _Intervals:
    """Bound the discriminants between the nodes by their second and third differences.

    In an interval f is taken as a parabola with the greater second difference of both ends, and lies below it by at
    most 0.064 times h^3 times its third derivative, for which twice the largest third difference nearby stands. The
    slope of f differs from the mean one by at most half of h |f"|.
    """
    second = jnp.diff(discriminant, n=2, axis=1)
    third = jnp.pad(jnp.abs(jnp.diff(second, axis=1)), ((0, 0), (2, 2)), mode="edge")  # of intervals -1 ... n
    third = jnp.maximum(jnp.maximum(third[:, :-2], third[:, 1:-1]), third[:, 2:])
    second = jnp.pad(second, ((0, 0), (1, 1)), mode="edge")  # of all nodes
    bend = jnp.maximum(second[:, :-1], second[:, 1:])
    curvature = jnp.maximum(jnp.abs(second[:, :-1]), jnp.abs(second[:, 1:])) + 2 * third
    one, other, change = discriminant[:, :-1], discriminant[:, 1:], jnp.diff(discriminant, axis=1)
    monotone = jnp.abs(change) > 0.5 * curvature
    dip = ratio((0.5 * bend - change) ** 2, 2 * bend)
    least = jnp.where(jnp.abs(change) < 0.5 * bend, one - dip, jnp.minimum(one, other))
    least = least - jnp.where(monotone, 0.0, 0.128 * third)
    blocked = jnp.any(least <= LEAST_DISCRIMINANT, axis=0) | steep
    beyond = jnp.any(discriminant[:, :-1] < -LEAST_DISCRIMINANT, axis=0)
    return _Intervals(
        discriminant, curvature, monotone, steep, *_sum_before(jnp.stack([blocked, beyond]).astype(one.dtype))
    )


def _passes(
    intervals: _Intervals, interval: Int[Array, "*#ends"], one: Number, other: Number, apart: Number
) -> Bool[Array, "*ends"]:
    """Whether the discriminants stay positive within an interval, between two inputs that are `apart` spacings.

    Between them f is not below the lesser of its values `one` and `other` by more than (apart h)^2 / 8 |f''|; where it
    is monotone, it is not below `other` at all, at which the caller looks.
    """
    curvature, monotone = intervals.curvature[:, interval], intervals.monotone[:, interval]
    least = jnp.where(monotone, one, jnp.minimum(one, other) - 0.125 * apart * apart * curvature)
    return jnp.all(least > LEAST_DISCRIMINANT, axis=0) & ~intervals.steep[interval]


def _between(
    intervals: _Intervals,
    start: Float[Array, ""],
    of_start: Float[Array, "groups 1"],
    ends: Float[Array, " poses"],
    of_ends: Float[Array, "groups poses"],
) -> tuple[Bool[Array, " poses"], Bool[Array, " poses"]]:
    """Tell whether the motion passes from the start to each end, and whether there surely is a limit between them.

    Start and ends are positions among the nodes, in spacings; `of_start` and `of_ends` are the discriminants there. An
    end at which the loops close may be as near to a limit as it likes.
    """
    begin, end = (jnp.clip(jnp.floor(at), 0, NODES - 2).astype(jnp.int32) for at in (start, ends))
    discriminant, blocked = intervals.discriminant, intervals.blocked
    leave_to = [
        _passes(intervals, begin, of_start[:, 0], discriminant[:, node], node - start) for node in (begin, begin + 1)
    ]
    forward = end > begin
    node = jnp.where(forward, end, end + 1)
    arrive = _passes(intervals, end, discriminant[:, node], of_ends, ends - node)
    no_block = jnp.where(forward, blocked[end] == blocked[begin + 1], blocked[begin] == blocked[end + 1])
    direct = _passes(intervals, end, of_start, of_ends, ends - start)
    passed = jnp.where(end == begin, direct, jnp.where(forward, leave_to[1], leave_to[0]) & no_block & arrive)
    return passed, intervals.beyond[end + 1] != intervals.beyond[begin + 1]


def _sum_before(steps: Float[Array, "*rows intervals"]) -> Float[Array, "*rows nodes"]:
    """Sum the intervals before each node: by a product of matrices, which XLA does faster than sums one by one."""
    before = np.arange(NODES - 1)[:, None] < np.arange(NODES)
    return steps @ jnp.asarray(before, steps.dtype)


def _nearest(position: Float[Array, "..."]) -> Int[Array, "..."]:
    """The number of the node that is nearest to a position, in spacings."""
    return jnp.round(position).astype(jnp.int32)


def _scaled(system: LoopSystem, axes: Axes, inputs: Float[Array, "1 poses"]) -> Float[Array, "1 poses"]:
    """Inputs in radians and characteristic lengths."""
    return inputs / axes.length if system.is_length[system.driven[0]] else inputs


def _unwrapped(system: LoopSystem) -> np.ndarray:
    """1 for columns that are angles and not driven, else 0: (columns, 1)."""
    is_angle = [not length and column not in system.driven for column, length in enumerate(system.is_length)]
    return np.array(is_angle, float)[:, None]
