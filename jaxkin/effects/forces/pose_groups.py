"""Forces of many poses: by groups, whose numbers stay in the cache, and by shards, each on a core of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp

from jaxkin._traced import traced
from jaxkin.effects.forces.acting import ActingNumbers
from jaxkin.effects.forces.balance import LARGEST_GROUP
from jaxkin.effects.forces.given import rows_per_pose
from jaxkin.effects.pose_shards import in_shards
from jaxkin.mechanism.known_motion import Inputs, KnownMotion
from jaxkin.solve.range.groups import in_groups

MIN_SHARD_ENTRIES = 2**17
"""Least number of poses of a shard, times the square of the number of joints. On two cores reactions in 2,000 poses of
the paper's Fig. 7, with 14 joints, take 31 ms in place of 52; in 10,000 of a four-bar 6.4 ms in place of 5.3, since to
call programs, to cut and to join takes a millisecond or two, and so these are not cut."""

OfMotion = Callable[[KnownMotion, Mapping[str, Any], Any, ActingNumbers], Any]
"""A function of a motion, its inputs, their first and second derivatives by time, and what acts. It returns a pytree of
arrays whose first axis is the poses."""
OfPoses = Callable[[Any, ActingNumbers], Any]
"""A function of what is given for each pose, a pytree of arrays whose first axis is the poses, and of what acts, of
which some numbers are given for each pose, too. It returns such a pytree."""


def by_groups(function: OfPoses, given: Any, acting: ActingNumbers, size: int = LARGEST_GROUP) -> Any:
    """Apply a function to groups of at most `size` poses, and join what it returns: inside a program."""

    def of_group(poses: Any) -> Any:
        given, rows = poses
        return function(given, _with_rows(acting, rows))

    return in_groups(of_group, (given, jax.tree.map(jnp.asarray, _rows(acting))), size, axis=0)


def on_cores(
    function: OfMotion,
    known: KnownMotion,
    inputs: Mapping[str, Any],
    speeds: tuple[Inputs, Inputs] | None,
    acting: ActingNumbers,
) -> Any:
    """Apply a function, which calls programs, to shards of the poses of a motion, and join what it returns.

    `speeds` are first and second derivatives of the inputs by time, None at rest.
    """
    if traced(acting):
        return function(known, inputs, speeds, acting)

    def of_shard(known: KnownMotion, rows: Any) -> Any:
        inputs, speeds, of_loads = rows
        return function(known, inputs, speeds, _with_rows(acting, of_loads))

    return in_shards(of_shard, known, (inputs, speeds, _rows(acting)), MIN_SHARD_ENTRIES)


def _rows(acting: ActingNumbers) -> list[dict[str, Any]]:
    """Select the numbers of each load that are given for each pose, by name."""
    return [{name: getattr(each, name) for name in rows_per_pose(each)} for each in acting.applied]


def _with_rows(acting: ActingNumbers, rows: list[dict[str, Any]]) -> ActingNumbers:
    """Replace the numbers of each load that are given for each pose."""
    return acting._replace(applied=tuple(replace(each, **own) for each, own in zip(acting.applied, rows, strict=True)))
