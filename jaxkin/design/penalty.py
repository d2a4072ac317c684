"""What a design is charged for that cannot close everywhere: its closure residual, as a differentiable number.

Where the loops cannot close, the solver gives the pose of least residual. By the envelope theorem the derivative of the
least residual with respect to the design is that of the residual with the joint displacements held: an optimiser can go
back along it to designs that close, and through designs that do not.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.characteristic_length import centroid_and_length
from jaxkin.linkage.coordinates import resolve
from jaxkin.linkage.joint_motion import loop_motion
from jaxkin.linkage.loop_class import LoopClass
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.closure.couplings import coupling_closure, scaled_couplings
from jaxkin.solve.system.from_linkage import group_joints, group_system


def closure_gaps(motion: Motion) -> Float[Array, " poses"]:
    """Compute the square root of Eq. 12 of the poses that did not close (zero for all others), rotation entries
    weighted by 1/2.

    Squares of the equations of couplings are added.
    Lengths are taken from the centroid of the joints of their loops and divided by their root-mean-square distance
    from it, as the solver does. Driven displacements are differentiated, all others are held.
    """
    mechanism = motion.mechanism
    held = [lax.stop_gradient(displacement) for displacement in motion.displacements]
    for entry in resolve(mechanism.linkage, motion.inputs).values():
        values = jnp.where(jnp.isfinite(entry.values), entry.values, 0.0)
        held[entry.joint] = held[entry.joint].at[:, entry.coordinate].set(values)
    square = jnp.zeros(len(motion))
    for loop_group in mechanism.structure.loop_groups:
        joints = [mechanism.all_joints[joint] for joint in loop_group.joints]
        origins = jnp.concatenate([jnp.asarray(joint.frames_1)[:, :3, 3] for joint in joints])
        centre, size = centroid_and_length(origins)
        for loop in loop_group.loops:
            end = loop_motion(mechanism.all_joints, held, loop)
            turned = end[:, :3] - jnp.eye(3)[..., None]
            moved = end[:, 3] + jnp.einsum("ijp,j->ip", turned, centre)
            square = square + 0.5 * jnp.sum(turned**2, axis=(0, 1)) + jnp.sum((moved / size) ** 2, axis=0)
        if loop_group.couplings:
            system, columns = group_system(mechanism.linkage, loop_group, (), LoopClass())
            numbers = group_joints(mechanism.linkage, mechanism.all_joints, loop_group).couplings
            lengths = jnp.where(np.array(system.is_length), size, 1.0)[:, None]
            x = jnp.stack([held[joint][:, k] for joint, k in columns]) / lengths
            misfit, _ = coupling_closure(system, scaled_couplings(system, numbers, size), x)
            square = square + jnp.sum(misfit**2, axis=0)
    failed = ~motion.closed & (square > 1e-24)
    return jnp.where(failed, jnp.sqrt(jnp.where(failed, square, 1.0)), 0.0)
