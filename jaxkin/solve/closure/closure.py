"""Closure of the loops (Eq. 10): residual and Jacobian, with only the equations that the loops need.

Loops whose joints all move in parallel planes have three equations each, all others six at most: `planar` and
`spatial`. What `gap` reports, and what decides whether a pose is closed, is Eq. 12 over all twelve.
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
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State

Geometry = Spatial | Planar
Given = Array | np.ndarray


class Closure(NamedTuple):
    residual: Float[Array, "equations poses"]
    """Rotation of each loop in space that is whole, translation of each, or difference in length from a rod; of planar
    loops one after the other."""
    jacobian: Float[Array, "equations columns poses"]
    merit: Float[Array, " poses"]
    """Half the sum of squares of Eq. 12, rotation entries weighted by 1/2: half the square of the residual nearby."""
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12 over all twelve equations of all loops, lengths over the characteristic length."""


def closure(system: LoopSystem, geometry: Geometry, state: State) -> Closure:
    """Residual and Jacobian of all loops, lengths over the characteristic length."""
    if isinstance(geometry, Planar):
        residual, jacobian, rotated, moved = planar_closure(system, geometry, state.x)
        return Closure(residual, jacobian, 0.5 * (0.5 * rotated + moved), jnp.sqrt(rotated + moved + geometry.off))
    residual, jacobian, rotated, moved = spatial_closure(system, geometry, state)
    return Closure(residual, jacobian, 0.5 * (0.5 * rotated + moved), jnp.sqrt(rotated + moved))


def loop_geometry(
    system: LoopSystem, before: tuple[Given, ...], after: tuple[Given, ...], pitch: tuple[Given, ...]
) -> tuple[Geometry, Float[Array, ""]]:
    """The constants of the loops from the frames of the joints, one entry a joint, and the characteristic length.

    Frames are taken from their centroid and lengths over their root-mean-square distance from it, so that the result
    depends on neither unit nor origin. Both are held constant in derivatives: they cancel.
    """
    before, after, pitch = jax.tree.map(lambda leaf: jnp.asarray(leaf, float), (before, after, pitch))
    origins = lax.stop_gradient(jnp.concatenate([frames[:, :3, 3] for frames in before]))
    centre = jnp.mean(origins, axis=0)
    radius = jnp.sqrt(jnp.mean(jnp.sum((origins - centre) ** 2, axis=1)))
    length = jnp.where(radius > 0, radius, 1.0)

    frames = jnp.concatenate([*before, *after])
    frames = frames.at[:, :3, 3].set((frames[:, :3, 3] - centre) / length)
    frames = jnp.concatenate([frames, jnp.eye(4, dtype=frames.dtype)[None]])
    space = spatial_geometry(system, frames, jnp.stack(pitch) / length)
    return planar_geometry(system, space) if system.planar else space, length
