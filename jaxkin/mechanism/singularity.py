"""How near to singular the poses of a motion are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._traced import traced
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.first_order import null_space
from jaxkin.solve.closure.smallest_singular_value import least_singular_value
from jaxkin.solve.system.from_linkage import Columns, block_joints, block_system

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion
    from jaxkin.solve.system.loop_system import LoopSystem


def sigma_min(motion: Motion) -> Float[Array, " poses"]:
    """See `Motion.sigma_min`."""
    mechanism = motion.mechanism
    driven = [coordinate(mechanism, name) for name in motion.inputs]
    least = jnp.full(len(motion), jnp.inf, motion.residual.dtype)
    for number, (block, form) in enumerate(zip(mechanism.structure.blocks, mechanism.forms, strict=True)):
        inside = tuple(entry for entry in driven if entry[0] in block.joints)
        system, columns = block_system(mechanism, block, inside, form)
        if inside and (rank := _rank(mechanism, number, system, columns)):
            rows = jnp.stack([motion.displacements[joint][:, coordinate] for joint, coordinate in columns])
            least = jnp.minimum(
                least, least_singular_value(system, rank, block_joints(mechanism.solved_joints, block), rows)
            )
    return least


def _rank(mechanism: Mechanism, number: int, system: LoopSystem, columns: Columns) -> int:
    """Independent equations for the free coordinates where nothing is singular.

    As many as may be where JAX traces, and where the host finds no closed pose to count them at.
    """
    if traced(mechanism.all_joints) or not mechanism.loop_freedoms[number].closes:
        return min(system.uncut.equations, len(system.free))
    freedoms = mechanism.loop_freedoms[number]
    free = [freedoms.columns.index(columns[column]) for column in system.free]
    return null_space(freedoms.jacobian[:, np.array(free, int)], freedoms.noise)[0]
