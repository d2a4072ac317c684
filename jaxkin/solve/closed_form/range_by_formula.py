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

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.assembled_axes import Axes, assembled_axes
from jaxkin.solve.closed_form.equations import namespace
from jaxkin.solve.closed_form.line import Line, full_turn, to_either_side, unknown_angles
from jaxkin.solve.closed_form.solve_groups import residual_norm, solve_groups
from jaxkin.solve.closed_form.way import reach
from jaxkin.solve.closure.closure import scaled_geometry
from jaxkin.solve.closure.joint_coordinates import ball_turns, joint_coordinates, unwrap_ball_angles
from jaxkin.solve.correctors.newton import CLOSED_ROUNDINGS
from jaxkin.solve.range.poses import Poses
from jaxkin.solve.status import ClosureTolerance, Status, classify, is_closed, rounding_residual
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State


class FormulaPoses(NamedTuple):
    """What the formulas say about a range."""

    poses: Poses
    signs: Float[Array, "groups 1"]
    """The sign of the branch of every group."""
    proven: Bool[Array, ""]
    """Whether all poses are CLOSED, to rounding."""


def line_of(system: LoopSystem, axes: Axes, inputs: Float[Array | np.ndarray, "1 poses"]) -> Line:
    """Compute the line on which inputs are judged: a full turn, if the input is an angle, else the range of the inputs.

    `inputs` are in radians or lengths of the mechanism.
    """
    if system.periodic:
        return full_turn(system, axes)
    values = _scaled(system, axes, inputs)
    return to_either_side(system, axes, namespace(values).max(abs(values), initial=0.0))


def find_poses_by_formula(
    system: LoopSystem, axes: Axes, line: Line, inputs: Float[Array, "1 poses"], tolerance: ClosureTolerance
) -> FormulaPoses:
    """Find the poses for finite inputs in radians or lengths of the mechanism, of a system that is all formulas.

    Nothing that is found has a derivative; `displacements_by_formula` has.
    """
    axes, line, inputs = lax.stop_gradient((axes, line, inputs))
    values = _scaled(system, axes, inputs)[0]
    solved = solve_groups(system, axes, list(line.signs), values[None])
    expected, passed, crossed = _reached(system, line, values, jnp.asarray(solved.discriminant))
    x = jnp.asarray(solved.x) + unknown_angles(system) * TURN * jnp.round((expected - solved.x) / TURN)

    residual = jnp.asarray(residual_norm(system, axes, x))
    closes = residual <= tolerance.max_residual
    status = classify(residual, ~closes, passed & line.begins, tolerance.max_residual)
    in_doubt = closes & ~(line.begins & (passed | crossed))
    status = jnp.where(in_doubt, Status.STALLED.value, status)
    poses = Poses(State(x, jnp.zeros((0, 4, x.shape[1]), x.dtype)), status, residual)
    sharp = jnp.maximum(rounding_residual(x.dtype, CLOSED_ROUNDINGS), tolerance.target_residual)
    proven = jnp.all((status == Status.CLOSED.value) & (residual <= sharp))
    return FormulaPoses(poses, jnp.asarray(line.signs), proven)


def displacements_by_formula(
    system: LoopSystem, joints: Joints, inputs: Float[Array, "1 poses"], found: FormulaPoses
) -> Float[Array, "columns poses"]:
    """Compute the displacements of all joints in the poses found, as differentiable functions of joints and inputs.

    Displacements are in radians and lengths of the mechanism. The derivatives are those of the formulas; a pose that
    did not close has derivatives of zero.
    """
    axes = assembled_axes(system, joints)
    found = lax.stop_gradient(found)
    x = _with_derivative(system, axes, _scaled(system, axes, inputs), found.signs, found.poses)
    return joint_displacements(system, joints, axes, x)


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _with_derivative(
    system: LoopSystem, axes: Axes, values: Float[Array, "1 poses"], signs: Float[Array, "groups 1"], poses: Poses
) -> Float[Array, "columns poses"]:
    """Return the coordinates of poses that were found, which cost nothing anew, with the derivatives of the formulas.

    `values` are the inputs in radians or characteristic lengths.
    """
    return poses.state.x


@_with_derivative.defjvp
def _derivative_of_formulas(system: LoopSystem, primals, tangents):
    axes, values, signs, poses = primals
    closed = is_closed(poses.status)

    def formulas(axes: Axes, values: Float[Array, "1 poses"]) -> Float[Array, "columns poses"]:
        return jnp.asarray(solve_groups(system, axes, list(signs), jnp.where(closed, values, 0.0)).x)

    slope = jax.jvp(formulas, (axes, values), tangents[:2])[1]
    return _with_derivative(system, *primals), jnp.where(closed, slope, 0.0)


def joint_displacements(
    system: LoopSystem, joints: Joints | None, axes: Axes, x: Float[Array, "columns poses"]
) -> Float[Array, "columns poses"]:
    """Compute the displacements of all joints, balls included, from coordinates in radians and characteristic lengths.

    Displacements are in radians and lengths of the mechanism. `joints` are needed for balls only.
    """
    lengths = jnp.where(jnp.array(system.is_length, bool), axes.length, 1.0)[:, None]
    if not system.balls or joints is None:
        return x * lengths
    geometry, _ = scaled_geometry(system, joints)
    turns = ball_turns(system, geometry, State(x, jnp.zeros((0, 4, x.shape[1]), x.dtype)))
    found = joint_coordinates(system, joints.frames_1, joints.frames_2, x * lengths, turns)
    return unwrap_ball_angles(system, found)


def _reached(
    system: LoopSystem, line: Line, values: Float[Array, " poses"], discriminant: Float[Array, "groups poses"]
) -> tuple[Float[Array, "columns poses"], Bool[Array, " poses"], Bool[Array, " poses"]]:
    """Judge the ways from the assembled pose, upwards and downwards.

    Returns coordinates nearby, angles with their full turns; to which poses the motion passes; and before which poses
    there surely is a limit, whichever way they are approached.
    """
    turns = jnp.floor(values / TURN) if system.periodic else jnp.zeros_like(values)
    position = (values - TURN * turns - line.begin) / line.spacing
    expected, (from_below, from_above), (after_limit, before_limit) = reach(
        line.table, system.columns, position, discriminant
    )
    rising = values >= 0
    if not system.periodic:
        passed, crossed = jnp.where(rising, from_below, from_above), jnp.where(rising, after_limit, before_limit)
        return expected - line.begun, passed, crossed

    # the assembled pose is the first node as well as the last
    first_turn = (turns == 0) | (turns == -1)
    direct = jnp.where(rising, from_below, from_above) & first_turn
    limited = jnp.where(first_turn, jnp.where(rising, after_limit, before_limit), line.limited)
    # behind a limit an input is reached if it is, a full turn less or more, on the near side
    around = limited & (from_below | from_above)
    of_turns = jnp.where(line.passes, (line.ended - line.begun) * turns, 0.0)
    by_rising = jnp.where(direct & ~line.passes, rising, from_below)
    expected = jnp.where(by_rising, expected - line.begun + of_turns, expected - line.ended)
    return expected, direct | around | line.passes, after_limit & before_limit


def _scaled(
    system: LoopSystem, axes: Axes, inputs: Float[Array | np.ndarray, "1 poses"]
) -> Float[Array | np.ndarray, "1 poses"]:
    """Convert inputs to radians and characteristic lengths."""
    return inputs / axes.length if system.is_length[system.driven[0]] else inputs
