"""How near to singular the poses of a motion are."""

from __future__ import annotations

from functools import partial, reduce
from typing import TYPE_CHECKING

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._names import listed
from jaxkin._traced import traced
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.first_order import Columns, null_space
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.solve.closure.smallest_singular_value import smallest_singular_value
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.system.from_linkage import group_joints, group_system
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

DETERMINED = 1e-3
"""Relative error of rates up to which they count as determined. Those of a parallelogram 1e-5 rad beside its change
point are right to 3e-6, their second derivatives to no digit."""


def singular_report(motion: Motion, order: int) -> list[str]:
    """Say in words at which closed poses derivatives of an order by time are not determined, if there are any.

    A pose with the smallest singular value s is right to eps / s, its first derivative to eps / s^2, and every further
    one to as much less again. At the singular pose itself it depends on the branch, which the Jacobian does not tell.
    """
    if traced(motion):
        return []
    sigma = np.asarray(motion.sigma_min)
    least = (float(np.finfo(sigma.dtype).eps) / DETERMINED) ** (1 / (order + 1))
    found = np.flatnonzero(np.asarray(motion.on_branch) & (sigma < least))
    if not len(found):
        return []
    poses = f"{len(found)} pose{'s' * (len(found) > 1)} ({listed([*map(str, found)])})"
    return [
        f"not determined at {poses}, singular or nearly so (sigma_min {sigma[found].min():.1e}): leave their inputs "
        "out, or take others beside them"
    ]


def sigma_min(motion: Motion) -> Float[Array, " poses"]:
    """Compute the smallest singular value of a motion: see `Motion.sigma_min`."""
    linkage = motion.mechanism.linkage
    if traced(linkage) or not motion.swept:
        linkage = linkage.in_space
    driven = [coordinate(linkage, name) for name in motion.inputs]
    found = [jnp.full(len(motion), jnp.inf, motion.residual.dtype)]
    for number, (loop_group, loop_class) in enumerate(zip(linkage.structure.loop_groups, linkage.classes, strict=True)):
        inside = tuple(entry for entry in driven if entry[0] in loop_group.joints)
        system, columns = group_system(linkage, loop_group, inside, loop_class)
        if inside and (rank := _rank(linkage, number, system, columns)):
            joints = group_joints(linkage, linkage.solved_joints, loop_group)
            found.append(_of_group(system, rank, tuple(columns), joints, motion.displacements))
    return reduce(jnp.minimum, found[1:] or found)


@partial(whole_program, static=(0, 1, 2))
def _of_group(
    system: LoopSystem, rank: int, columns: Columns, joints: Joints, displacements: JointDisplacements
) -> Float[Array, " poses"]:
    """Compute the smallest singular value of a loop group from the displacements of all joints; NaN where those of the
    group are not finite."""
    rows = jnp.stack([displacements[joint][:, coordinate] for joint, coordinate in columns])
    # poses without numbers stand at rest until the end: NaN would spoil the derivatives of all poses
    finite = jnp.all(jnp.isfinite(rows), axis=0)
    return jnp.where(finite, smallest_singular_value(system, rank, joints, jnp.where(finite, rows, 0.0)), jnp.nan)


def _rank(linkage: Linkage, number: int, system: LoopSystem, columns: Columns) -> int:
    """Count the independent equations for the free coordinates, where nothing is singular.

    As many as may be where JAX traces, and where the host finds no closed pose to count them at.
    """
    if traced(linkage.joints) or not loop_freedoms(linkage)[number].closes:
        return min(system.uncut.equations, len(system.free))
    freedoms = loop_freedoms(linkage)[number]
    free = [freedoms.columns.index(columns[column]) for column in system.free]
    return null_space(freedoms.jacobian[:, np.array(free, int)], freedoms.thresholds.rank)[0]
