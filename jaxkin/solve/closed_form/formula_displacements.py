"""Displacements of all joints in poses that formulas found, with the derivatives of the formulas."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.trig import known_cos_and_sin
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes, assembled_axes
from jaxkin.solve.closed_form.complex_numbers import Complex
from jaxkin.solve.closed_form.planar_derivative import planar_slopes
from jaxkin.solve.closed_form.range_by_formula import LONG_RANGE, POSE_GROUP, FormulaPoses, scaled_inputs
from jaxkin.solve.closed_form.solve_groups import solve_groups
from jaxkin.solve.closure.closure import scaled_geometry
from jaxkin.solve.closure.joint_coordinates import ball_rotations, joint_coordinates, unwrap_ball_angles
from jaxkin.solve.range.groups import in_groups
from jaxkin.solve.status import Status, closes_before_limits
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State


def displacements_by_formula(
    system: LoopSystem,
    joints: Joints,
    inputs: Float[Array, "1 poses"],
    found: FormulaPoses,
    axes: AssembledAxes | None = None,
) -> list[Float[Array, " poses"]]:
    """Compute the displacements of all joints in the poses found, as differentiable functions of joints and inputs.

    They are one row a column: the reverse pass of one array would fill an array of all columns for each row of it that
    is used. `axes` are those of the joints, where they are known already. Displacements are in radians and lengths of
    the mechanism. The derivatives are those of the formulas, in the plane by the screws of the pose
    (`planar_derivative`), also of poses that close and are in doubt; a pose that did not close has derivatives of zero.
    """
    axes = assembled_axes(system, joints) if axes is None else axes
    found = lax.stop_gradient(found)
    rows = _with_derivative(system, axes, scaled_inputs(system, axes, inputs), found)
    if system.balls:
        return list(joint_displacements(system, joints, axes, rows))
    return _scaled(system, axes, rows)


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _with_derivative(
    system: LoopSystem, axes: AssembledAxes, values: Float[Array, "1 poses"], found: FormulaPoses
) -> tuple[Float[Array, " poses"], ...]:
    """Return the coordinates of poses that were found, which cost nothing anew, with the derivatives of the formulas.

    `values` are the inputs in radians or characteristic lengths.
    """
    return found.rows


@_with_derivative.defjvp
def _derivative_of_formulas(system: LoopSystem, primals, tangents):
    axes, values, found = primals
    # loops of a pose in doubt close as well, and a search for a design is to get on from there
    closed = closes_before_limits(found.status) | (found.status == Status.STALLED.value)
    if system.planar:
        # what was found is a function of axes and inputs, too, for the next derivative
        rows = _with_derivative(system, *primals)
        d_axes, d_values, _ = tangents
        turns = {column: Complex(*known_cos_and_sin(rows[column], tuple(own))) for column, own in found.turns.items()}

        def slopes_of(group) -> list[Float[Array, " group"]]:
            d_values, closed, rows, turns = group
            slopes = planar_slopes(system, axes, rows, d_axes, d_values, turns=turns)
            return [jnp.where(closed, slope, 0.0) for slope in slopes]

        poses = (d_values, closed, rows, turns)
        if len(closed) > LONG_RANGE:
            return rows, tuple(in_groups(jax.checkpoint(slopes_of), poses, POSE_GROUP))
        return rows, tuple(slopes_of(poses))

    def formulas(axes: AssembledAxes, values: Float[Array, "1 poses"]) -> tuple[Float[Array, " poses"], ...]:
        solved = solve_groups(system, axes, list(found.signs), jnp.where(closed, values, 0.0))
        return tuple(jnp.asarray(coordinate.value) for coordinate in solved.coordinates)

    slopes = jax.jvp(formulas, (axes, values), tangents[:2])[1]
    return _with_derivative(system, *primals), tuple(jnp.where(closed, slope, 0.0) for slope in slopes)


def joint_displacements(
    system: LoopSystem, joints: Joints | None, axes: AssembledAxes, rows: Sequence[Float[Array, " poses"]] | Array
) -> Float[Array, "columns poses"]:
    """Compute the displacements of all joints, balls included, from coordinates in radians and characteristic lengths.

    `rows` are those of all columns. Displacements are in radians and lengths of the mechanism. `joints` are needed for
    balls only.
    """
    displaced = jnp.stack(_scaled(system, axes, rows))
    if not system.balls or joints is None:
        return displaced
    geometry, _ = scaled_geometry(system, joints)
    x = jnp.stack(list(rows))
    rotations = ball_rotations(system, geometry, State(x, jnp.zeros((0, 4, x.shape[1]), x.dtype)))
    found = joint_coordinates(system, joints.frames_1, joints.frames_2, displaced, rotations)
    return unwrap_ball_angles(system, found)


def _scaled(
    system: LoopSystem, axes: AssembledAxes, rows: Sequence[Float[Array, " poses"]] | Array
) -> list[Float[Array, " poses"]]:
    """Convert characteristic lengths to lengths of the mechanism, row by row: angles are left as they are, so that the
    compiler need not copy them."""
    return [axes.length * row if is_length else row for row, is_length in zip(rows, system.is_length, strict=True)]
