"""Weight and inertia of all parts that move, as wrenches; of all parts at once, since one by one their operations are a
long program to compile."""

from __future__ import annotations

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.moving_parts import MovingParts
from jaxkin.effects.forces.screws import Scale, Twist, Wrench, cross, turned, velocity_at, wrench_at
from jaxkin.geometry.rigid import Rigid


def weights_and_inertia(moving: MovingParts, masses: Masses, gravity: Any, lever: Any) -> dict[str, Wrench]:
    """Compute what weight and inertia do on each part; `lever` is the size of the mechanism in metres."""
    parts = list(moving.at.parts)
    if not parts:
        return {}
    numbers = np.array([masses.parts.index(part) for part in parts])
    displaced = jnp.stack([moving.at.parts[part] for part in parts])
    own = tuple(jnp.asarray(each, float)[numbers] for each in (masses.mass, masses.centre, masses.inertia))
    twists = [jnp.stack([rows[part] for part in parts]) for rows in (moving.twists, moving.changes) if rows]
    of_mass = partial(_of_mass, moving.at.scale, gravity, lever)
    # found once: XLA would find all of it anew wherever it is used
    found = lax.optimization_barrier(jax.vmap(of_mass)(displaced, *own, *twists))
    return {part: found[place] for place, part in enumerate(parts)}


def _of_mass(
    scale: Scale,
    gravity: Any,
    lever: Any,
    displaced: Rigid,
    mass: Float[Array, ""],
    centre: Float[Array, "3"],
    inertia: Float[Array, "3 3"],
    twist: Twist | None = None,
    change: Twist | None = None,
) -> Wrench:
    """Compute weight and inertia of a part: the force m (g - a) at its centre, the torque -(I w' + w x I w).

    `displaced` is the part in each pose; without its `twist` and the derivative of that it is at rest.
    """
    arm = scale.arm(turned(displaced, centre) + displaced[:, 3])
    force = mass * gravity[:, None]
    if twist is None or change is None:
        return wrench_at(arm, force)
    turning = twist[:3]
    acceleration = velocity_at(change, arm) + cross(turning, velocity_at(twist, arm))
    # In the axes of the part its inertia is constant. By sums, which XLA computes once for all that uses them.
    rotation, both = displaced[:, :3], jnp.stack([change[:3], turning], axis=1)
    own = jnp.sum(rotation[:, :, None] * both[:, None], axis=0)
    of_inertia = jnp.sum(inertia[:, :, None, None] * own[None], axis=1)
    torque = jnp.sum(rotation * (of_inertia[:, 0] + cross(own[:, 1], of_inertia[:, 1]))[None], axis=1)
    wrench = wrench_at(arm, force - mass * lever * acceleration)
    return jnp.concatenate([wrench[:3] - torque / lever, wrench[3:]])
