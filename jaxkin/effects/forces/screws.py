"""Where the parts of a mechanism are in each pose, and how they move: twists, along the tree from the fixed parts.

Twists are (angular velocity; velocity of the point of the body at the middle of the mechanism), in world axes, lengths
over the size of the mechanism: also in coordinates that are lengths. The poses are the last axis. Behind an elementary
motion with the unit twist S and the rates q', q'', a body with the twist V and its derivative V' gets

    V + S q',    V' + S q'' + [V, S] q',    [V, S] = (w x w_S; w x v_S + v x w_S).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.characteristic_length import centroid_and_length
from jaxkin.geometry.elementary_motions import ElementaryMotion, amount, displaced_columns, rates
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.geometry.patches import FollowedSpline
from jaxkin.geometry.rigid import Rigid, as_rigid, inverse, product
from jaxkin.geometry.trig import cos_sin
from jaxkin.joints.joint import Joint
from jaxkin.linkage.joint_motion import joint_motion
from jaxkin.linkage.linkage import Linkage

Twist = Float[Array, "6 poses"]
"""Angular velocity, then linear velocity over the size of the mechanism."""


class Scale(NamedTuple):
    """The point about which moments are taken, and the length by which they are divided."""

    size: Float[Array, ""]
    """The characteristic length of all joints, not only those of a loop group, in the unit of the mechanism: their root
    mean square distance from the middle; 1 where it is zero."""
    middle: Float[Array, "3"]
    """The centroid of the joint frames in the assembled pose, world coordinates."""

    @staticmethod
    def of(linkage: Linkage) -> Scale:
        """Find size and middle of a linkage."""
        origins = jnp.concatenate([jnp.asarray(joint.frames_1, float)[:, :3, 3] for joint in linkage.joints])
        middle, size = centroid_and_length(origins)
        return Scale(size, middle)

    def arm(self, points: Float[Array, "3 poses"]) -> Float[Array, "3 poses"]:
        """Compute the vectors from the middle to points of the world, over the size."""
        return (points - self.middle[:, None]) / self.size

    def of_coordinates(self, joint: Joint) -> list[Any]:
        """List the unit of each coordinate of a joint: the size for lengths, 1 for angles."""
        return [self.size if is_length(name) else 1.0 for name in joint.coordinates]


class Motions(NamedTuple):
    """The elementary motions of a joint in each pose."""

    point: Float[Array, "3 poses"]
    """The origin of the last frame, on part 2, from the middle over the size."""
    twists: tuple[Twist, ...]
    """Unit twist of each, from part 1 to part 2; `coordinates_of_motions` lists their coordinates."""
    bends: tuple[dict[int, Twist], ...]
    """Change of each unit twist with the coordinates of its own movement, as a curve or a surface bends, by number of
    the coordinate; empty where it does not change."""

    def coordinates(self, joint: Joint) -> list[Twist]:
        """Add up unit twists by coordinate: a coordinate may be that of several elementary motions."""
        none = jnp.zeros((6, self.point.shape[1]))
        each = list(zip(coordinates_of_motions(joint), self.twists, strict=True))
        return [sum((twist for own, twist in each if own == k), none) for k in range(joint.freedoms)]


def coordinates_of_motions(joint: Joint) -> list[int]:
    """List for each elementary motion of a joint, from part 1 to part 2, the number of its coordinate."""
    numbered = zip(joint.movements, coordinate_ranges(joint.movements), strict=True)
    return [own[element.coordinate] for movement, own in numbered for element in MOVEMENTS[movement].elements]


class Places(NamedTuple):
    """A mechanism in each pose."""

    scale: Scale
    parts: dict[str, Rigid]
    """Displacements of the parts that are not fixed, in the unit of the mechanism."""
    joints: dict[int, Motions]
    """The joints that were asked for, by number; those of the tree always."""

    def point(self, part: str, at: Any) -> Float[Array, "3 _"]:
        """Place a point of a part, given where it is in the assembled pose: from the middle, over the size."""
        at = jnp.asarray(at, float)
        if part not in self.parts:
            return self.scale.arm(at[:, None])
        own = self.parts[part]
        return self.scale.arm(turned(own, at) + own[:, 3])


def places(linkage: Linkage, displacements: Sequence[Array], chords: bool) -> Places:
    """Place parts, and joints of the tree; with `chords` the other joints, too."""
    scale, parts, joints = Scale.of(linkage), {}, {}
    still = as_rigid(jnp.eye(4))
    for part, parent, number, sign in linkage.structure.tree:
        joint, q = linkage.joints[number], displacements[number]
        before = parts.get(parent, still)
        if sign > 0:
            joints[number], parts[part] = joint_motions(joint, q, before, scale)
        else:
            parts[part] = lax.optimization_barrier(product(before, inverse(joint_motion(joint, q))))
            joints[number] = joint_motions(joint, q, parts[part], scale)[0]
    for number, joint in enumerate(linkage.joints):
        if chords and number not in joints:
            joints[number] = joint_motions(joint, displacements[number], parts.get(joint.parts[0], still), scale)[0]
    return Places(scale, parts, joints)


def joint_motions(joint: Joint, q: Float[Array, "poses _"], part_1: Rigid, scale: Scale) -> tuple[Motions, Rigid]:
    """Find the elementary motions of a joint in each pose, and the displacement of part 2, from that of part 1."""
    found = jnp.broadcast_to(part_1, (3, 4, q.shape[0]))
    twists: list[Twist] = []
    bends: list[dict[int, Twist]] = []
    units, pitch = scale.of_coordinates(joint), jnp.asarray(joint.pitch, float)
    first = 0
    for number, (movement, frame) in enumerate(zip(joint.movements, joint.frames_1, strict=True)):
        if number:
            found = product(found, inverse(as_rigid(jnp.asarray(joint.frames_2[number - 1], float))))
        found = product(found, as_rigid(jnp.asarray(frame, float)))
        curve = joint.curves[number] if joint.curves else None
        spline = None if curve is None else curve.spline(jnp)
        count = len(MOVEMENTS[movement].coordinates)
        values = tuple(q[:, first : first + count].T)
        point = None if spline is None else spline.at(*values, xp=jnp)
        for element in MOVEMENTS[movement].elements:
            unit = units[first + element.coordinate]
            twists.append(_twist(found, element, scale, unit, rates(element, pitch, point)))
            bends.append({})
            if element.law is not None and spline is not None:
                along = partial(_followed_rates, element, spline)
                for k in range(count):
                    by_k = tuple(jnp.full_like(each, units[first + k] * (j == k)) for j, each in enumerate(values))
                    changes = jax.jvp(along, values, by_k)[1]
                    bends[-1][first + k] = _twist(found, element, scale, unit, changes)
            how_far = amount(element, values[element.coordinate], pitch, point, cos_sin)
            columns = displaced_columns([found[:, column] for column in range(4)], element.axis, *how_far)
            found = jnp.stack(columns, axis=1)
        first += count
    last = as_rigid(jnp.asarray(joint.frames_2[-1], float)) if len(joint.frames_2) else as_rigid(jnp.eye(4))
    # found once: XLA would find the whole chain anew wherever it is used
    motions = Motions(scale.arm(found[:, 3]), tuple(twists), tuple(bends))
    return lax.optimization_barrier((motions, product(found, inverse(last))))


def _twist(frame: Rigid, element: ElementaryMotion, scale: Scale, unit: Any, by_coordinate: tuple[Any, Any]) -> Twist:
    """Compute the unit twist of an elementary motion of a frame.

    `by_coordinate` are the derivatives of its length and of its angle with respect to the coordinate, whose unit is
    `unit`.
    """
    slides, turns = (each * unit for each in by_coordinate)
    axis = frame[:, element.axis]
    return jnp.concatenate([turns * axis, turns * cross(scale.arm(frame[:, 3]), axis) + slides / scale.size * axis])


def _followed_rates(
    element: ElementaryMotion, spline: FollowedSpline, *q: Float[Array, " poses"]
) -> tuple[Array, Array]:
    """Differentiate length and angle of a motion along a curve, or over a surface, with respect to its coordinate."""
    slides, turns = rates(element, None, spline.at(*q, xp=jnp))
    return slides * jnp.ones_like(q[0]), turns * jnp.ones_like(q[0])


def relative_twist(joint: Joint, own: Motions, rates: Float[Array, "poses _"], scale: Scale) -> Twist:
    """Compute the twist of part 2 of a joint relative to part 1; `rates` are in the unit of the mechanism."""
    units = scale.of_coordinates(joint)
    motions = zip(coordinates_of_motions(joint), own.twists, strict=True)
    terms = (twist * (rates[:, k] / units[k]) for k, twist in motions)
    return sum(terms, jnp.zeros((6, rates.shape[0])))


def twists_of_parts(
    linkage: Linkage, at: Places, first: Sequence[Array], second: Sequence[Array] | None = None
) -> tuple[dict[str, Twist], dict[str, Twist]]:
    """Compute the twists of all parts that are not fixed, and their derivatives by time, from rates of all joints.

    `first` and `second` derivatives of the displacements are in radians and the unit of the mechanism, (poses,
    coordinates); without second ones the twists have no derivatives.
    """
    none = jnp.zeros((6, first[0].shape[0]))
    twists: dict[str, Twist] = {}
    changes: dict[str, Twist] = {}
    for part, parent, number, sign in linkage.structure.tree:
        joint, own = linkage.joints[number], at.joints[number]
        before = twists.get(parent, none)
        twists[part] = lax.optimization_barrier(before + sign * relative_twist(joint, own, first[number], at.scale))
        if second is None:
            continue
        here = before if sign > 0 else twists[part]
        units = at.scale.of_coordinates(joint)
        change = none
        for k, twist, bend in zip(coordinates_of_motions(joint), own.twists, own.bends, strict=True):
            rate = first[number][:, k] / units[k]
            change = change + twist * (second[number][:, k] / units[k]) + bracket(here, twist) * rate
            for j, by_j in bend.items():
                change = change + by_j * (first[number][:, j] / units[j]) * rate
            here = here + twist * rate
        changes[part] = lax.optimization_barrier(changes.get(parent, none) + sign * change)
    return twists, changes


def bracket(one: Twist, other: Twist) -> Twist:
    """Compute the Lie bracket [one, other]: the derivative of `other` while a body with the twist `one` carries it."""
    return jnp.concatenate([cross(one[:3], other[:3]), cross(one[:3], other[3:]) + cross(one[3:], other[:3])])


def velocity_at(twist: Twist, arm: Float[Array, "3 _"]) -> Float[Array, "3 poses"]:
    """Compute the velocity of a point of a body, v + w x arm, over the size."""
    return twist[3:] + cross(twist[:3], arm)


def cross(one: Float[Array, "3 _"], other: Float[Array, "3 _"]) -> Float[Array, "3 _"]:
    """Compute the cross product in each pose; either vector may have a last axis of one."""
    (a, b, c), (x, y, z) = one, other
    return jnp.stack([b * z - c * y, c * x - a * z, a * y - b * x])


def turned(rotation: Float[Array, "3 _ _"], vector: Float[Array, "3 ..."]) -> Float[Array, "3 _"]:
    """Rotate a vector by the first three columns of a matrix, in each pose."""
    return rotation[:, 0] * vector[0] + rotation[:, 1] * vector[1] + rotation[:, 2] * vector[2]


def wrench_at(arm: Float[Array, "3 _"], force: Float[Array, "3 _"]) -> Float[Array, "6 _"]:
    """Compute the wrench of a force, newtons, at a point: arm x force, which is the torque over the size, and force."""
    torque = cross(arm, force)
    return jnp.concatenate([torque, jnp.broadcast_to(force, torque.shape)])
