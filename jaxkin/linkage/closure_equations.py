"""The closure equations of a linkage for any displacements of its joints (Eq. 10 and 11), in plain JAX.

The solver has kernels of its own, which evaluate only the equations that a loop needs. This module evaluates all twelve
equations of each loop, for optimisers outside jaxkin and as a check of the kernels.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin._arguments import by_name, numbers
from jaxkin._names import nearest
from jaxkin.geometry.characteristic_length import centroid_and_length
from jaxkin.geometry.rigid import as_matrices, inverse, product
from jaxkin.joints.joint import Joint
from jaxkin.linkage.joint_motion import joint_motion
from jaxkin.linkage.linkage import Linkage
from jaxkin.topology.structure import Structure


@dataclass(frozen=True, eq=False)
class ClosureEquations:
    """The closure equations of all loops at one set of displacements. A pytree, whose names are static."""

    residual: Float[Array, " equations"]
    """Twelve entries a loop (Eq. 11), in the order of `structure.loops`. The displacement that is left when the loop
    has been travelled gives nine entries of rotation, its matrix less the unit matrix, row by row; and three of
    translation, from the start of the loop to its end, over the characteristic length of the loop group. The norm is
    the square root of Eq. 12, as `motion.residual`."""
    jacobian: Float[Array, "equations coordinates"]
    """Derivative of the residual with respect to the coordinates of all joints, one joint after the other."""
    coordinates: tuple[str, ...]
    """Names of the columns, "joint.coordinate"."""

    def __iter__(self) -> Iterator[Any]:
        """Unpack: `residual, jacobian, coordinates = mechanism.closure(...)`."""
        return iter((self.residual, self.jacobian, self.coordinates))


jax.tree_util.register_dataclass(ClosureEquations, data_fields=["residual", "jacobian"], meta_fields=["coordinates"])


def closure_equations(linkage: Linkage, coordinates: Mapping[str, object]) -> ClosureEquations:
    """Evaluate the closure equations and their Jacobian: see `Mechanism.closure`."""
    given = dict(by_name(coordinates, "coordinates", "{'A': 0.1, 'ball': (0.1, 0.2, 0.3)}"))
    names = linkage.structure.joints
    for name in given:
        if name not in names:
            raise ValueError(f"there is no joint {name!r}{nearest(str(name), names)}")
    rows = [_of_joint(joint, given.get(joint.name, np.zeros(joint.freedoms))) for joint in linkage.joints]
    residual, jacobian = _equations(linkage.structure, linkage.joints, jnp.concatenate([jnp.zeros(0), *rows]))
    columns = tuple(name for joint in linkage.joints for name in joint.full_names)
    return ClosureEquations(residual, jacobian, columns)


def _of_joint(joint: Joint, given: Any) -> Float[Array, " freedoms"]:
    """Check the displacements that are given for a joint, one number a coordinate; ValueError for others."""
    try:
        values = jnp.atleast_1d(numbers(given, "a displacement"))
    except ValueError:
        values = None
    if values is None or values.shape != (joint.freedoms,):
        raise ValueError(
            f"joint {joint.name!r} ({joint.kind}) has {joint.freedoms} coordinates ({', '.join(joint.coordinates)}): "
            f"give one number for each, got {given!r}"
        )
    return values


@partial(jax.jit, static_argnums=0)
def _equations(
    structure: Structure, joints: tuple[Joint, ...], coordinates: Float[Array, " coordinates"]
) -> tuple[Float[Array, " equations"], Float[Array, "equations coordinates"]]:
    def residual(q: Float[Array, " coordinates"]) -> Float[Array, " equations"]:
        return closure_residual(structure, joints, q)

    return residual(coordinates), jax.jacfwd(residual)(coordinates)


def closure_residual(
    structure: Structure, joints: tuple[Joint, ...], q: Float[Array, " coordinates"]
) -> Float[Array, " equations"]:
    """Evaluate the twelve closure equations of each loop (see `ClosureEquations`) at the coordinates of all joints."""
    motions, first = [], 0
    for joint in joints:
        motions.append(joint_motion(joint, q[None, first : first + joint.freedoms]))
        first += joint.freedoms
    scales = {}
    for group in structure.loop_groups:
        scales |= dict.fromkeys(group.joints, _scale([joints[number] for number in group.joints]))
    rows = [jnp.zeros(0, q.dtype)]
    for loop in structure.loops:
        centre, length = scales[loop.joints[0][0]]
        travelled = jnp.eye(4, dtype=q.dtype)[:3, :, None]
        for joint, sign in loop.joints:
            travelled = product(travelled, motions[joint] if sign > 0 else inverse(motions[joint]))
        left = as_matrices(travelled)[0] - jnp.eye(4, dtype=q.dtype)
        away = left[:3, 3] + left[:3, :3] @ centre
        rows.append(jnp.concatenate([left[:3, :3].ravel(), away / length]))
    return jnp.concatenate(rows)


def _scale(joints: Sequence[Joint]) -> tuple[Float[Array, "3"], Float[Array, ""]]:
    """Compute the centroid and the characteristic length of the joints of a loop group, as the solver does."""
    origins = lax.stop_gradient(jnp.concatenate([jnp.asarray(joint.frames_1)[:, :3, 3] for joint in joints]))
    return centroid_and_length(origins)
