"""Couplings of joints in robot files that follow another one: `mimic` of URDF and SDF, equalities of MJCF."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from jaxkin.io.robot_model import RobotJoint
from jaxkin.joints.coupling import Coupling, relation
from jaxkin.joints.kinds import JointKind

SINGLE = (JointKind.REVOLUTE, JointKind.PRISMATIC, JointKind.SCREW)
"""Kinds of joints of one coordinate, which can follow and be followed."""


class Mimic(NamedTuple):
    """A joint that follows another one: `name = factor leader + offset`, counted from the zeros of the file."""

    name: str
    leader: str
    factor: float
    offset: float
    """Radians or metres."""


def follower(mimic: Mimic, joints: Mapping[str, RobotJoint], where: str, notes: list[str]) -> Coupling | None:
    """Make the coupling of a joint that follows another one, both of them among `joints`.

    None, and a note, where one of the two joints has not one coordinate, or the factor is zero. `where` tells the
    element of the file.
    """
    name, leader, factor, offset = mimic
    stiff = [each for each in (name, leader) if joints[each].kind not in SINGLE]
    if stiff or factor == 0.0 or name == leader:
        why = f"{stiff[0]!r} has not one coordinate" if stiff else "its factor is zero, or it follows itself"
        notes.append(f"{where} of {leader!r} by {name!r} is left out: {why}")
        return None
    return relation({name: 1.0, leader: -factor}, offset, name=f"{name} follows {leader}")
