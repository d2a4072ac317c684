"""Couplings of joints in robot files that follow another one: `mimic` of URDF and SDF, equalities of MJCF."""

from __future__ import annotations

from collections.abc import Mapping

from jaxkin.io.robot_model import RobotJoint
from jaxkin.joints.coupling import Coupling, relation
from jaxkin.joints.kinds import JointKind

SINGLE = (JointKind.REVOLUTE, JointKind.PRISMATIC, JointKind.SCREW)
"""Kinds of joints of one coordinate, which can follow and be followed."""


def follower(
    name: str,
    leader: str,
    factor: float,
    offset: float,
    joints: Mapping[str, RobotJoint],
    where: str,
    notes: list[str],
) -> Coupling | None:
    """Make the coupling `name = factor leader + offset`, radians or metres, counted from the zeros of the file.

    None, and a note, where one of the two joints has not one coordinate, or the factor is zero. `where` tells the
    element of the file.
    """
    stiff = [each for each in (name, leader) if joints[each].kind not in SINGLE]
    if stiff or factor == 0.0 or name == leader:
        why = f"{stiff[0]!r} has not one coordinate" if stiff else "its factor is zero, or it follows itself"
        notes.append(f"{where} of {leader!r} by {name!r} is left out: {why}")
        return None
    return relation({name: 1.0, leader: -factor}, offset, name=f"{name} follows {leader}")
