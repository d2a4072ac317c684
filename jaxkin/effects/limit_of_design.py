"""Follow a limit of a drive to another design, with its derivatives.

`jk.limits` searches a limit on the host; here it is the solution of an equation, of the closed poses of a mechanism
with other numbers. Another coordinate u takes the place of the drive q: the one whose range ends there, at its end, so
that the limit is q(u); or, where the drive locks, one that still moves, so that the limit is a turning point of q(u).
The pose is led from the design that is known to the other one (`jaxkin.solve.correctors.turning_point`). Nothing of
that is differentiated: derivatives of any order are those of the solution.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin._arguments import check_mechanism
from jaxkin._traced import traced
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.first_order import Columns
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.sweep import closure_tolerance, warn_of_float32
from jaxkin.solve.closure.closure import Geometry, closure, scaled_geometry
from jaxkin.solve.closure.joint_coordinates import as_state
from jaxkin.solve.correctors.turning_point import TurningPoint, first_order, follow_turning_point, rate_with_geometry
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.system.from_linkage import group_joints, group_system
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.state import State

SETTLED = 1e-6
"""Length of a last step, radians or characteristic lengths, up to which the limit counts as found, or the root of
rounding where that is more, in float32. What is left is the square of that."""
STATIC = {"static": True}


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class LimitEquation:
    """What a limit of a drive is a solution of, and the solution of one design. A pytree."""

    drive: str = field(metadata=STATIC)
    """The coordinate that is limited, "joint.coordinate"."""
    by: str = field(metadata=STATIC)
    """The coordinate u that takes its place: the one whose range ends, or one that moves while the drive locks."""
    held: tuple[str, ...] = field(metadata=STATIC)
    """Coordinates that rest at 0."""
    side: float | None
    """Where the drive locks: 1 where it is highest, -1 where it is lowest. None where u is at an end of its range."""
    joints: tuple[Joint, ...]
    """Those of the design that is known, whose loops are solved."""
    couplings: tuple[Coupling, ...]
    pose: tuple[Float[Array, " _"], ...]
    """Displacements of all joints at its limit."""


def limit_equation(
    mechanism: Mechanism,
    driven: Sequence[str],
    by: str,
    pose: Mapping[str, Float[np.ndarray, " _"]],
    side: float | None,
) -> LimitEquation:
    """Make the equation of a limit of the first coordinate that is `driven`, the others at rest, in a pose by joint."""
    rows = tuple(jnp.asarray(pose[joint.name], float) for joint in mechanism.all_joints)
    drive, *held = driven
    linkage = mechanism.linkage
    return LimitEquation(drive, by, tuple(held), side, linkage.solved_joints, linkage.couplings, rows)


def limit_of_design(equation: LimitEquation, design: Mechanism) -> Float[Array, ""]:
    """Find the limit of a design with the same joints, differentiable: NaN where it was not found.

    Raises ValueError for a mechanism with other joints.
    """
    check_mechanism(design, "the limit of a design")
    linkage = design.linkage
    given = linkage.solved_joints, linkage.couplings
    if jax.tree.structure(given) != jax.tree.structure((equation.joints, equation.couplings)):
        raise ValueError(
            f"the limit of {equation.drive} is known of a mechanism with other joints, couplings or limits of joints: "
            "give it a design as with_lengths, with_frames and with_points make it, or ask jk.limits of this one"
        )
    warn_of_float32()
    found = _find(*lax.stop_gradient((equation, linkage)))
    return _attach_derivative(equation, linkage, found) if traced(linkage) else found.value


class _Loops(NamedTuple):
    """The loops of the drive, whose turning point is the limit."""

    point: TurningPoint
    columns: Columns
    joints: Joints

    @staticmethod
    def of(equation: LimitEquation, linkage: Linkage) -> _Loops:
        """Select the loops of a linkage that the drive moves."""
        places = [coordinate(linkage, name) for name in (equation.drive, equation.by, *equation.held)]
        groups = linkage.structure.loop_groups
        number = next(number for number, group in enumerate(groups) if places[0][0] in group.joints)
        driven = tuple(place for place in places if place[0] in groups[number].joints)
        system, columns = group_system(linkage, groups[number], driven, linkage.in_space.classes[number])
        column, along = (columns.index(place) for place in places[:2])
        joints = group_joints(linkage, linkage.solved_joints, groups[number])
        return _Loops(TurningPoint(system, column, along, equation.side is not None), columns, joints)


class _Found(NamedTuple):
    """The limit of a design, without derivatives."""

    value: Float[Array, ""]
    """Radians or lengths; NaN where it was not found."""
    state: State
    """The pose there, scaled as its loops are."""


@partial(whole_program, static=())
def _find(equation: LimitEquation, linkage: Linkage) -> _Found:
    """Lead the pose of the limit to another design."""
    point, columns, joints = _Loops.of(equation, linkage)
    geometry, lengths = scaled_geometry(point.system, joints)
    known = jnp.stack([equation.pose[joint][k] for joint, k in columns])[:, None]
    begun = as_state(point.system, joints.frames_1, joints.frames_2, known)
    found = follow_turning_point(point, geometry, begun._replace(x=begun.x / lengths))
    is_limit = found.residual_norm <= closure_tolerance(None).max_residual
    if equation.side is not None:
        settled = max(SETTLED, float(jnp.finfo(found.step.dtype).eps) ** 0.5)
        is_limit &= (found.step <= settled) & (equation.side * found.curvature < 0)
    value = (found.state.x * lengths)[point.column, 0]
    return _Found(jnp.where(is_limit, value, jnp.nan), found.state)


@jax.custom_jvp
def _attach_derivative(equation: LimitEquation, linkage: Linkage, found: _Found) -> Float[Array, ""]:
    """Return the limit that was found, with its derivatives by all numbers of the linkage: zero where it is NaN."""
    del equation, linkage
    return found.value


@_attach_derivative.defjvp
def _limit_jvp(primals, tangents):
    equation, linkage, found = primals
    state = _attach_derivative_of_pose(equation, linkage, found.state)
    change = _along(_gradient(equation, linkage, state), tangents[1])
    return _attach_derivative(*primals), jnp.where(jnp.isnan(found.value), 0.0, change)


@partial(whole_program, static=())
def _gradient(equation: LimitEquation, linkage: Linkage, state: State) -> Linkage:
    """Differentiate the limit by all numbers of a linkage: those of its pose with u at rest."""
    point = _Loops.of(equation, linkage).point
    constants = partial(_constants, equation)
    geometry, of_numbers, lengths = jax.vjp(constants, linkage, has_aux=True)
    row = first_order(point, geometry, state).inverse[point.column] * lengths[point.column]
    _, of_geometry = jax.vjp(lambda own: closure(point.system, own, state).residual, geometry)
    (gradient,) = of_numbers(*of_geometry(-row[:, None]))
    return gradient


def _constants(equation: LimitEquation, linkage: Linkage) -> tuple[Geometry, Float[Array, "columns 1"]]:
    """Compute the constants of the loops, and the lengths by which they are scaled."""
    point, _, joints = _Loops.of(equation, linkage)
    return scaled_geometry(point.system, joints)


@jax.jit
def _along(gradient: Linkage, change: Linkage) -> Float[Array, ""]:
    """Compute the derivative along a change of the numbers of a linkage."""
    return jax.tree.reduce(jnp.add, jax.tree.map(jnp.vdot, gradient, change))


@jax.custom_jvp
def _attach_derivative_of_pose(equation: LimitEquation, linkage: Linkage, state: State) -> State:
    """Return the pose of the limit with its derivatives by all numbers of the linkage, for those of higher order."""
    del equation, linkage
    return state


@_attach_derivative_of_pose.defjvp
def _pose_jvp(primals, tangents):
    equation, linkage, _ = primals
    state = _attach_derivative_of_pose(*primals)
    return state, _pose_rate(equation, linkage, state, tangents[1])


@jax.jit
def _pose_rate(equation: LimitEquation, linkage: Linkage, state: State, change: Linkage) -> State:
    """Differentiate the pose of the limit along a change of the numbers of a linkage."""
    point = _Loops.of(equation, linkage).point
    geometry, d_geometry, _ = jax.jvp(partial(_constants, equation), (linkage,), (change,), has_aux=True)
    return rate_with_geometry(point, geometry, state, d_geometry)
