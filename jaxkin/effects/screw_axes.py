"""Instantaneous screw axes of a part along a motion; in the plane their points are the centrodes."""

from __future__ import annotations

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.rates import Rates


@dataclass(frozen=True, eq=False)
class ScrewAxes:
    """The instantaneous screw axes of a part: it turns about them, and slides along them. A pytree."""

    direction: Float[Array, "poses 3"]
    """Unit vectors along the angular velocity, world axes."""
    point: Float[Array, "poses 3"]
    """The point of each axis that is nearest to the origin of the world: in the plane the fixed centrode."""
    moving: Float[Array, "poses 3"]
    """The same point, where it is on the part in the assembled pose: in the plane the moving centrode."""
    pitch: Float[Array, " poses"]
    """Advance along the axis per radian, in the unit of the mechanism; the `pitch` of `jk.screw` is per turn."""


jax.tree_util.register_dataclass(ScrewAxes, data_fields=["direction", "point", "moving", "pitch"], meta_fields=[])


def screw_axes(velocities: Rates, part: str) -> ScrewAxes:
    """Find the instantaneous screw axes of a part from `jk.velocities`: NaN in poses in which it does not turn.

    With the velocity v of the material point at the origin of the world and the angular velocity w, the axis passes
    through w x v / w^2, and the pitch is w . v / w^2. Works inside `jit`, `vmap` and `grad`. Raises ValueError for a
    part that is not there.
    """
    if not isinstance(velocities, Rates):
        raise ValueError(f"screw axes are those of jk.velocities(motion, rates), got {type(velocities).__name__}")
    omega = velocities.angular(part)
    place, rates = velocities.motion.transforms[part], velocities.transforms[part]
    rotation, shift = place[:, :3, :3], place[:, :3, 3]
    at_origin = rates[:, :3, 3] - jnp.cross(omega, shift)
    square = jnp.sum(omega**2, axis=1, keepdims=True)
    square = jnp.where(square > 0, square, jnp.nan)
    point = jnp.cross(omega, at_origin) / square
    moving = jnp.einsum("pji,pj->pi", rotation, point - shift)
    return ScrewAxes(omega / jnp.sqrt(square), point, moving, jnp.sum(omega * at_origin, axis=1) / square[:, 0])
