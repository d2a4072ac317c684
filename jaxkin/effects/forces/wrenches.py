"""All that acts on the parts in each pose: weight, inertia, forces, torques, springs, as wrenches.

Wrenches are (torque about the middle of the mechanism over its size; force), in newtons and world axes, so that their
product with a twist (`screws`), times the size, is power. The poses are the last axis.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.effects.forces.acting import ActingNumbers, loaded_coordinate
from jaxkin.effects.forces.changes import ByCoordinate, Changes
from jaxkin.effects.forces.given import Force, JointLoad, Spring, Torque
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.places import Places, places, twists_of_parts
from jaxkin.effects.forces.screws import Scale, Twist, cross, turned, velocity_at, wrench_at
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.rigid import Rigid
from jaxkin.geometry.units import METRES
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import JointRates
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.execution.compiler import whole_program

Wrench = Float[Array, "6 _"]
"""Torque over the size of the mechanism, then force: newtons. The last axis is the poses, or one for all poses."""


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


class MovingParts(NamedTuple):
    """Where the parts are, and how they move."""

    at: Places
    displacements: JointDisplacements
    velocity: JointRates | None
    """Rates of all joints; None at rest."""
    twists: dict[str, Twist]
    """Of all parts that are not fixed; none at rest."""
    changes: dict[str, Twist]
    """Their derivatives."""
    along: dict[str, ByCoordinate]
    """First derivatives of the coordinates by each driven displacement, as `Changes` has them."""

    @staticmethod
    def of(linkage: Linkage, found: Changes, chords: bool) -> MovingParts:
        """Place the parts, and find their twists."""
        at = places(linkage, found.displacements, chords)
        if found.velocity is None:
            return MovingParts(at, found.displacements, None, {}, {}, found.along)
        twists, changes = twists_of_parts(linkage, at, found.velocity, found.acceleration)
        return MovingParts(at, found.displacements, found.velocity, twists, changes, found.along)


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
        found |= _of_masses(moving, acting.masses, acting.gravity, lever)
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


def _of_masses(moving: MovingParts, masses: Masses, gravity: Any, lever: Any) -> dict[str, Wrench]:
    """Compute weight and inertia of all parts that move, at once: one by one, their operations are a long program."""
    parts = list(moving.at.parts)
    if not parts:
        return {}
    numbers = np.array([masses.parts.index(part) for part in parts])
    displaced = jnp.stack([moving.at.parts[part] for part in parts])
    own = tuple(jnp.asarray(each, float)[numbers] for each in (masses.mass, masses.centre, masses.inertia))
    twists = [jnp.stack([rows[part] for part in parts]) for rows in (moving.twists, moving.changes) if rows]
    of_mass = partial(_of_mass, moving.at.scale, gravity, lever)
    # found once: XLA would find all of it anew wherever it is used
    found = lax.optimization_barrier(jax.vmap(of_mass)(displaced, *own, *twists))
    return {part: found[place] for place, part in enumerate(parts)}


def _of_mass(
    scale: Scale,
    gravity: Any,
    lever: Any,
    displaced: Rigid,
    mass: Float[Array, ""],
    centre: Float[Array, "3"],
    inertia: Float[Array, "3 3"],
    twist: Twist | None = None,
    change: Twist | None = None,
) -> Wrench:
    """Compute weight and inertia of a part: the force m (g - a) at its centre, the torque -(I w' + w x I w).

    `displaced` is the part in each pose; without its `twist` and the derivative of that it is at rest.
    """
    arm = scale.arm(turned(displaced, centre) + displaced[:, 3])
    force = mass * gravity[:, None]
    if twist is None or change is None:
        return wrench_at(arm, force)
    turning = twist[:3]
    acceleration = velocity_at(change, arm) + cross(turning, velocity_at(twist, arm))
    rotation = displaced[:, :3]

    def times_inertia(vector: Float[Array, "3 poses"]) -> Float[Array, "3 poses"]:
        """Multiply a vector by R I R^T."""
        return turned(rotation, turned(inertia[..., None], turned(rotation.swapaxes(0, 1), vector)))

    torque = times_inertia(change[:3]) + cross(turning, times_inertia(turning))
    wrench = wrench_at(arm, force - mass * lever * acceleration)
    return jnp.concatenate([wrench[:3] - torque / lever, wrench[3:]])


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
