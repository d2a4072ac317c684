"""SDF, the models of Gazebo: links and joints as a graph, so that loops are joints like all others."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import listed, nearest
from jaxkin.geometry.inertial import NONE
from jaxkin.geometry.pose import Transform
from jaxkin.io.robot_couplings import Mimic, held_at, tied
from jaxkin.io.robot_gravity import gravity_notes
from jaxkin.io.robot_inertials import sdf_inertial
from jaxkin.io.robot_model import (
    WORLD,
    RobotJoint,
    RobotLink,
    RobotModel,
    along,
    direction,
    limit,
    limits_between,
    numbers,
    placed,
    tag,
    unknown_parts,
)
from jaxkin.io.sdf_frames import IN_ANOTHER, SdfFrames, is_true
from jaxkin.io.sdf_gearbox import Gearbox, gearboxes
from jaxkin.io.sdf_includes import axis_in_model, included
from jaxkin.io.sdf_shapes import shapes_of
from jaxkin.joints.joint import JointLimits
from jaxkin.joints.kinds import JointKind

KINDS = {
    "revolute": JointKind.REVOLUTE, "continuous": JointKind.REVOLUTE, "prismatic": JointKind.PRISMATIC,
    "ball": JointKind.SPHERICAL, "fixed": JointKind.FIXED, "universal": JointKind.UNIVERSAL, "screw": JointKind.SCREW,
    "piston": JointKind.CYLINDRICAL, "revolute2": JointKind.REVOLUTE,
}  # fmt: skip
"""Types of SDF -> kind; "revolute2" is two of them in turn."""

RELATIONS = ("gearbox",)
"""Types of SDF that relate two joints and join nothing."""

SQUARE = 1e-6
"""Cosine between the axes of a universal joint up to which they are perpendicular: six digits."""

MODEL_TAGS = ("link", "joint", "model", "frame", "pose", "static", "self_collide", "allow_auto_disable", "enable_wind",
              "plugin", "gripper")  # fmt: skip
"""Elements of a model that are read, or are not about motion."""

WORLD_PARTS = ("model", "light", "gui", "scene", "physics", "plugin", "state", "gravity", "joint", "magnetic_field",
               "wind", "atmosphere", "spherical_coordinates", "audio", "road", "population", "frame")  # fmt: skip
"""Elements of a world that are read, or are not about motion."""


def read_sdf(path: Path, root: Element) -> RobotModel:
    """Read the models of a file; ValueError in one line for what is wrong, FileNotFoundError for a missing include."""
    return _Reader(path, root).model()


class _Reader:
    """The models of one file."""

    def __init__(self, path: Path, root: Element) -> None:
        self.file = path.name
        self.notes: list[str] = []
        worlds = root.findall("world")
        world = worlds[0] if worlds else None
        self.top = root if world is None else world
        beside = [*worlds[1:], *(root.findall("model") if worlds else [])]
        if beside:
            names = listed([tag(each) for each in beside])
            self.notes.append(f"{self.file}: only {tag(self.top)} is read; {names} beside it left out")
        included(self.top, path.parent, self.file)
        if world is not None:
            self.notes += unknown_parts(world, WORLD_PARTS, self.file)
            self.notes += gravity_notes(self.file, world.findtext("gravity"))
        self.version = root.get("version", "1.7")
        self.links: dict[str, RobotLink] = {WORLD: RobotLink(WORLD, np.eye(4))}
        self.joints: list[RobotJoint] = []
        self.fixed: list[str] = []
        self.motors: list[str] = []
        self.gearboxes: list[Gearbox] = []
        self.mimics: list[tuple[str, str, Element, str]] = []
        """Of each joint that follows another: its name, the prefix of its model, the element, and its place."""

    def model(self) -> RobotModel:
        models = self.top.findall("model")
        if not models:
            raise ValueError(f"{self.file}: there is no <model> in it")
        world, between = SdfFrames.of(self.file, self.top), self.top.findall("joint")
        for each in models:
            name = each.get("name", "")
            prefix = "" if len(models) == 1 and not between else name + IN_ANOTHER
            self._read(each, world.inner[name], prefix, world.in_model(name), False)
        for each in between:
            self._joint(each, world, "", np.eye(4), False)
        if len(self.links) == 1:
            raise ValueError(f"{self.file}: there is no <link> in it")
        needed = {part for each in self.joints for part in each.parts}
        links = [link for name, link in self.links.items() if name != WORLD or WORLD in needed]
        fixed = [*([WORLD] if WORLD in needed else []), *self.fixed]
        names = {each.name for each in self.joints}
        mimics = [self._mimic(*each, names) for each in self.mimics]
        self.joints, couplings, steps = tied(mimics, self.joints, self.notes)
        known = {each.name for each in self.joints if each.kind is not JointKind.FIXED}
        for name in self.motors:
            if name not in known:
                self.notes.append(f"{self.file}: a controller is of {name!r}, which is no joint that moves; left out")
        motors = tuple(dict.fromkeys(name for name in self.motors if name in known))
        couplings += gearboxes(self.file, self.gearboxes, self.links, self.joints, fixed, self.notes)
        joints, notes = tuple(self.joints), tuple(self.notes)
        return held_at(RobotModel(tuple(links), joints, tuple(fixed), motors, notes, tuple(couplings)), steps)

    def _read(self, model: Element, frames: SdfFrames, prefix: str, pose: Transform, static: bool) -> None:
        """Read the links and joints of a model at a pose in the world, and those of the models in it."""
        where = f"{self.file}: {tag(model)}"
        self.notes += unknown_parts(model, MODEL_TAGS, where)
        static = static or is_true(model.findtext("static"))
        for each in model.iterfind("link"):
            name = each.get("name", "")
            seen, felt = (shapes_of(each, what, frames, self.notes) for what in ("visual", "collision"))
            weighs = sdf_inertial(each, f"{self.file}: {tag(each)}: inertial", self.notes)
            place = pose @ frames.in_model(name)
            self.links[prefix + name] = RobotLink(prefix + name, place, seen, felt, weighs)
            self.fixed += [prefix + name] if static else []
        for each in model.iterfind("model"):
            name = each.get("name", "")
            self._read(each, frames.inner[name], f"{prefix}{name}{IN_ANOTHER}", pose @ frames.in_model(name), static)
        for each in model.iterfind("joint"):
            self._joint(each, frames, prefix, pose, static)
        for plugin in model.iterfind("plugin"):
            if "control" in f"{plugin.get('name', '')} {plugin.get('filename', '')}".lower():
                self.motors += [prefix + (joint.text or "").strip() for joint in plugin.iter("joint_name")]

    def _joint(self, each: Element, frames: SdfFrames, prefix: str, pose: Transform, static: bool) -> None:
        """Read a joint: of "revolute2" two, with a part without a solid between them."""
        name, said = prefix + each.get("name", ""), each.get("type", "")
        where = f"{self.file}: {tag(each)}"
        if said not in KINDS and said not in RELATIONS:
            raise ValueError(f"{where}: expected one of the types {', '.join((*KINDS, *RELATIONS))}, got {said!r}")
        ends = []
        for side in ("parent", "child"):
            link = frames.link_of((each.findtext(side) or "").strip())
            ends.append(link if link == WORLD else prefix + link)
        if static:
            return  # all of its links are at rest
        if said in RELATIONS:
            self.gearboxes.append(self._gearbox(each, frames, prefix, pose, ends))
            return
        if ends[0] == ends[1]:
            raise ValueError(f"{where}: its parent and its child are the same link, {ends[0]!r}")
        own = frames.in_model(each.get("name", ""))
        axes = [(axis, self._axis(axis, own, frames, where)) for axis in (each.find("axis"), each.find("axis2"))]
        kind, text = KINDS[said], f"{said} {name!r}"
        for number, (axis, _) in enumerate(axes, start=1):
            if axis is not None and (mimic := axis.find("mimic")) is not None:
                self.mimics.append((f"{name} {number}" if said == "revolute2" else name, prefix, mimic, where))
        (first, one), (second, other) = axes
        turn = np.eye(3)
        limits: JointLimits = ()
        if kind is JointKind.UNIVERSAL:
            turn = _cross(one, other, where)
            limits = _both(self._limits(second, where), self._limits(first, where))
        elif kind not in (JointKind.FIXED, JointKind.SPHERICAL):
            turn = along(one)
            limits = self._limits(first, where) if kind is not JointKind.CYLINDRICAL else ()
        frame = pose @ placed(turn, own[:3, 3])
        parts = (ends[0], ends[1])
        if said == "revolute2":
            between = f"{name}/1"
            self.links[between] = RobotLink(between, frame, inertial=NONE)
            self.joints.append(RobotJoint(f"{name} 1", (ends[0], between), kind, frame, frame, text, limits))
            frame = pose @ placed(along(other), own[:3, 3])
            name, parts, limits = f"{name} 2", (between, ends[1]), self._limits(second, where)
        pitch = self._pitch(each, where) if kind is JointKind.SCREW else 0.0
        self.joints.append(RobotJoint(name, parts, kind, frame, frame, text, limits, pitch=pitch))

    def _gearbox(self, each: Element, frames: SdfFrames, prefix: str, pose: Transform, ends: list[str]) -> Gearbox:
        """Read a gearbox; ValueError where it does not say the link that its angles count from."""
        where = f"{self.file}: {tag(each)}"
        said = (each.findtext("gearbox_reference_body") or "").strip()
        if not said:
            raise ValueError(f"{where}: expected the link that its angles count from in <gearbox_reference_body>")
        link = frames.link_of(said)
        own = frames.in_model(each.get("name", ""))
        first, second = (pose[:3, :3] @ self._axis(each.find(key), own, frames, where) for key in ("axis", "axis2"))
        ratio = float(numbers(each.findtext("gearbox_ratio"), 1, f"{where}: gearbox_ratio", (1.0,))[0])
        name, reference = prefix + each.get("name", ""), link if link == WORLD else prefix + link
        return Gearbox(name, ends[0], ends[1], reference, (first, second), ratio, f"{tag(each)} of type 'gearbox'")

    def _mimic(self, name: str, prefix: str, mimic: Element, where: str, joints: Collection[str]) -> tuple[Mimic, str]:
        """Read `name = multiplier (leader - reference) + offset`, and its element; ValueError for an unknown leader."""
        leader = prefix + mimic.get("joint", "")
        if f"{leader} 1" in joints:  # of two axes, each of which is a joint here
            leader = f"{leader} {2 if mimic.get('axis') == 'axis2' else 1}"
        if leader not in joints:
            raise ValueError(f"{where}: mimic names the unknown joint {leader!r}{nearest(leader, joints)}")
        factor, offset, reference = (
            float(numbers(mimic.findtext(key), 1, where, (none,))[0])
            for key, none in (("multiplier", 1), ("offset", 0), ("reference", 0))
        )
        return Mimic(name, leader, factor, offset - factor * reference), f"{where}: mimic"

    def _axis(self, axis: Element | None, own: Transform, frames: SdfFrames, where: str) -> np.ndarray:
        """Read the direction of an axis in the frame of the model; z where none is written."""
        if axis is None:
            return own[:3, 2]
        found = axis.find("xyz")
        written = direction(numbers(None if found is None else found.text, 3, f"{where}: axis", (0, 0, 1)), where)
        named = None if found is None else found.get("expressed_in")
        if named:
            return frames.in_model(named)[:3, :3] @ written
        return written if axis_in_model(axis, self.version) else own[:3, :3] @ written

    def _limits(self, axis: Element | None, where: str) -> JointLimits:
        low, high = (
            limit(None if axis is None else axis.findtext(f"limit/{side}"), f"{where}: limit", none)
            for side, none in (("lower", -np.inf), ("upper", np.inf))
        )
        if low > high:
            self.notes.append(f"{where}: its lower limit {low:g} is above the upper one {high:g}; left out")
        return limits_between(low, high) if low <= high else ()

    def _pitch(self, each: Element, where: str) -> float:
        """Read the pitch, metres a turn. The older <thread_pitch> is radians a metre, positive if left-handed."""
        if (said := each.findtext("screw_thread_pitch")) is not None:
            return float(numbers(said, 1, where)[0])
        turns = float(numbers(each.findtext("thread_pitch"), 1, where, (-2 * np.pi,))[0])
        return -2 * np.pi / turns if turns else 0.0


def _cross(one: np.ndarray, other: np.ndarray, where: str) -> np.ndarray:
    """Make the rotation of the frame of a universal joint: y along the axis in the parent, x along that in the
    child."""
    if abs(one @ other) > SQUARE:
        raise ValueError(f"{where}: the axes of a universal joint must be perpendicular, got {one} and {other}")
    x = direction(other - (other @ one) * one, where)
    return np.stack([x, one, np.cross(x, one)], axis=1)


def _both(first: JointLimits, second: JointLimits) -> JointLimits:
    """Join the limits of two coordinates, of which each may have none."""
    none = ((-np.inf, np.inf),)
    return (*(first or none), *(second or none)) if first or second else ()
