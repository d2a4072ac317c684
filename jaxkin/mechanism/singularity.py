"""How near to singular the poses of a motion are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._traced import traced
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.first_order import null_space
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.solve.closure.smallest_singular_value import smallest_singular_value
from jaxkin.solve.system.from_linkage import Columns, group_joints, group_system

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion
    from jaxkin.solve.system.loop_system import LoopSystem


def sigma_min(motion: Motion) -> Float[Array, " poses"]:
    """Compute the smallest singular value of a motion: see `Motion.sigma_min`."""
    linkage = motion.mechanism.linkage
    driven = [coordinate(linkage, name) for name in motion.inputs]
    least = jnp.full(len(motion), jnp.inf, motion.residual.dtype)
    for number, (loop_group, loop_class) in enumerate(zip(linkage.structure.loop_groups, linkage.classes, strict=True)):
        inside = tuple(entry for entry in driven if entry[0] in loop_group.joints)
        system, columns = group_system(linkage, loop_group, inside, loop_class)
        if inside and (rank := _rank(linkage, number, system, columns)):
            rows = jnp.stack([motion.displacements[joint][:, coordinate] for joint, coordinate in columns])
            joints = group_joints(linkage, linkage.solved_joints, loop_group)
            least = jnp.minimum(least, smallest_singular_value(system, rank, joints, rows))
    return least


def _rank(linkage: Linkage, number: int, system: LoopSystem, columns: Columns) -> int:
    """Count the independent equations for the free coordinates, where nothing is singular.

    As many as may be where JAX traces, and where the host finds no closed pose to count them at.
    """
    if traced(linkage.joints) or not loop_freedoms(linkage)[number].closes:
        return min(system.uncut.equations, len(system.free))
    freedoms = loop_freedoms(linkage)[number]
    free = [freedoms.columns.index(columns[column]) for column in system.free]
    return null_space(freedoms.jacobian[:, np.array(free, int)], freedoms.thresholds.rank)[0]
