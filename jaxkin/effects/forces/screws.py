"""Compute with twists and wrenches of many poses.

Twists are (angular velocity; velocity of the point of the body at the middle of the mechanism), in world axes, lengths
over the size of the mechanism: also in coordinates that are lengths. The poses are the last axis.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.geometry.characteristic_length import centroid_and_length
from jaxkin.geometry.movements import is_length
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage

Twist = Float[Array, "6 poses"]
"""Angular velocity, then linear velocity over the size of the mechanism."""
Wrench = Float[Array, "6 _"]
"""Torque about the middle of the mechanism over its size, then force: newtons. The last axis is the poses, or one for
all poses."""


class Scale(NamedTuple):
    """The point about which moments are taken, and the length by which they are divided."""

    size: Float[Array, ""]
    """The characteristic length of all joints, not only those of a loop group, in the unit of the mechanism: their root
    mean square distance from the middle; 1 where it is zero."""
    middle: Float[Array, "3"]
    """The centroid of the joint frames in the assembled pose, world coordinates."""

    @staticmethod
    def of(linkage: Linkage, xp: Any = jnp) -> Scale:
        """Find size and middle of a linkage, by jax.numpy or numpy as `xp`."""
        origins = xp.concatenate([xp.asarray(joint.frames_1, float) for joint in linkage.joints])[:, :3, 3]
        middle, size = centroid_and_length(origins, xp)
        return Scale(size, middle)

    def arm(self, points: Float[Array, "3 *poses"]) -> Float[Array, "3 *poses"]:
        """Compute the vectors from the middle to points of the world, over the size."""
        return (points - self.middle.reshape(3, *[1] * (points.ndim - 1))) / self.size

    def of_coordinates(self, joint: Joint) -> list[Any]:
        """List the unit of each coordinate of a joint: the size for lengths, 1 for angles."""
        return [self.size if is_length(name) else 1.0 for name in joint.coordinates]


def bracket(one: Twist, other: Twist) -> Twist:
    """Compute the Lie bracket [one, other]: the derivative of `other` while a body with the twist `one` carries it."""
    return jnp.concatenate([cross(one[:3], other[:3]), cross(one[:3], other[3:]) + cross(one[3:], other[:3])])


def velocity_at(twist: Twist, arm: Float[Array, "3 _"]) -> Float[Array, "3 poses"]:
    """Compute the velocity of a point of a body, v + w x arm, over the size."""
    return twist[3:] + cross(twist[:3], arm)


def cross(one: Float[Array, "3 *#rows"], other: Float[Array, "3 *#rows"]) -> Float[Array, "3 *rows"]:
    """Compute the cross product in each pose; either vector may have axes of one behind the first."""
    (a, b, c), (x, y, z) = one, other
    return jnp.stack([b * z - c * y, c * x - a * z, a * y - b * x])


def turned(rotation: Float[Array, "3 _ _"], vector: Float[Array, "3 ..."]) -> Float[Array, "3 _"]:
    """Rotate a vector by the first three columns of a matrix, in each pose."""
    return rotation[:, 0] * vector[0] + rotation[:, 1] * vector[1] + rotation[:, 2] * vector[2]


def wrench_at(arm: Float[Array, "3 _"], force: Float[Array, "3 _"]) -> Float[Array, "6 _"]:
    """Compute the wrench of a force, newtons, at a point: arm x force, which is the torque over the size, and force."""
    torque = cross(arm, force)
    return jnp.concatenate([torque, jnp.broadcast_to(force, torque.shape)])
