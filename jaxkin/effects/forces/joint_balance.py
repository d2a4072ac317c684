"""A joint in the balance of all parts: the norm of what it transmits, and the equations along its freedoms.

See `jaxkin.effects.forces.balance` for P and S.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.forces.screws import Twist, cross, velocity_at
from jaxkin.solve.linear.ldl import factor_ldl

DEPENDENT = 1e4
"""What is added to S^T S, in units of rounding times its mean square, where coordinates of a joint may depend on each
other."""

Wrenches = Float[Array, "6 poses"]
"""Torque over the size of the mechanism, then force: newtons. About the middle of the mechanism."""


class JointBalance(NamedTuple):
    """A joint in each pose: the norm of its wrenches, and what it lets through, about the middle of the mechanism."""

    arm: Float[Array, "3 poses"]
    screws: list[Twist]
    """Unit twists of its free coordinates."""
    inverse: Float[Array, "free free poses"]
    """(S^T S)^-1."""

    @staticmethod
    def of(arm: Float[Array, "3 poses"], every: Sequence[Twist], free: Sequence[int]) -> JointBalance:
        own, poses = [every[k] for k in free], arm.shape[1]
        if not own:
            return JointBalance(arm, [], jnp.zeros((0, 0, poses)))
        # the norm is taken at the point of the joint
        rows = jnp.stack([jnp.concatenate([s[:3], velocity_at(s, arm)]) for s in own])
        unit = jnp.broadcast_to(jnp.eye(len(own))[..., None], (len(own), len(own), poses))
        return JointBalance(arm, own, factor_ldl(rows, DEPENDENT * float(jnp.finfo(arm.dtype).eps))(unit))

    def along(self, wrench: Wrenches) -> list[Float[Array, " poses"]]:
        """S^T w."""
        return [jnp.sum(s * wrench, axis=0) for s in self.screws]

    def metric(self, rows: Float[Array, "free *sides poses"]) -> Float[Array, "free *sides poses"]:
        """(S^T S)^-1 times rows."""
        if not self.screws:
            return rows
        inverse = self.inverse if rows.ndim == 2 else self.inverse[:, :, None]
        return jnp.sum(inverse * rows[None], axis=1)

    def at_point(self, wrench: Wrenches) -> Wrenches:
        """The wrench about the point of the joint."""
        return jnp.concatenate([wrench[:3] - cross(self.arm, wrench[3:]), wrench[3:]])

    def normed(self, wrench: Wrenches) -> Wrenches:
        """Derivative of |w|^2 / 2 by the wrench, the norm taken at the point of the joint."""
        own = self.at_point(wrench)
        return jnp.concatenate([own[:3], own[3:] + cross(self.arm, own[:3])])

    def norm(self) -> Float[Array, "6 6 poses"]:
        """Second derivative of |w|^2 / 2, the norm taken at the point of the joint."""
        x, y, z = self.arm
        none = jnp.zeros_like(x)
        lever = jnp.stack([none, -z, y, z, none, -x, -y, x, none]).reshape(3, 3, -1)
        eye = jnp.broadcast_to(jnp.eye(3)[..., None], lever.shape)
        outer = (1 + jnp.sum(self.arm**2, axis=0)) * eye - self.arm[:, None] * self.arm[None]
        return jnp.concatenate(
            [jnp.concatenate([eye, -lever], axis=1), jnp.concatenate([lever, outer], axis=1)], axis=0
        )

    def stiffness(self, kappa: float) -> Float[Array, "6 6 poses"]:
        """Second derivative of |P w|^2 / 2, and of the penalty of S^T w."""
        if not self.screws:
            return self.norm()
        rows = jnp.stack(self.screws)
        weighted = (kappa - 1) * self.metric(rows)
        return self.norm() + sum(s[:, None] * w[None] for s, w in zip(rows, weighted, strict=True))
