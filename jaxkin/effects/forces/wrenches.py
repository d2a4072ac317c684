"""The work of all that acts: weight, inertia, forces, springs.

The displacement of a part is a matrix T (world coordinates, from the assembled pose). What acts on the part is kept as
the matrix C of the same shape (3, 4) whose product with a small change of T is its work: sum of C_ij dT_ij, in joules.
A force F on a point p has C = F (p, 1)^T, a torque M has 1/2 [M] R in the first columns, where [M] x = M cross x; mass
that moves has -T'' J, with J the second moments of the part (`Masses.second_moments`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin._names import nearest
from jaxkin.effects.forces.changes import Changes
from jaxkin.effects.forces.given import Applied, Force, JointLoad, Spring, Torque
from jaxkin.effects.forces.masses import Masses
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import METRES
from jaxkin.linkage.coordinates import coordinate
from jaxkin.mechanism.motion import Motion

Works = Float[Array, "poses parts 3 4"]
"""C of each part: joules for a change of its displacement matrix, whose last column is in the unit of the mechanism."""

STANDARD_GRAVITY = (0.0, 0.0, -9.81)


class Loads(NamedTuple):
    """All that acts in each pose, but for drives and joints."""

    works: Works
    joints: dict[tuple[int, int], Float[Array, " poses"]]
    """Loads in coordinates (joint, coordinate): newton metres, newtons."""


class Acting(NamedTuple):
    """What a user asks for: the arguments that drive forces and reactions share."""

    masses: Masses | None = None
    gravity: Any = STANDARD_GRAVITY
    applied: Sequence[Applied] | Applied = ()
    rates: Mapping[str, Any] | None = None
    accelerations: Mapping[str, Any] | None = None


def loads(motion: Motion, acting: Acting, moving: Changes | None) -> Loads:
    """Find all that acts in each pose, inertia and dampers where the parts move."""
    masses, metre = acting.masses, METRES[motion.mechanism.unit]
    place = jnp.stack([motion.transforms[part][:, :3] for part in motion.mechanism.parts], axis=1)
    works = jnp.zeros_like(place)
    if masses is not None:
        moments = masses.second_moments()
        weight = metre * _gravity(acting.gravity)[:, None] * moments[:, 3:4]
        works = works + weight[None]
        if moving is not None and moving.acceleration is not None:
            works = works - metre**2 * jnp.einsum("npij,pjk->npik", moving.acceleration.transforms, moments)
    in_joints: dict[tuple[int, int], Array] = {}
    for each in applied_of(acting):
        if isinstance(each, JointLoad):
            at, load = _in_joint(motion, moving, each)
            in_joints[at] = in_joints.get(at, jnp.zeros(len(motion))) + load
        else:
            for part, work in _on_parts(motion, moving, each, metre):
                works = works.at[:, motion.mechanism.parts.index(part)].add(work)
    return Loads(works, in_joints)


def applied_of(acting: Acting) -> tuple[Applied, ...]:
    """What is applied, one alone as well as several; ValueError for other things."""
    given = acting.applied
    applied = (given,) if isinstance(given, (Force, Torque, Spring, JointLoad)) else tuple(given)
    for each in applied:
        if not isinstance(each, (Force, Torque, Spring, JointLoad)):
            raise ValueError(f"applied loads are made by jk.force, jk.torque, jk.spring, ..., got {each!r}")
    return applied


def check(motion: Motion, acting: Acting) -> None:
    """Raise ValueError for arguments that do not fit the motion, with what to write instead."""
    if not isinstance(motion, Motion):
        raise ValueError(f"forces are those of a motion, mechanism.sweep(drive), got {type(motion).__name__}")
    mechanism, masses, applied = motion.mechanism, acting.masses, applied_of(acting)
    for each in applied:
        parts = each.parts if isinstance(each, Spring) else () if isinstance(each, JointLoad) else (each.part,)
        for part in parts:
            if part not in mechanism.parts:
                raise ValueError(f"there is no part {part!r} to act on{nearest(str(part), mechanism.parts)}")
    if masses is not None and not isinstance(masses, Masses):
        raise ValueError(f"masses are made by jk.masses(mechanism, density), got {type(masses).__name__}")
    if masses is not None and (masses.parts != mechanism.parts or masses.unit != mechanism.unit):
        raise ValueError(
            "the masses are those of another mechanism: its parts or its unit differ; write "
            "jk.masses(motion.mechanism, ...)"
        )
    if masses is None and not applied:
        raise ValueError("nothing acts: give jk.masses(mechanism, density), or applied=[jk.force(...)], or both")
    if acting.rates is None and acting.accelerations is not None:
        raise ValueError("accelerations were given without rates: write rates={'A': 0.0} for a start from rest")


def _gravity(given: Any) -> Float[Array, "3"]:
    found = jnp.asarray(given, float)
    if found.shape != (3,):
        raise ValueError(f"gravity must be three numbers, m/s^2, as (0, 0, -9.81), got {given!r}")
    return found


def _rows(motion: Motion, values: Any, what: str, axes: int) -> Array:
    """One entry a pose; ValueError where there are others."""
    values = jnp.asarray(values, float)
    if values.ndim > axes and len(values) != len(motion):
        raise ValueError(f"{what} must be given once or for each of the {len(motion)} poses, got {len(values)} rows")
    return jnp.broadcast_to(values, (len(motion), *values.shape[values.ndim - axes :]))


def _on_parts(motion: Motion, moving: Changes | None, load: Force | Torque | Spring, metre: float):
    """Yield parts and the matrices C of a load on them."""
    if isinstance(load, Spring):
        yield from _of_spring(motion, moving, load, metre)
        return
    rotation = motion.transforms[load.part][:, :3, :3]
    vector = _rows(motion, load.vector, f"the load on {load.part!r}", 1)
    if load.turns:
        vector = jnp.einsum("pij,pj->pi", rotation, vector)
    if isinstance(load, Force):
        yield load.part, metre * vector[:, :, None] * _homogeneous(load.point)
    else:
        turned = 0.5 * jnp.cross(vector[:, :, None], rotation, axisa=1, axisb=1, axisc=1)
        yield load.part, jnp.pad(turned, ((0, 0), (0, 0), (0, 1)))


def _of_spring(motion: Motion, moving: Changes | None, load: Spring, metre: float):
    """Yield the two parts of a spring and its matrices C on them."""
    one, other = load.parts
    apart = motion.points(other, load.points[1]) - motion.points(one, load.points[0])
    square = jnp.sum(apart**2, axis=1)
    distance = jnp.sqrt(jnp.where(square > 0, square, 1.0))  # no direction where the points meet, and no derivative
    along = jnp.where(square > 0, 1.0, 0.0)[:, None] * apart / distance[:, None]
    what = f"the spring of {one!r} and {other!r}"
    stiffness, length, damping = (_rows(motion, x, what, 0) for x in (load.stiffness, load.length, load.damping))
    pull = stiffness[:, None] * metre * (apart - length[:, None] * along)
    if moving is not None and moving.velocity is not None:
        rates = [
            moving.velocity.transforms[:, motion.mechanism.parts.index(part)] @ jnp.append(jnp.asarray(point), 1.0)
            for part, point in zip(load.parts, load.points, strict=True)
        ]
        change = rates[1] - rates[0]
        pull = pull + (damping * metre * jnp.sum(along * change, axis=1))[:, None] * along
    yield one, metre * pull[:, :, None] * _homogeneous(load.points[0])
    yield other, -metre * pull[:, :, None] * _homogeneous(load.points[1])


def _homogeneous(point: Any) -> Float[Array, "1 1 4"]:
    return jnp.append(jnp.asarray(point, float), 1.0)[None, None, :]


def _in_joint(
    motion: Motion, moving: Changes | None, load: JointLoad
) -> tuple[tuple[int, int], Float[Array, " poses"]]:
    """The load in a coordinate: newton metres, newtons."""
    joint, index = coordinate(motion.mechanism.linkage, load.coordinate)
    owner = motion.mechanism.all_joints[joint]
    if any(index in group and len(group) > 1 for group in owner.driven_together):
        raise ValueError(
            f"{load.coordinate!r} is an angle of a ball, which has no axis of its own: write jk.torque or jk.spring"
        )
    metre = METRES[motion.mechanism.unit] if is_length(owner.coordinates[index]) else 1.0
    what = f"the load in {load.coordinate!r}"
    given, stiffness, rest, damping = (
        _rows(motion, x, what, 0) for x in (load.load, load.stiffness, load.rest, load.damping)
    )
    found = given - stiffness * metre * (motion.displacements[joint][:, index] - rest)
    if moving is not None and moving.velocity is not None:
        found = found - damping * metre * moving.velocity.displacements[joint][:, index]
    return (joint, index), found


def units_of(motion: Motion, name: str) -> tuple[str, float]:
    """Unit of the force along a driven coordinate, and metres in the unit of the coordinate, 1 for radians."""
    return ("N", METRES[motion.mechanism.unit]) if is_length(name.rpartition(".")[2]) else ("N m", 1.0)


def nan_unless_closed(motion: Motion, values: Array) -> Array:
    """Set the rows of poses that are not CLOSED to NaN."""
    closed = motion.closed.reshape(len(motion), *[1] * (values.ndim - 1))
    return jnp.where(closed, values, jnp.nan)
