"""Follow a limit of a drive to another design, with its derivatives.

`jk.limits` searches a limit on the host; here it is the solution of an equation, of the closed poses of a mechanism
with other numbers. Another coordinate u takes the place of the drive q: the one whose range ends there, at its end, so
that the limit is q(u); or, where the drive locks, one that still moves, so that the limit is an extremum of q(u), with
q'(u) = 0. The pose is led from the design that is known to the other one in steps, each a projection onto the closed
poses (`jaxkin.mechanism.projection`) and, at a lock, a step of Newton's method by u. Nothing of that is differentiated:
derivatives are those of q(u) - q'(u)^2 / (2 q''(u)) at the pose that was found, the extremum to second order.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin._arguments import check_mechanism
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint, JointCoordinate
from jaxkin.linkage.coordinates import coordinate, coordinates
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.mechanism.known_motion import Inputs, derivatives, follow, known_motion
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.projection import project
from jaxkin.solve.status import Status

STEPS_TO_DESIGN = 10
"""Steps from the design that is known to the other one, of equal parts of the change of all numbers."""
LAST_STEPS = 6
"""Steps of Newton's method at the other design: a limit that the steps before have led to is right after four."""
LONGEST_STEP = 0.2
"""Longest of these steps, radians or characteristic lengths: farther away a parabola is no model of q(u)."""
SETTLED = 1e-6
"""Length of a last step, radians or characteristic lengths, up to which the limit counts as found, or the root of
rounding where that is more, in float32. What is left is the square of that."""
STATIC = {"static": True}


class Extremum(NamedTuple):
    """Of a limit where the drive locks. No program is compiled for its numbers: both limits of a drive share one."""

    side: float
    """1 where the drive is highest, -1 where it is lowest."""
    unit: float
    """Characteristic length if the coordinate that takes its place is a length, else 1."""


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
    extremum: Extremum | None
    """What the drive has where it locks; None where u is at an end of its range."""
    joints: tuple[Joint, ...]
    """Those of the design that is known."""
    couplings: tuple[Coupling, ...]
    pose: JointDisplacements
    """Displacements (1, coordinates) of all joints at its limit."""


def limit_equation(
    mechanism: Mechanism,
    driven: Sequence[str],
    by: str,
    pose: Mapping[str, Float[np.ndarray, " _"]],
    extremum: Extremum | None,
) -> LimitEquation:
    """Make the equation of a limit of the first coordinate that is `driven`, the others at rest, in a pose by joint."""
    rows = tuple(jnp.asarray(pose[joint.name][None], float) for joint in mechanism.all_joints)
    drive, *held = driven
    linkage = mechanism.linkage
    return LimitEquation(drive, by, tuple(held), extremum, linkage.joints, linkage.couplings, rows)


class _Rates(NamedTuple):
    """The displacements of all joints as functions of the coordinate u, to second order, in one pose."""

    at: JointDisplacements
    first: JointDisplacements
    """Derivatives by u."""
    second: JointDisplacements


def limit_of_design(equation: LimitEquation, design: Mechanism) -> Float[Array, ""]:
    """Find the limit of a design with the same joints, differentiable: NaN where it was not found.

    Raises ValueError for a mechanism with other joints.
    """
    check_mechanism(design, "the limit of a design")
    given = design.linkage.joints, design.linkage.couplings
    if jax.tree.structure(given) != jax.tree.structure((equation.joints, equation.couplings)):
        raise ValueError(
            f"the limit of {equation.drive} is known of a mechanism with other joints, couplings or limits of joints: "
            "give it a design as with_lengths, with_frames and with_points make it, or ask jk.limits of this one"
        )
    return _limit(equation, design)


@jax.jit
def _limit(equation: LimitEquation, design: Mechanism) -> Float[Array, ""]:
    """Lead the pose of the limit to the design, and take the limit from there with its derivatives."""
    drive = coordinate(design.linkage, equation.drive)
    found = lax.stop_gradient(_led(equation, design, drive))
    rates = _rates(equation, design, found.pose)
    value, is_limit = _entry(rates.at, drive), found.closed
    if equation.extremum is not None:
        side, unit = equation.extremum
        first, second = _entry(rates.first, drive), _entry(rates.second, drive)
        settled = max(SETTLED, float(jnp.finfo(second.dtype).eps) ** 0.5)
        is_limit &= (found.change <= settled * unit) & (side * second < 0)
        value = value - first**2 / (2 * jnp.where(is_limit, second, 1.0))
    return jnp.where(is_limit, value, jnp.nan)


class _Led(NamedTuple):
    """Where the pose of a limit was led."""

    pose: JointDisplacements
    change: Float[Array, ""]
    """By how much the last step of Newton's method has changed u."""
    closed: Bool[Array, ""]


def _led(equation: LimitEquation, design: Mechanism, drive: JointCoordinate) -> _Led:
    """Lead the pose of a limit from the design that is known to another one, without derivatives."""
    known, linkage = lax.stop_gradient((equation, design.linkage))

    def step(led: _Led, share: Array) -> tuple[_Led, None]:
        """Close the loops of a design between the two, and improve u at a lock."""
        ends = (known.joints, known.couplings), (linkage.joints, linkage.couplings)
        joints, couplings = jax.tree.map(lambda one, other: one + share * (other - one), *ends)
        between = design.with_linkage(replace(linkage, joints=joints, couplings=couplings))
        given = {joint.name: rows for joint, rows in zip(joints, led.pose, strict=True) if joint.freedoms}
        motion = project(between, given, hold=(equation.by, *equation.held)).motion
        pose, change = motion.displacements, jnp.zeros(())
        if equation.extremum is not None:
            rates, most = _rates(equation, between, pose), LONGEST_STEP * equation.extremum.unit
            change = -_entry(rates.first, drive) / _entry(rates.second, drive)
            change = jnp.clip(jnp.nan_to_num(change, posinf=most, neginf=-most), -most, most)
            pose = tuple(rows + change * rate for rows, rate in zip(pose, rates.first, strict=True))
        return _Led(pose, jnp.abs(change), motion.closed[0]), None

    shares = np.concatenate([np.arange(1, STEPS_TO_DESIGN + 1) / STEPS_TO_DESIGN, np.ones(LAST_STEPS)])
    begun = _Led(known.pose, jnp.zeros(()), jnp.array(True))
    return lax.scan(step, begun, jnp.asarray(shares, float))[0]


def _rates(equation: LimitEquation, design: Mechanism, pose: JointDisplacements) -> _Rates:
    """Differentiate the displacements of all joints by u in a closed pose, as functions of the numbers of a design."""
    places = coordinates(design.linkage, (equation.by, *equation.held))
    inputs = {name: pose[joint][:, k] for name, (joint, k) in places.items()}
    closed = jnp.full(1, Status.CLOSED.value, jnp.int32)
    found = follow(*known_motion(Motion(design, inputs, pose, closed, jnp.zeros(1), swept=False)))
    given: Inputs = {**inputs}
    along = {name: jnp.full(1, float(name == equation.by)) for name in inputs}
    rest = {name: jnp.zeros(1) for name in inputs}
    return _Rates(found(given), *derivatives(found, (given, along, rest)))


def _entry(rows: JointDisplacements, place: JointCoordinate) -> Float[Array, ""]:
    """Look up the entry of a coordinate in the one pose."""
    joint, k = place
    return rows[joint][0, k]
