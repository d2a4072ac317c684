"""Evaluate the closure equations of loops (Eq. 10 to 12): residual, Jacobian and norms.

A loop whose joints all move in parallel planes has three equations (`planar`), any other at most six (`spatial`), of
the twelve of Eq. 11. The residual norm, which decides whether a pose is closed (Eq. 13), is always over all twelve.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.solve.closure.couplings import coupling_closure, scaled_couplings
from jaxkin.solve.closure.loop_closure import LoopClosure
from jaxkin.solve.closure.planar import Planar, planar_closure, planar_geometry
from jaxkin.solve.closure.spatial import spatial_closure
from jaxkin.solve.closure.spatial_geometry import Spatial, spatial_geometry
from jaxkin.solve.system.joints import CouplingNumbers, Joints, scaled_frames
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, is_driven


class Geometry(NamedTuple):
    """The constants of a loop system, lengths over the characteristic length."""

    loops: Spatial | Planar
    couplings: tuple[CouplingNumbers, ...]


class Closure(NamedTuple):
    """The closure equations of a loop system at many poses, lengths over the characteristic length."""

    residual: Float[Array, "equations poses"]
    """The equations that the loops need. Loops in space: rotations of the loops that are not cut at a ball, then
    translations of all but those cut at a rod, then for each rod the difference between the lengths of its two chains
    (rows as in `LoopSystem.sections`). Planar loops: for each loop its rotation and two translations. Couplings come
    last, one equation each."""
    jacobian: Float[Array, "equations columns poses"]
    """Derivative of `residual` with respect to the columns of the loop system, driven columns included."""
    merit: Float[Array, " poses"]
    """Half the sum of squares of Eq. 12, rotation entries weighted by 1/2: near closure half the square of
    `residual`."""
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12 over all twelve equations of all loops, and the equations of all couplings; lengths over
    the characteristic length."""


def closure(system: LoopSystem, geometry: Geometry, state: State) -> Closure:
    """Evaluate residual, Jacobian and norms of all loops at a state, lengths over the characteristic length."""
    poses, off_plane = state.x.shape[-1], 0.0
    if not system.loops:  # couplings of joints in no loop
        jacobian = jnp.zeros((0, system.columns, poses))
        of_loops = LoopClosure(jnp.zeros((0, poses)), jacobian, jnp.zeros(poses), jnp.zeros(poses))
    elif isinstance(geometry.loops, Planar):
        of_loops = planar_closure(system, geometry.loops, state.x)
        off_plane = geometry.loops.off_plane
    else:
        of_loops = spatial_closure(system, geometry.loops, state)
    residual, jacobian, of_rotation, of_rest = of_loops
    if system.couplings:
        of_couplings, slopes = coupling_closure(system, geometry.couplings, state.x)
        residual, jacobian = jnp.concatenate([residual, of_couplings]), jnp.concatenate([jacobian, slopes])
        of_rest = of_rest + jnp.sum(of_couplings**2, axis=0)
    # squares of Eq. 12: those of rotation entries, and those of translations and couplings
    merit, square = 0.5 * (0.5 * of_rotation + of_rest), of_rotation + of_rest + off_plane
    return Closure(residual, jacobian, merit, jnp.sqrt(square))


def loop_geometry(system: LoopSystem, joints: Joints, constant: bool = True) -> tuple[Geometry, Float[Array, ""]]:
    """Compute the constants of a loop system from the numbers of its joints, and the characteristic length.

    The constants are those of `scaled_frames`, and so is `constant`.
    """
    frames_1, frames_2, pitch = jax.tree.map(lambda leaf: jnp.asarray(leaf, float), joints[:3])
    frames, length = map(jnp.asarray, scaled_frames(frames_1, frames_2, constant=constant))
    splines = tuple(
        jax.tree.map(lambda leaf: jnp.asarray(leaf, float), curve).over(length).spline(jnp)
        for curve in (curve for own in joints.curves for curve in own)
        if curve is not None
    )
    space = spatial_geometry(system, frames, jnp.stack(pitch) / length, splines)
    loops = planar_geometry(system, space) if system.planar else space
    return Geometry(loops, scaled_couplings(system, joints.couplings, length)), length


def scaled_geometry(
    system: LoopSystem, joints: Joints, constant: bool = True
) -> tuple[Geometry, Float[Array, "columns 1"]]:
    """Compute the scaled geometry, and for each column the factor from its scaled coordinate to that of the mechanism.

    The factor is 1 for angles and the characteristic length for lengths; see `scaled_frames` for `constant`.
    """
    geometry, length = loop_geometry(system, joints, constant)
    return geometry, jnp.where(jnp.array(system.is_length, bool), length, 1.0)[:, None]


def free_jacobian(system: LoopSystem, evaluation: Closure) -> Float[Array, "equations columns poses"]:
    """Return the Jacobian with the columns of driven coordinates zero: least-norm steps then do not move these."""
    return jnp.where(is_driven(system), 0.0, evaluation.jacobian)
