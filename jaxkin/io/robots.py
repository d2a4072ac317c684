"""Assemblies from robot files: each link a part with its solids, each joint a constraint, the loops closed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from jaxkin._names import listed
from jaxkin.assembly.close_export import closed_export
from jaxkin.assembly.exported import Constraint, Exported
from jaxkin.geometry.inertial import Inertial
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import apply
from jaxkin.io.names import cleaned, unique
from jaxkin.io.robot_drawn import Drawn, triangles_of
from jaxkin.io.robot_model import LinkShape, RobotJoint, RobotLink, RobotModel
from jaxkin.joints.combine import Chain
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.on_frames import MOVEMENT_OF
from jaxkin.topology.components import connected

MARK = 0.02
"""Edge of the box that is drawn for a link without a solid, over the extent of the robot."""

LEAST_EXTENT = 1e-3
"""Extent in metres that a robot is given at least: all links of one may begin at the same point."""

_IN_TURN = {JointKind.CONSTANT_ANGLE: (JointKind.SCHOENFLIES, JointKind.REVOLUTE)}
"""Kind of a joint that is two joints in turn, without a part between them -> these."""


def parts_and_export(model: RobotModel, path: Path, seconds: float | None) -> tuple[tuple[Part, ...], str, Exported]:
    """Make the parts of a robot in a closed pose, their unit, and what the file says of joints and bodies.

    Meshes that are there are read as they are, without looking for faces; links without a solid are small boxes.
    `seconds` is the time allowed for each mesh. Raises ValueError where names repeat.
    """
    _refuse_repeats(path.name, "link", [link.name for link in model.links])
    _refuse_repeats(path.name, "joint", [joint.name for joint in model.joints])
    link_names = _clean_names([link.name for link in model.links])
    joint_names = _clean_names([each.name for each in model.joints])
    model = _held(model, path.name)
    drawn = Drawn(path, model.links, seconds)
    mark = MARK * _extent(model)
    weighed, unknown = _weighed(model, drawn, path.name)
    parts = tuple(
        _part(link, link_names[link.name], drawn.solids[link.name], mark, weighed[link.name]) for link in model.links
    )
    constraints = [_constraint(each, joint_names[each.name], link_names) for each in model.joints]
    exported = Exported(
        fixed=tuple(link_names[name] for name in model.fixed),
        rigid=(),
        constraints=tuple(constraints),
        notes=(*model.notes, *drawn.notes, *unknown),
        motors=tuple(_renamed(name, joint_names) for name in model.motors),
        couplings=tuple(
            replace(each, coordinates=tuple(_renamed(name, joint_names) for name in each.coordinates))
            for each in model.couplings
        ),
        system="robot file",
    )
    parts, exported = closed_export(parts, exported, [each.frames_2 for each in model.joints], model.unit)
    return parts, model.unit, exported


def _held(model: RobotModel, file: str) -> RobotModel:
    """Hold one link of each group of links that no joints tie to those at rest: the first; a note says so."""
    names = [link.name for link in model.links]
    ties = [*(each.parts for each in model.joints), *((model.fixed[0], name) for name in model.fixed[1:])]
    loose = [group for group in connected(names, ties) if not group & {*model.fixed}]
    if not loose:
        return model
    held = tuple(min(group, key=names.index) for group in loose)
    note = (
        f"{file}: nothing ties {listed(list(map(repr, held)))} to the ground: held at rest where fixed= names no parts"
    )
    return replace(model, fixed=(*model.fixed, *held), notes=(*model.notes, note))


def _renamed(motor: str, names: Mapping[str, str]) -> str:
    """Rename a motor, which is a joint, or a coordinate of one, "joint.phi"."""
    joint, _, coordinate = motor.rpartition(".")
    return names[motor] if motor in names else f"{names[joint]}.{coordinate}"


def _clean_names(names: list[str]) -> dict[str, str]:
    """Map names as the file has them to names that are fit for messages."""
    return dict(zip(names, unique(cleaned(name) or "unnamed" for name in names), strict=True))


def _refuse_repeats(file: str, what: str, names: list[str]) -> None:
    if repeated := [name for name, count in Counter(names).items() if count > 1]:
        raise ValueError(f"{file}: {what} {repeated[0]!r} is there twice; every {what} needs a name of its own")


def _constraint(each: RobotJoint, name: str, link_names: Mapping[str, str]) -> Constraint:
    parts = (link_names[each.parts[0]], link_names[each.parts[1]])
    chain = Chain(tuple(MOVEMENT_OF[kind] for kind in _IN_TURN.get(each.kind, (each.kind,))), each.frames_1)
    return Constraint(
        name, parts, each.text, chain, each.kind, limits=each.limits, pitch=each.pitch, values=each.values
    )


def _extent(model: RobotModel) -> float:
    """Measure the largest extent of the origins of links and joints, metres."""
    points = [link.pose[:3, 3] for link in model.links] + [joint.frame_1[:3, 3] for joint in model.joints]
    return max(LEAST_EXTENT, float(np.ptp(points, axis=0).max()))


def _weighed(model: RobotModel, drawn: Drawn, file: str) -> tuple[dict[str, Inertial | None], list[str]]:
    """Find what each link weighs, in its frame, metres; None, and a note, where that of a solid is unknown."""
    found, notes = {link.name: link.inertial for link in model.links}, []
    for link in model.links:
        if link.weighed:
            found[link.name], why = drawn.inertial(link)
            notes += [f"{file}: the mass of {link.name!r} is unknown: {why}"] if why else []
    return found, notes


def _part(link: RobotLink, name: str, solids: list[np.ndarray], mark: float, weighs: Inertial | None) -> Part:
    """Make a part of a link and its solids, in the world; a small box at its origin where there are none."""
    notes = () if solids or not (link.shapes or link.collisions) else ("no file of its solid",)
    corners = np.concatenate(solids) if solids else triangles_of(LinkShape(np.eye(4), "box", (mark,) * 3))
    inertial = None if weighs is None else weighs.moved(link.pose)
    triangles, is_solid = apply(link.pose, corners), bool(solids)
    return Part(name, (), triangles, notes=notes, original_name=link.name, inertial=inertial, is_solid=is_solid)
