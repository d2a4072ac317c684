"""Wheels, rollers and loose balls: bodies that are round about their only joint, whose turns move nothing else."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.geometry.outline import roundness
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.open_loops import left_open

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

ROUND = 0.95
"""Roundness of a wheel about its axis, at least: a hexagon has 0.87."""


def wheels_last(mechanism: Mechanism) -> tuple[str, ...]:
    """List coordinates that determine the motion together, as the mobility does, those of wheels last.

    None where nothing can move, or where the loops cannot be closed.
    """
    if left_open(mechanism.linkage) is not None:
        return ()
    return tuple(sorted(mechanism.mobility().drivable, key=wheels_of(mechanism).__contains__))


def wheels_of(mechanism: Mechanism) -> dict[str, str]:
    """Find the turns of bodies that are round about their only hinge, as wheels and rollers are, or about the middle of
    their only ball joint: a part of each body by the coordinate."""
    solids = {part.name: part for part in mechanism.solids}
    members = {part: parts for parts in mechanism.bodies.values() for part in parts}
    free = [joint for joint in mechanism.all_joints if joint.freedoms]
    count = Counter(members[part][0] for joint in free for part in joint.parts)
    found = {}
    for joint in (each for each in free if each.kind in (JointKind.REVOLUTE, JointKind.SPHERICAL)):
        pose = np.asarray(joint.frames_1, float)[0]
        for part in joint.parts:
            own = [solids[name] for name in members[part] if name in solids]
            if part in mechanism.fixed or count[members[part][0]] != 1 or not own:
                continue
            outline = np.concatenate([each.outermost for each in own]) - pose[:3, 3]
            if joint.kind is JointKind.SPHERICAL:
                away = np.linalg.norm(outline, axis=1)
                is_round = away.min() > ROUND * away.max()
            else:
                is_round = roundness(outline @ pose[:3, :2], np.zeros(2)) > ROUND
            if is_round:
                found |= {f"{joint.name}.{coordinate}": part for coordinate in joint.coordinates}
    return found
