"""Evaluate the closure of loops (Eq. 10 to 12): residual and Jacobian, with only the equations that the loops need.

A loop whose joints all move in parallel planes has three equations (`planar`), any other at most six (`spatial`), of
the twelve of Eq. 11. The residual norm, which decides whether a pose is closed (Eq. 13), is always over all twelve.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.closure.planar import Planar, planar_closure, planar_geometry
from jaxkin.solve.closure.spatial import Spatial, spatial_closure, spatial_geometry
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, is_driven

Geometry = Spatial | Planar
Given = Array | np.ndarray


class Closure(NamedTuple):
    residual: Float[Array, "equations poses"]
    """Of loops in space: rotation of those that are not cut at a ball, translation of all but rods, and for each rod
    the difference of its length from that between its balls. Of planar loops: turn and two translations of each."""
    jacobian: Float[Array, "equations columns poses"]
    merit: Float[Array, " poses"]
    """Half the sum of squares of Eq. 12, rotation entries weighted by 1/2: nearby half the square of `residual`."""
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12 over all twelve equations of all loops, lengths over the characteristic length."""


def closure(system: LoopSystem, geometry: Geometry, state: State) -> Closure:
    """Evaluate residual, Jacobian and norms of all loops, lengths over the characteristic length."""
    if isinstance(geometry, Planar):
        residual, jacobian, rotated, moved = planar_closure(system, geometry, state.x)
        return Closure(residual, jacobian, 0.5 * (0.5 * rotated + moved), jnp.sqrt(rotated + moved + geometry.off))
    residual, jacobian, rotated, moved = spatial_closure(system, geometry, state)
    return Closure(residual, jacobian, 0.5 * (0.5 * rotated + moved), jnp.sqrt(rotated + moved))


def loop_geometry(
    system: LoopSystem, frames_1: tuple[Given, ...], frames_2: tuple[Given, ...], pitch: tuple[Given, ...]
) -> tuple[Geometry, Float[Array, ""]]:
    """Compute the constants of the loops from the frames of the joints, and the characteristic length.

    All arguments have one entry a joint. The origin is moved to the centroid of the frames on part 1, and lengths are
    divided by the root-mean-square distance of these from it (the characteristic length), so that no result depends on
    unit or origin. Both are held constant in derivatives, in which they cancel.
    """
    frames_1, frames_2, pitch = jax.tree.map(lambda leaf: jnp.asarray(leaf, float), (frames_1, frames_2, pitch))
    origins = lax.stop_gradient(jnp.concatenate([frames[:, :3, 3] for frames in frames_1]))
    centre = jnp.mean(origins, axis=0)
    radius = jnp.sqrt(jnp.mean(jnp.sum((origins - centre) ** 2, axis=1)))
    length = jnp.where(radius > 0, radius, 1.0)

    frames = jnp.concatenate([*frames_1, *frames_2])
    frames = frames.at[:, :3, 3].set((frames[:, :3, 3] - centre) / length)
    frames = jnp.concatenate([frames, jnp.eye(4, dtype=frames.dtype)[None]])
    space = spatial_geometry(system, frames, jnp.stack(pitch) / length)
    return planar_geometry(system, space) if system.planar else space, length


def scaled_geometry(system: LoopSystem, joints: Joints) -> tuple[Geometry, Float[Array, "columns 1"]]:
    """The geometry over the characteristic length, and the factors from its coordinates to those of the mechanism."""
    geometry, length = loop_geometry(system, *joints)
    return geometry, jnp.where(jnp.array(system.is_length, bool), length, 1.0)[:, None]


def free_jacobian(system: LoopSystem, evaluation: Closure) -> Float[Array, "equations columns poses"]:
    """Set the columns of driven coordinates to zero: least-norm steps do not move these."""
    return jnp.where(is_driven(system), 0.0, evaluation.jacobian)
