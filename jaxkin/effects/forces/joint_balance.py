"""A joint in the balance of all parts: the norm of what it transmits, and the equations along its freedoms.

See `jaxkin.effects.forces.balance` for P, S and T.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.forces.screws import Twist, Wrench, cross, velocity_at
from jaxkin.solve.linear.orthonormal_rows import orthonormal_rows


class JointBalance(NamedTuple):
    """What a joint lets through in each pose, about the middle of the mechanism."""

    arm: Float[Array, "3 poses"]
    """The point of the joint, from the middle over the size."""
    screws: Float[Array, "free 6 poses"]
    """S^T: unit twists of its free coordinates."""
    made_by: Float[Array, "free free poses"]
    """T, which makes them orthonormal at the point of the joint: T S^T = U^T."""

    def along(self, wrench: Wrench) -> Float[Array, "free poses"]:
        """Compute S^T w, the loads along the freedoms."""
        return jnp.sum(self.screws * wrench[None], axis=1)

    def scaled(self, rows: Float[Array, "free *sides poses"]) -> Float[Array, "free *sides poses"]:
        """Multiply rows by T: equations along the freedoms, whose errors have the norm of wrenches."""
        made_by = self.made_by if rows.ndim == 2 else self.made_by[:, :, None]
        return jnp.sum(made_by * rows[None], axis=1)


def joint_balances(
    arms: Sequence[Float[Array, "3 poses"]], every: Sequence[Sequence[Twist]], free: Sequence[Sequence[int]]
) -> list[JointBalance]:
    """Select for each joint, whose point is at an arm, the `free` ones of the unit twists of all its coordinates."""
    poses = arms[0].shape[1]
    found = [JointBalance(arm, jnp.zeros((0, 6, poses)), jnp.zeros((0, 0, poses))) for arm in arms]
    counts = [len(own) for own in free]
    for count in sorted({*counts} - {0}):
        # at once: one by one, their operations are a long program
        alike = [number for number, own in enumerate(counts) if own == count]
        screws = jnp.stack([jnp.stack([every[number][k] for k in free[number]], axis=1) for number in alike], axis=2)
        arm = jnp.stack([arms[number] for number in alike], axis=1)
        # the norm is taken at the point of the joint
        rows = jnp.concatenate([screws[:3], velocity_at(screws, arm[:, None])])
        made_by = jax.vmap(lambda one: orthonormal_rows(one).made_by)(jnp.moveaxis(rows, (2, 1), (0, 1)))
        for place, number in enumerate(alike):
            found[number] = found[number]._replace(screws=screws[:, :, place].swapaxes(0, 1), made_by=made_by[place])
    return found


def at_points(arms: Float[Array, "3 joints poses"], wrenches: Float[Array, "6 joints poses"]) -> Array:
    """Refer the wrenches of joints to their points."""
    return jnp.concatenate([wrenches[:3] - cross(arms, wrenches[3:]), wrenches[3:]])


def norm_gradients(arms: Float[Array, "3 joints poses"], wrenches: Float[Array, "6 joints poses"]) -> Array:
    """Differentiate |w|^2 / 2 with respect to the wrench w of each joint, the norm taken at its point."""
    own = at_points(arms, wrenches)
    return jnp.concatenate([own[:3], own[3:] + cross(arms, own[:3])])
