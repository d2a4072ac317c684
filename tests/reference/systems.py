"""The loop system of a mechanism with one loop group, for tests of the solver's parts."""

from __future__ import annotations

from collections.abc import Iterable

import jax
import jax.numpy as jnp

from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.system.from_linkage import group_joints, group_system
from jaxkin.solve.system.loop_system import LoopSystem


def loop_system(mechanism: Mechanism, driven: Iterable[tuple[str, int]], **loop_class) -> tuple[LoopSystem, tuple]:
    """The system in which these coordinates are driven, each by its joint and its number, and the arrays of its joints.

    Fields of the loop class may be given instead of those that were found.
    """
    (group,), (found,) = mechanism.structure.loop_groups, mechanism.linkage.classes
    names = [mechanism.all_joints[joint].name for joint in group.joints]
    places = tuple((group.joints[names.index(name)], number) for name, number in driven)
    system, _ = group_system(mechanism.linkage, group, places, found._replace(**loop_class))
    return system, jax.tree.map(jnp.asarray, group_joints(mechanism.linkage, mechanism.all_joints, group))
