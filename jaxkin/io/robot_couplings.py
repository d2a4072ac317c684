"""Couplings of joints in robot files that follow another one: `mimic` of URDF and SDF, equalities of MJCF."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from jaxkin.geometry.pose import Transform, inverse, rotation
from jaxkin.io.robot_model import RobotJoint, RobotModel, placed
from jaxkin.joints.coupling import Coupling, relation
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.components import connected

SINGLE = (JointKind.REVOLUTE, JointKind.PRISMATIC, JointKind.SCREW)
"""Kinds of joints of one coordinate, which can follow and be followed."""


Z = np.array([0.0, 0.0, 1.0])
"""Axis of joints in their frames."""


class Mimic(NamedTuple):
    """A joint that follows another one: `name = factor leader + offset`, counted from the zeros of the file."""

    name: str
    leader: str
    factor: float
    offset: float
    """Radians or metres."""


def tied(
    mimics: Sequence[tuple[Mimic, str]], joints: Sequence[RobotJoint], notes: list[str]
) -> tuple[list[RobotJoint], list[Coupling], dict[str, Transform]]:
    """Couple joints that follow others, all of them among `joints`, each with the element of the file that says so.

    A joint that follows with the factor zero does not move, nor do those that follow it: they are fixed, which a note
    says, and their displacements (4, 4) from the zero of the file, in their frames, are those of `held_at`. What
    follows no joint of one coordinate, or itself, is left out, and noted.
    """
    made = {each.name: each for each in joints}
    following, held = [], {}
    for mimic, where in mimics:
        stiff = [name for name in (mimic.name, mimic.leader) if made[name].kind not in SINGLE]
        if stiff or mimic.name == mimic.leader:
            why = f"{stiff[0]!r} has not one coordinate" if stiff else "it follows itself"
            notes.append(f"{where} of {mimic.leader!r} by {mimic.name!r} is left out: {why}")
        else:
            following.append((mimic, where))
            held |= {mimic.name: mimic.offset} if mimic.factor == 0.0 else {}
    todo = [mimic for mimic, _ in following if mimic.name not in held]
    while still := [mimic for mimic in todo if mimic.leader in held]:
        held |= {mimic.name: mimic.factor * held[mimic.leader] + mimic.offset for mimic in still}
        todo = [mimic for mimic in todo if mimic.name not in held]
    steps = {name: _step(made[name], value) for name, value in held.items()}
    for mimic, where in following:
        if mimic.name in held:
            made[mimic.name] = replace(made[mimic.name], kind=JointKind.FIXED, limits=(), values=(), pitch=0.0)
            why = "the factor is zero" if mimic.factor == 0.0 else f"{mimic.leader!r} is held, too"
            notes.append(f"{where} of {mimic.leader!r} holds {mimic.name!r} at {held[mimic.name]:g}: {why}")
    couplings = [
        relation({each.name: 1.0, each.leader: -each.factor}, each.offset, name=f"{each.name} follows {each.leader}")
        for each in todo
    ]
    return [made[each.name] for each in joints], couplings, steps


def _step(joint: RobotJoint, value: float) -> Transform:
    """Make the displacement of a joint of one coordinate, in its frame."""
    along = {JointKind.PRISMATIC: value, JointKind.SCREW: value * joint.pitch / (2.0 * np.pi)}.get(joint.kind, 0.0)
    return placed(rotation(Z, 0.0 if joint.kind is JointKind.PRISMATIC else value), along * Z)


def held_at(model: RobotModel, steps: Mapping[str, Transform]) -> RobotModel:
    """Displace fixed joints of a robot, given by their names, with the links that nothing else ties to the ground.

    The frames of a joint in a loop come apart: its loop is closed as all that are open.
    """
    for name, step in steps.items():
        own = next(each for each in model.joints if each.name == name)
        there = own.frame_1 @ step
        loose = _loose(model, own)
        by = own.frame_2 @ inverse(there) if own.parts[0] in loose else there @ inverse(own.frame_2)
        joints = [
            replace(
                each,
                frame_1=by @ each.frame_1 if each.parts[0] in loose else each.frame_1,
                frame_2=by @ each.frame_2 if each.parts[1] in loose else each.frame_2,
            )
            for each in (replace(each, frame_1=there) if each is own else each for each in model.joints)
        ]
        links = [replace(link, pose=by @ link.pose) if link.name in loose else link for link in model.links]
        model = replace(model, links=tuple(links), joints=tuple(joints))
    return model


def _loose(model: RobotModel, joint: RobotJoint) -> frozenset[str]:
    """Find the links that one joint alone ties to the ground; none where it is in a loop."""
    ties = [each.parts for each in model.joints if each is not joint]
    ties += [(model.fixed[0], name) for name in model.fixed[1:]]
    sides = [group for group in connected([link.name for link in model.links], ties) if group & {*joint.parts}]
    loose = [group for group in sides if not group & {*model.fixed}]
    return frozenset(loose[0]) if len(sides) == 2 and loose else frozenset()
