"""Gearboxes of SDF, as couplings of the two joints that turn their links on a third one."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from jaxkin.io.marker_joints import MarkerJoints
from jaxkin.io.marker_ties import TURNS, RigidGroups
from jaxkin.io.robot_model import RobotJoint, RobotLink
from jaxkin.joints.coupling import Coupling, relation


@dataclass(frozen=True, eq=False)
class Gearbox:
    """What the file says of one gearbox: `theta_child = -ratio theta_parent`, both angles from the reference link."""

    name: str
    parent: str
    child: str
    reference: str
    axes: tuple[np.ndarray, np.ndarray]
    """About which the parent and the child turn, in the world."""
    ratio: float
    text: str
    """What the file calls it."""


def gearboxes(
    file: str,
    found: Sequence[Gearbox],
    links: dict[str, RobotLink],
    joints: Sequence[RobotJoint],
    fixed: Collection[str],
    notes: list[str],
) -> list[Coupling]:
    """Make the couplings of gearboxes; what has no two joints that turn its links on the reference link is noted."""
    made = MarkerJoints(file, links, {each.name: each for each in joints})
    bodies = RigidGroups.among(made, fixed)
    couplings = []
    for each in found:
        turns = [
            [turn for turn in bodies.carried(made, link, TURNS, "phi", axis) if each.reference in turn.carrier]
            for link, axis in zip((each.parent, each.child), each.axes, strict=True)
        ]
        pair = next(((one, other) for one, other in product(*turns) if one.joint is not other.joint), None)
        if pair is None or each.ratio == 0.0:
            why = "its ratio is zero" if pair else f"no two joints turn its links on {each.reference!r} about its axes"
            notes.append(f"{file}: {each.text} is not kept, and its links move on their own: {why}")
            continue
        first, second = pair
        ties = {second.name: second.sign, first.name: each.ratio * first.sign}
        couplings.append(relation(ties, name=each.name))
    return couplings
