"""A range of a single input by formulas, with the proof that the motion leads from the assembled pose to its poses.

The formulas give a pose for every input, on the branch of the assembled pose, but they do not know whether the input
can be moved there. It can if all discriminants stay positive on the way (`way`), for which they are computed at nodes.
Angles are unwrapped along the nodes, too.

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
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.assembled_axes import Axes, assembled_axes
from jaxkin.solve.closed_form.equations import Number
from jaxkin.solve.closed_form.solve_groups import Solved, assembled_roots, residual_norm, solve_groups
from jaxkin.solve.closed_form.way import LEAST_DISCRIMINANT, reach, way
from jaxkin.solve.closure.closure import scaled_geometry
from jaxkin.solve.closure.joint_coordinates import ball_turns, joint_coordinates, unwrap_ball_angles
from jaxkin.solve.range.poses import CLOSED_ROUNDINGS, Poses
from jaxkin.solve.status import ClosureTolerance, Status, classify, is_closed, rounding_residual
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State

NODES = 129
"""Inputs at which the discriminants are computed, 2.8 degrees apart on a full turn: they cost as much as 129 poses."""
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
    nodes = _nodes(system, values)
    solved = solve_groups(system, axes, signs, jnp.concatenate([nodes, values])[None])
    at_nodes, found = (
        Solved(*rows) for rows in zip(*(jnp.split(each, [NODES], axis=-1) for each in solved), strict=True)
    )
    start, expected, passed, crossed, passes_a_turn = _reached(system, values, nodes, at_nodes, found)
    x = found.x + _angles(system) * TURN * jnp.round((expected - found.x) / TURN)

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


class _Reached(NamedTuple):
    """To which poses of a range the motion passes."""

    start: Solved
    """The assembled pose."""
    expected: Float[Array, "columns poses"]
    """Coordinates nearby, angles with their full turns."""
    passed: Bool[Array, " poses"]
    crossed: Bool[Array, " poses"]
    """Before which poses there surely is a limit, whichever way they are approached."""
    passes_a_turn: Bool[Array, ""]


def _nodes(system: LoopSystem, values: Float[Array, " poses"]) -> Float[Array, " nodes"]:
    """List the inputs of the nodes: a full turn from the assembled pose, or as far as `values` to either side of it."""
    if system.periodic:
        return jnp.linspace(0.0, TURN, NODES, dtype=values.dtype)
    farthest = jnp.maximum(jnp.max(jnp.abs(values), initial=0.0), np.finfo(float).tiny)
    return farthest * jnp.linspace(-1.0, 1.0, NODES, dtype=values.dtype)


def _reached(
    system: LoopSystem, values: Float[Array, " poses"], nodes: Float[Array, " nodes"], at_nodes: Solved, found: Solved
) -> _Reached:
    """Judge the ways from the assembled pose, upwards and downwards."""
    angles = _angles(system)
    line = way(at_nodes.x, at_nodes.discriminant, angles)
    first, last = (0, NODES - 1) if system.periodic else (NODES // 2, NODES // 2)
    start = Solved(*(rows[:, first] for rows in at_nodes))
    turns = jnp.floor(values / TURN) if system.periodic else jnp.zeros_like(values)
    position = (values - TURN * turns - nodes[0]) / (nodes[1] - nodes[0])
    expected, (from_below, from_above), (after_limit, before_limit) = reach(
        line, first, last, position, found.discriminant
    )
    # the line is unwrapped from its first node on
    begun, ended = (angles * TURN * jnp.round((line.x[:, node] - start.x)[:, None] / TURN) for node in (first, last))
    rising = values >= 0
    if not system.periodic:
        passed, crossed = jnp.where(rising, from_below, from_above), jnp.where(rising, after_limit, before_limit)
        return _Reached(start, expected - begun, passed, crossed, jnp.zeros((), bool))

    # the assembled pose is the first node as well as the last
    first_turn = (turns == 0) | (turns == -1)
    direct = jnp.where(rising, from_below, from_above) & first_turn
    limited = jnp.where(first_turn, jnp.where(rising, after_limit, before_limit), line.limited)
    # behind a limit an input is reached if it is, a full turn less or more, on the near side
    around = limited & (from_below | from_above)
    of_turns = jnp.where(line.passes, (ended - begun) * turns, 0.0)
    by_rising = jnp.where(direct & ~line.passes, rising, from_below)
    expected = jnp.where(by_rising, expected - begun + of_turns, expected - ended)
    return _Reached(start, expected, direct | around | line.passes, after_limit & before_limit, line.passes)


def _scaled(system: LoopSystem, axes: Axes, inputs: Float[Array, "1 poses"]) -> Float[Array, "1 poses"]:
    """Convert inputs to radians and characteristic lengths."""
    return inputs / axes.length if system.is_length[system.driven[0]] else inputs


def _angles(system: LoopSystem) -> np.ndarray:
    """Mark columns that are angles and not driven by 1, others by 0: (columns, 1)."""
    is_angle = [not length and column not in system.driven for column, length in enumerate(system.is_length)]
    return np.array(is_angle, float)[:, None]
