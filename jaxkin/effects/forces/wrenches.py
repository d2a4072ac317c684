"""All that acts on the parts in each pose: weight, inertia, forces, torques, springs, as wrenches.

Wrenches are (torque about the middle of the mechanism over its size; force), in newtons and world axes, so that their
product with a twist (`screws`), times the size, is power. The poses are the last axis.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.forces.acting import ActingNumbers, loaded_coordinate
from jaxkin.effects.forces.changes import Changes
from jaxkin.effects.forces.given import Force, JointLoad, Spring, Torque
from jaxkin.effects.forces.inertia import weights_and_inertia
from jaxkin.effects.forces.moving_parts import MovingParts
from jaxkin.effects.forces.screws import Wrench, turned, velocity_at, wrench_at
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import METRES
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.execution.compiler import whole_program

MEETING = 0.6
"""Power of rounding: the ends of a spring meet within this of the size, 4e-10 in float64, above what poses are off."""


class Loads(NamedTuple):
    """All that acts in each pose, but for drives and joints."""

    parts: dict[str, Wrench]
    """On each part on which something acts and that is not fixed."""
    joints: dict[JointCoordinate, Float[Array, " poses"]]
    """Loads in coordinates (joint, coordinate): newton metres, newtons."""
    friction: dict[int, Wrench]
    """Wrenches of friction on part 2 of joints, by number."""


@partial(whole_program, static=(0, 1))
def acting_on(
    unit: str, chords: bool, linkage: Linkage, found: Changes, acting: ActingNumbers
) -> tuple[MovingParts, Loads]:
    """Place the parts, and find all that acts on them; with `chords`, place all joints and not only those of the tree.

    This is a program of its own: XLA would compute parts of the derivatives anew wherever they are used.
    """
    moving = MovingParts.of(linkage, found, chords)
    return moving, loads(linkage, unit, acting, moving)


def loads(linkage: Linkage, unit: str, acting: ActingNumbers, moving: MovingParts) -> Loads:
    """Find all that acts in each pose, inertia and dampers where the parts move."""
    found: dict[str, Any] = {}
    lever = moving.at.scale.size * METRES[unit]
    if acting.masses is not None:
        found |= weights_and_inertia(moving, acting.masses, acting.gravity, lever)
    in_joints: dict[JointCoordinate, Array] = {}
    for each in acting.applied:
        if isinstance(each, JointLoad):
            at, load = _in_joint(linkage, unit, moving, each)
            in_joints[at] = in_joints.get(at, 0.0) + load
        else:
            for part, wrench in _on_parts(moving, each, lever):
                if part in moving.at.parts:
                    found[part] = found.get(part, 0.0) + wrench
    return Loads(found, in_joints, {})


def _rows(values: Any) -> Array:
    """Return numbers of a load, one a pose; (1,) where they are given once."""
    values = jnp.asarray(values, float)
    return values[None] if values.ndim == 0 else values


def _vector(values: Any) -> Float[Array, "3 _"]:
    """Return a vector of a load, (3, poses); (3, 1) where it is given once."""
    values = jnp.asarray(values, float)
    return values[:, None] if values.ndim == 1 else values.T


def _on_parts(moving: MovingParts, load: Force | Torque | Spring, lever: Any):
    """Yield parts and the wrenches of a load on them."""
    if isinstance(load, Spring):
        yield from _of_spring(moving, load, lever)
        return
    vector = _vector(load.vector)
    if load.turns and load.part in moving.at.parts:
        rotation = moving.at.parts[load.part][:, :3]
        vector = turned(rotation, vector)
    if isinstance(load, Force):
        yield load.part, wrench_at(moving.at.point(load.part, load.point), vector)
    else:
        yield load.part, jnp.concatenate([vector / lever, jnp.zeros_like(vector)])


def _of_spring(moving: MovingParts, load: Spring, lever: Any):
    """Yield the two parts of a spring and its wrenches on them."""
    ends = [moving.at.point(part, point) for part, point in zip(load.parts, load.points, strict=True)]
    apart = lever * (ends[1] - ends[0])
    square = jnp.sum(apart**2, axis=0)
    known = square > (float(jnp.finfo(square.dtype).eps) ** MEETING * lever) ** 2
    distance = jnp.sqrt(jnp.where(known, square, 1.0))  # no direction where the points meet, and no derivative
    along = jnp.where(known, 1.0, 0.0) * apart / distance
    length = _rows(load.length) * lever / moving.at.scale.size
    pull = _rows(load.stiffness) * (apart - length * along)
    if moving.twists:
        none = jnp.zeros((6, 1))
        one, other = (
            velocity_at(moving.twists.get(part, none), end) for part, end in zip(load.parts, ends, strict=True)
        )
        # points that meet come from the side to which they go: the limit of both sides
        rate = jnp.where(known, jnp.sum(along * (other - one), axis=0) * along, other - one)
        pull = pull + _rows(load.damping) * lever * rate
    yield load.parts[0], wrench_at(ends[0], pull)
    yield load.parts[1], wrench_at(ends[1], -pull)


def _in_joint(
    linkage: Linkage, unit: str, moving: MovingParts, load: JointLoad
) -> tuple[JointCoordinate, Float[Array, " poses"]]:
    """Compute a load in a coordinate, newton metres or newtons: load - stiffness (q - rest) - damping q'."""
    joint, index = loaded_coordinate(linkage, load)
    metre = metres_of(linkage.joints[joint].coordinates[index], unit)
    given, stiffness, rest, damping = (_rows(x) for x in (load.load, load.stiffness, load.rest, load.damping))
    found = given - stiffness * metre * (moving.displacements[joint][:, index] - rest)
    if moving.velocity is not None:
        found = found - damping * metre * moving.velocity[joint][:, index]
    return (joint, index), found


def metres_of(coordinate: str, unit: str) -> float:
    """Look up the metres in the unit of a coordinate of a joint; 1 for angles."""
    return METRES[unit] if is_length(coordinate) else 1.0


def units_of(motion: Motion, name: str) -> tuple[str, float]:
    """Look up the unit of the force along a coordinate, and metres in the unit of the coordinate, 1 for radians."""
    return ("N", METRES[motion.mechanism.unit]) if is_length(name.rpartition(".")[2]) else ("N m", 1.0)


def nan_unless_closed(motion: Motion, values: Array) -> Array:
    """Set the rows of poses that are not closed (`motion.closed`) to NaN."""
    closed = motion.closed.reshape(len(motion), *[1] * (values.ndim - 1))
    return jnp.where(closed, values, jnp.nan)
