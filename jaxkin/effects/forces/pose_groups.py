"""Forces of many poses by groups: what is placed and what acts in a group stays in the cache until it is used."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import jax.numpy as jnp

from jaxkin.effects.forces.acting import ActingNumbers
from jaxkin.effects.forces.balance import LARGEST_GROUP
from jaxkin.effects.forces.given import rows_per_pose
from jaxkin.solve.range.groups import in_groups


def by_groups(
    function: Callable[[Any, ActingNumbers], Any], given: Any, acting: ActingNumbers, size: int = LARGEST_GROUP
) -> Any:
    """Apply `function(given, acting)` to groups of at most `size` poses, and join what it returns.

    `given`, what the function returns, and those numbers of `acting` that are given for each pose, are pytrees of
    arrays whose first axis is the poses.
    """
    loads = [{name: jnp.asarray(getattr(each, name)) for name in rows_per_pose(each)} for each in acting.applied]

    def of_group(poses: Any) -> Any:
        given, own = poses
        applied = tuple(replace(each, **rows) for each, rows in zip(acting.applied, own, strict=True))
        return function(given, acting._replace(applied=applied))

    return in_groups(of_group, (given, loads), size, axis=0)
