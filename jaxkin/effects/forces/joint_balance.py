"""A joint in the balance of all parts: the norm of what it transmits, and the equations along its freedoms.

See `jaxkin.effects.forces.balance` for P, S and T.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.forces.screws import Twist, cross, velocity_at
from jaxkin.solve.linear.orthonormal_rows import orthonormal_rows

Wrenches = Float[Array, "6 poses"]
"""Torque over the size of the mechanism, then force: newtons. About the middle of the mechanism."""


class JointBalance(NamedTuple):
    """A joint in each pose: the norm of its wrenches, and what it lets through, about the middle of the mechanism."""

    arm: Float[Array, "3 poses"]
    screws: Float[Array, "free 6 poses"]
    """S^T: unit twists of its free coordinates."""
    made_by: Float[Array, "free free poses"]
    """T, which makes them orthonormal at the point of the joint: T S^T = U^T."""

    @staticmethod
    def of(arm: Float[Array, "3 poses"], every: Sequence[Twist], free: Sequence[int]) -> JointBalance:
        """Select the `free` ones of the unit twists of all coordinates of a joint, whose point is at `arm`."""
        poses = arm.shape[1]
        if not free:
            return JointBalance(arm, jnp.zeros((0, 6, poses)), jnp.zeros((0, 0, poses)))
        screws = jnp.stack([every[k] for k in free])
        # the norm is taken at the point of the joint
        rows = jnp.stack([jnp.concatenate([s[:3], velocity_at(s, arm)]) for s in screws])
        return JointBalance(arm, screws, orthonormal_rows(rows).made_by)

    def along(self, wrench: Wrenches) -> Float[Array, "free poses"]:
        """Compute S^T w, the loads along the freedoms."""
        return jnp.sum(self.screws * wrench[None], axis=1)

    def scaled(self, rows: Float[Array, "free *sides poses"]) -> Float[Array, "free *sides poses"]:
        """Multiply rows by T: equations along the freedoms, whose errors have the norm of wrenches."""
        made_by = self.made_by if rows.ndim == 2 else self.made_by[:, :, None]
        return jnp.sum(made_by * rows[None], axis=1)

    def at_point(self, wrench: Wrenches) -> Wrenches:
        """Refer a wrench to the point of the joint."""
        return jnp.concatenate([wrench[:3] - cross(self.arm, wrench[3:]), wrench[3:]])

    def norm_gradient(self, wrench: Wrenches) -> Wrenches:
        """Differentiate |w|^2 / 2 with respect to the wrench w, the norm taken at the point of the joint."""
        own = self.at_point(wrench)
        return jnp.concatenate([own[:3], own[3:] + cross(self.arm, own[:3])])

    def norm_hessian(self) -> Float[Array, "6 6 poses"]:
        """Differentiate |w|^2 / 2 twice with respect to the wrench w, the norm taken at the point of the joint."""
        x, y, z = self.arm
        none = jnp.zeros_like(x)
        lever = jnp.stack([none, -z, y, z, none, -x, -y, x, none]).reshape(3, 3, -1)
        eye = jnp.broadcast_to(jnp.eye(3)[..., None], lever.shape)
        outer = (1 + jnp.sum(self.arm**2, axis=0)) * eye - self.arm[:, None] * self.arm[None]
        return jnp.concatenate(
            [jnp.concatenate([eye, -lever], axis=1), jnp.concatenate([lever, outer], axis=1)], axis=0
        )
