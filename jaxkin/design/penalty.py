"""What a design is charged for that cannot close everywhere: its closure residual, as a differentiable number.

Where the loops cannot close, the solver gives the pose of least residual. By the envelope theorem the derivative of the
least residual with respect to the design is that of the residual with the joint displacements held: an optimiser can go
back along it to designs that close, and through designs that do not.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.motion.drive import resolve
from jaxkin.motion.motion import Motion, inverse, joint_matrix


def closure_gaps(motion: Motion) -> Float[Array, " poses"]:
    """Square root of Eq. 12 of the poses that did not close (zero for all others), rotation entries weighted by 1/2.

    Lengths are taken from the centroid of the joints of their loops and divided by their root-mean-square distance
    from it, as the solver does. Driven displacements are differentiated, all others are held.
    """
    mechanism = motion.mechanism
    held = [lax.stop_gradient(displacement) for displacement in motion.displacements]
    for entry in resolve(mechanism, motion.inputs).values():
        values = jnp.where(jnp.isfinite(entry.values), entry.values, 0.0)
        held[entry.joint] = held[entry.joint].at[:, entry.coordinate].set(values)
    square = jnp.zeros(len(motion))
    for block in mechanism.structure.blocks:
        joints = [mechanism.all_joints[joint] for joint in block.joints]
        origins = jnp.concatenate([jnp.asarray(joint.before)[:, :3, 3] for joint in joints])
        centre = origins.mean(axis=0)
        spread = jnp.mean(jnp.sum((origins - centre) ** 2, axis=1))
        size = jnp.sqrt(jnp.where(spread > 0, spread, 1.0))
        matrices = {joint: joint_matrix(mechanism.all_joints[joint], held[joint]) for joint in block.joints}
        for loop in block.loops:
            pose = jnp.eye(4)
            for joint, sign in loop:
                pose = pose @ (matrices[joint] if sign > 0 else inverse(matrices[joint]))
            turned = jnp.sum((pose[:, :3, :3] - jnp.eye(3)) ** 2, axis=(1, 2))
            moved = pose[:, :3, 3] + jnp.einsum("pij,j->pi", pose[:, :3, :3] - jnp.eye(3), centre)
            square = square + 0.5 * turned + jnp.sum((moved / size) ** 2, axis=1)
    failed = ~motion.closed & (square > 1e-24)
    return jnp.where(failed, jnp.sqrt(jnp.where(failed, square, 1.0)), 0.0)
