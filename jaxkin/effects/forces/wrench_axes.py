"""The axes in which the unknown wrenches of loops are written, so that few of their components are in the equations.

The joints of loops that move in a plane turn about its normal, slide across the normal, or slide along it. Of what they
transmit only the torque about the normal and the force across it, and where something slides along the normal the force
along it, do work in their freedoms. With the normal as the first axis, the components of a wrench in the order

    torques about the second and the third axis; force along the first, the second, the third; torque about the first

begin with those that are in no equation: three, or two where something slides along the normal.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.forces.screws import Twist, Wrench, turned
from jaxkin.geometry.movements import is_length
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.linkage import Linkage


class WrenchAxes(NamedTuple):
    """The axes and the order of the components of wrenches."""

    axes: Float[Array, "3 3 poses"] | None
    """Unit vectors, the first of them the normal of the plane of the loops; None for the axes of the world, and the
    order of a `Wrench`, where they have no plane."""
    absent: int
    """Number of the components, the first ones, that are in no equation."""

    def turned(self, vectors: Float[Array, "3 *rows poses"]) -> Float[Array, "3 *rows poses"]:
        """Write vectors of the world in these axes."""
        if self.axes is None:
            return vectors
        axes = self.axes.reshape(3, 3, *[1] * (vectors.ndim - 2), -1)
        return axes[:, 0] * vectors[0] + axes[:, 1] * vectors[1] + axes[:, 2] * vectors[2]

    def in_order(self, rows: Float[Array, "6 *rows poses"]) -> Float[Array, "6 *rows poses"]:
        """Put components of a wrench in these axes, or what belongs to them, in order."""
        return rows if self.axes is None else jnp.concatenate([rows[1:], rows[:1]])

    def components(self, wrenches: Float[Array, "6 *rows poses"]) -> Float[Array, "6 *rows poses"]:
        """Write wrenches, or twists, in these axes and in order."""
        if self.axes is None:
            return wrenches
        return self.in_order(jnp.concatenate([self.turned(wrenches[:3]), self.turned(wrenches[3:])]))

    def wrench(self, components: Float[Array, "6 poses"]) -> Wrench:
        """Write a wrench in the axes of the world, from its components."""
        if self.axes is None:
            return components
        own = jnp.concatenate([components[5:], components[:5]])
        back = self.axes.swapaxes(0, 1)
        return jnp.concatenate([turned(back, own[:3]), turned(back, own[3:])])


def wrench_axes(
    linkage: Linkage,
    plane: Sequence[JointCoordinate],
    free: Sequence[JointCoordinate],
    screws: Sequence[Sequence[Twist]],
) -> WrenchAxes:
    """Choose the axes for loops of which the coordinates `plane` act in their plane, and `free` have no drive.

    `screws` are the unit twists of the coordinates of all joints.
    """
    turns = [(joint, k) for joint, k in plane if not is_length(linkage.joints[joint].coordinates[k])]
    if not turns:
        return WrenchAxes(None, 0)
    joint, k = turns[0]
    return WrenchAxes(_with_normal(screws[joint][k][:3]), 3 if set(free) <= set(plane) else 2)


def _with_normal(normal: Float[Array, "3 poses"]) -> Float[Array, "3 3 poses"]:
    """Complete a unit vector to right-handed axes, in each pose.

    They are turned by the smallest turn from x, y, z, or from -x, y, -z where that is nearer, so that no direction of
    the normal is singular.
    """
    x, y, z = normal
    sign = jnp.where(x < 0, -1.0, 1.0)
    share = 1.0 / (1.0 + jnp.abs(x))
    second = jnp.stack([-sign * y, 1.0 - share * y * y, -share * y * z])
    third = jnp.stack([-z, -sign * share * y * z, sign * (1.0 - share * z * z)])
    return jnp.stack([normal, second, third])
