"""MJCF, the models of MuJoCo: bodies inside bodies with their joints, loops by <equality>, motors by <actuator>.

The assembled pose is MuJoCo's own at `qpos0`: the bodies as they are written. There a joint has the value `ref`. Only
where that is beyond the ranges of joints it is the pose of a keyframe.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import listed
from jaxkin.geometry.inertial import NONE, Inertial
from jaxkin.geometry.pose import Transform, inverse
from jaxkin.io.mjcf_attach import attached
from jaxkin.io.mjcf_keyframe import at_keyframe
from jaxkin.io.mjcf_masses import body_masses, scaled_notes
from jaxkin.io.mjcf_shapes import Shapes
from jaxkin.io.mjcf_text import Compiler, Defaults, included, replicated
from jaxkin.io.mjcf_ties import Ties, disabled
from jaxkin.io.robot_gravity import gravity_notes
from jaxkin.io.robot_model import (
    WORLD,
    LinkShape,
    RobotJoint,
    RobotLink,
    RobotModel,
    Weighed,
    along,
    direction,
    limits_between,
    numbers,
    placed,
    tag,
    unknown_parts,
)
from jaxkin.joints.joint import JointLimits
from jaxkin.joints.kinds import JointKind

KINDS = {"hinge": JointKind.REVOLUTE, "slide": JointKind.PRISMATIC, "ball": JointKind.SPHERICAL}
"""Types of joints -> kind; "free" joints have none."""

SECTIONS = ("compiler", "option", "size", "visual", "statistic", "default", "custom", "asset", "worldbody", "contact",
            "equality", "tendon", "actuator", "sensor", "keyframe")  # fmt: skip
"""Elements of a model that are read, or are about forces, contacts, measurement and pictures."""

BODY = ("inertial", "joint", "freejoint", "geom", "site", "body", "frame", "camera", "light")
"""Elements of a body that are read, or are not about motion."""


Placed = tuple[Element, Transform, str | None]
"""An element of a body, the place that it is given in, from there to the world in metres, and its class by default."""


@dataclass
class ModelBodies:
    """What the bodies of a model are: gathered on the way through them, at MuJoCo's `qpos0`."""

    poses: dict[str, Transform] = field(default_factory=lambda: {WORLD: np.eye(4)})
    """From each body to the world, metres."""
    shapes: dict[str, list[LinkShape]] = field(default_factory=lambda: {WORLD: []})
    inertials: dict[str, Inertial] = field(default_factory=dict)
    """Of the bodies of which the model says what they weigh, in their frames."""
    weighed: dict[str, tuple[Weighed, ...]] = field(default_factory=dict)
    """Of those of which it says what their solids weigh."""
    joints: list[RobotJoint] = field(default_factory=list)
    order: list[str] = field(default_factory=list)
    """Names of the joints in the order of `qpos`; "" for a free one."""
    keys: dict[str, dict[str, str]] = field(default_factory=dict)
    """Keyframes of attached models: by name, what they say of each of their joints."""
    sites: dict[str, tuple[str, Transform]] = field(default_factory=dict)
    """Bodies of the sites by name, and their places in the world."""
    held: list[str] = field(default_factory=list)
    """Bodies that are held at rest, since they are moved from outside."""
    springs: list[str] = field(default_factory=list)
    """Names of joints with a spring."""
    notes: list[str] = field(default_factory=list)


def read_mjcf(path: Path, root: Element) -> RobotModel:
    """Read a model; ValueError, in one line, for what is wrong, FileNotFoundError for a missing include."""
    return _Reader(path, included(root, path)).model()


class _Reader:
    """The elements of one model."""

    def __init__(self, path: Path, root: Element) -> None:
        self.file, self.root = path.name, root
        self.compiler = Compiler(root, path.name)
        notes = attached(root, path, self.compiler)
        self.defaults = Defaults(root, path.name)
        replicated(root, self.compiler)
        self.shapes = Shapes(root, self.compiler, self.defaults)
        told = [*unknown_parts(root, SECTIONS, path.name), *_gravity(root, path.name), *scaled_notes(self.compiler)]
        self.found = ModelBodies(notes=[*notes, *told])
        self.limits_hold = not disabled(root, "limit")
        if not self.limits_hold:
            self.found.notes.append(f"{self.file}: its <flag> disables limits: joints have none")

    def model(self) -> RobotModel:
        """Go through the bodies, then what ties them together and what moves them."""
        found = self.found
        for world in self.root.iterfind("worldbody"):
            self._inside([*self._own(world, np.eye(4), None)], WORLD)
        if len(found.poses) == 1:
            raise ValueError(f"{self.file}: there is no <body> in its <worldbody>")
        ties = Ties(self.file, self.root, self.compiler, self.defaults, found.poses, found.sites)
        loops = ties.loops({each.name for each in found.joints})
        motors = ties.motors(found.joints)
        couplings = ties.couplings({each.name: each for each in found.joints})
        held = {name: ((at, at),) for name, at in ties.held.items()}
        joints = (*(replace(each, limits=held.get(each.name, each.limits)) for each in found.joints), *loops)
        left = [name for name in found.springs if name not in motors]
        if left:
            found.notes.append(
                f"{self.file}: the joints {listed(list(map(repr, left)))} have a spring (stiffness) and no motor: each "
                "is a freedom of its own; drive it with zeros to hold it"
            )
        needed = {part for each in joints for part in each.parts}
        names = [name for name in found.poses if name != WORLD or WORLD in needed]
        fixed = [*([WORLD] if WORLD in needed else []), *found.held]
        links = tuple(
            RobotLink(
                name,
                found.poses[name],
                tuple(found.shapes[name]),
                inertial=found.inertials.get(name),
                weighed=found.weighed.get(name, ()),
            )
            for name in names
        )
        notes = (*found.notes, *ties.notes)
        model = RobotModel(links, joints, tuple(fixed), motors, notes, couplings)
        model, notes = at_keyframe(model, self.root, self.file, found.order, len(found.joints), found.keys)
        return replace(model, notes=(*model.notes, *notes))

    def _own(self, element: Element, at: Transform, child_class: str | None) -> Iterator[Placed]:
        """Yield the elements of a body with the place in the world that they are given in, and the class that they have
        where they name none; those in frames have the place and the class of these."""
        self.found.notes += unknown_parts(element, BODY, f"{self.file}: {tag(element)}")
        for each in element:
            if each.tag == "frame":
                inner = at @ self.compiler.pose(each.attrib, f"{self.file}: {tag(each)}")
                yield from self._own(each, inner, each.get("childclass", child_class))
            else:
                yield each, at, child_class

    def _inside(self, own: Sequence[Placed], body: str) -> None:
        """Read the bodies, solids and sites of a body."""
        for each, at, child_class in own:
            where = f"{self.file}: {tag(each)}"
            if each.tag == "body":
                self._body(each, body, at, child_class)
            elif each.tag == "geom":
                shape = self.shapes.drawn(each, child_class, where)
                if shape is None and self.shapes.is_solid(each, child_class):
                    self.found.notes.append(f"{where}: it has no size that such a solid has; left out")
                elif shape is not None:
                    place = inverse(self.found.poses[body]) @ at @ shape.pose
                    self.found.shapes[body].append(replace(shape, pose=place))
            elif each.tag == "site" and each.get("name"):
                said = self.defaults.said(each, child_class)
                self.found.sites[each.get("name", "")] = (body, at @ self.compiler.pose(said, where))

    def _body(self, element: Element, parent: str, at: Transform, child_class: str | None) -> None:
        """Read a body, its joints to the one around it, and what is inside."""
        found = self.found
        name = element.get("name") or f"{parent}/body {len(found.poses)}"
        where = f"{self.file}: {tag(element)}"
        if name in found.poses:
            raise ValueError(f"{where}: another body has its name; every body needs one of its own")
        child_class = element.get("childclass", child_class)
        pose = at @ self.compiler.pose(element.attrib, where)
        found.poses[name], found.shapes[name] = pose, []
        own = [*self._own(element, pose, child_class)]
        in_body = [(each, inverse(pose) @ at, of) for each, at, of in own]
        said = body_masses(in_body, self.shapes, where, found.notes)
        if isinstance(said, Inertial):
            found.inertials[name] = said
        elif said is not None:
            found.weighed[name] = said
        if float(numbers(element.get("gravcomp"), 1, f"{where}: gravcomp", (0,))[0]):
            found.notes.append(f"{where}: its gravcomp is not kept: gravity acts on it as on all others")
        joints = [each for each in own if each[0].tag in ("joint", "freejoint")]
        free = any(
            each.tag == "freejoint" or self.defaults.said(each, of).get("type") == "free" for each, _, of in joints
        )
        if free:
            found.order.append("")
        elif element.get("mocap") == "true":
            found.notes.append(f"{where}: it is moved from outside (mocap): held at rest where fixed= names no parts")
            found.held.append(name)
        else:
            self._chain(joints, parent, name, pose)
        self._inside(own, name)

    def _chain(self, joints: Sequence[Placed], parent: str, body: str, pose: Transform) -> None:
        """Join a body to the one around it by its joints in turn; between two of them is a part without a solid."""
        found = self.found
        if not joints:
            text = f"body {body!r} in {parent!r}"
            found.joints.append(RobotJoint(f"{body} on {parent}", (parent, body), JointKind.FIXED, pose, pose, text))
        before = parent
        for number, (each, at, child_class) in enumerate(joints, start=1):
            after = body if number == len(joints) else f"{body}/{number}"
            if after != body:
                found.poses[after], found.shapes[after], found.inertials[after] = pose, [], NONE
            name = each.get("name") or f"{body}/joint {number}"
            found.joints.append(self._joint(each, name, (before, after), at, child_class, pose))
            found.order.append(name)
            for key in each.iterfind("key"):
                found.keys.setdefault(key.get("name", ""), {})[name] = key.get("qpos", "")
            before = after

    def _joint(
        self,
        each: Element,
        name: str,
        parts: tuple[str, str],
        at: Transform,
        child_class: str | None,
        pose: Transform,
    ) -> RobotJoint:
        """Read a joint between two parts, given in the frame `at`; a ball turns about the axes of its body at `pose`,
        whatever frame it is written in."""
        said, where = self.defaults.said(each, child_class), f"{self.file}: {tag(each)}"
        written = said.get("type", "hinge")
        if written not in KINDS:
            raise ValueError(f"{where}: expected one of the types {', '.join(KINDS)}, free, got {written!r}")
        kind = KINDS[written]
        point = numbers(said.get("pos"), 3, where, (0, 0, 0))
        axis = direction(numbers(said.get("axis"), 3, where, (0, 0, 1)), where)
        frame = at @ placed(along(axis), point)
        if kind is JointKind.SPHERICAL:
            frame = placed(pose[:3, :3], frame[:3, 3])
        unit = self.compiler.radians if kind is not JointKind.PRISMATIC else 1.0
        value = float(numbers(said.get("ref"), 1, where, (0,))[0]) * unit
        if float(numbers((said.get("stiffness") or "0").split()[0], 1, where)[0]) != 0.0:
            self.found.springs.append(name)
        limits = self._limits(said, unit, value, where)
        if limits and kind is JointKind.SPHERICAL:
            self.found.notes.append(f"{where}: its range limits the angle of a ball, which is not kept")
            limits = ()
        values = (value,) if value and kind is not JointKind.SPHERICAL else ()
        return RobotJoint(name, parts, kind, frame, frame, f"{written} {name!r}", limits, values)

    def _limits(self, said: dict[str, str], unit: float, value: float, where: str) -> JointLimits:
        """Read the range of a joint from the pose that is written, where it is limited."""
        limited = said.get("limited", "auto")
        if (
            not self.limits_hold
            or limited == "false"
            or "range" not in said
            or (limited == "auto" and not self.compiler.auto_limits)
        ):
            return ()
        low, high = map(float, numbers(said["range"], 2, where) * unit - value)
        if low >= high:
            self.found.notes.append(f"{where}: its range {said['range']!r} does not begin below its end; left out")
        return limits_between(low, high) if low < high else ()


def _gravity(root: Element, file: str) -> tuple[str, ...]:
    """Write a note where the gravity of a model is not that which forces are computed with."""
    vectors = [each.get("gravity") for each in root.iterfind("option") if "gravity" in each.attrib]
    disabled = any(each.get("gravity") == "disable" for each in root.iterfind("option/flag"))
    return gravity_notes(file, "0 0 0" if disabled else vectors[-1] if vectors else None)
