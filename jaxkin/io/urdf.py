"""URDF: robots as trees of links; their loops are in a file of their own (`jaxkin.io.robot_loops`)."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import nearest
from jaxkin.geometry.inertial import NONE, Inertial
from jaxkin.geometry.pose import Transform
from jaxkin.io.robot_couplings import Mimic, held_at, tied
from jaxkin.io.robot_inertials import SIX, inertial
from jaxkin.io.robot_loops import LoopPair, Loops, read_loops, unread_beside
from jaxkin.io.robot_model import (
    LinkShape,
    RobotJoint,
    RobotLink,
    RobotModel,
    along,
    direction,
    limit,
    limits_between,
    numbers,
    placed,
    quaternion,
    roll_pitch_yaw,
    tag,
    unknown_parts,
)
from jaxkin.io.xml_tree import has_macros
from jaxkin.joints.joint import JointLimits
from jaxkin.joints.kinds import JointKind

KINDS = {
    "revolute": JointKind.REVOLUTE, "continuous": JointKind.REVOLUTE, "prismatic": JointKind.PRISMATIC,
    "planar": JointKind.PLANAR, "fixed": JointKind.FIXED, "floating": JointKind.FIXED,
}  # fmt: skip
"""Types of URDF -> kind; what floats is held at rest."""

CARDAN = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
"""Rotation to the frame of a universal joint that turns first about x and then about y: our first axis is y."""

ROBOT = ("link", "joint", "material", "transmission", "ros2_control", "gazebo")
"""Elements of a robot that are read, or (material) are not about motion."""

JOINT = ("origin", "parent", "child", "axis", "limit", "mimic", "dynamics", "calibration", "safety_controller",
         "joint_properties")  # fmt: skip
"""Elements of a joint that are read, or are about forces, controllers and sensors."""


def read_urdf(path: Path, root: Element, loops: Path | None) -> RobotModel:
    """Read a robot with its loops; ValueError, in one line, for what is no tree or not understood."""
    said = read_loops(loops) if loops else Loops("", notes=unread_beside(path))
    return _Reader(path.name, root, said).model()


class _Reader:
    """The elements of one file."""

    def __init__(self, file: str, root: Element, loops: Loops) -> None:
        self.file, self.root, self.loops = file, root, loops
        self.links = {each.get("name", ""): each for each in root.iterfind("link")}
        self.joints = root.findall("joint")
        self.kinds = dict(loops.kinds)
        self.notes = [*loops.notes, *unknown_parts(root, ROBOT, file)]

    def model(self) -> RobotModel:
        """Place the links from the root on, then the joints, the loops and the motors."""
        if has_macros(self.root):
            raise ValueError(f"{self.file}: it has macros of xacro; expand it first: xacro {self.file} > robot.urdf")
        if not self.links:
            raise ValueError(f"{self.file}: there is no <link> in it")
        names = [each.get("name", "") for each in self.root.iterfind("link")]
        if len(self.links) < len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise ValueError(f"{self.file}: link {twice!r} is there twice; every link needs a name of its own")
        order, base = self._tree()
        poses = {base: np.eye(4)}
        joints = []
        for each in order:
            parent, child = self._parts(each)
            poses[child] = poses[parent] @ self._origin(each.find("origin"), tag(each))
            joints.append(self._joint(each, (parent, child), poses[child]))
        links = tuple(
            RobotLink(
                name, poses[name], self._shapes(each, "visual"), self._shapes(each, "collision"), self._inertial(each)
            )
            for name, each in self.links.items()
        )
        mimics = [each for element in order if (each := self._mimic(element, {one.name for one in joints})) is not None]
        joints, couplings, steps = tied(mimics, joints, self.notes)
        known = {each.name: each for each in joints}
        for name, _ in self.loops.kinds:
            self._known(name, known, "joint_name")
        loops = [self._loop(number, pair, known, poses) for number, pair in enumerate(self.loops.pairs, start=1)]
        motors = tuple(dict.fromkeys([*self._transmissions(known), *self._named_motors(known)]))
        for each in self.root.iterfind("gazebo"):
            self.notes += [
                f"{self.file}: {tag(joint)} inside <gazebo> is not read: write the loop into a file of loops"
                for joint in each.iter("joint")
            ]
        model = RobotModel(links, (*joints, *loops), (base,), motors, tuple(self.notes), tuple(couplings))
        return held_at(model, steps)

    def _parts(self, joint: Element) -> tuple[str, str]:
        """Find the parent and child link of a joint; ValueError where they are not there."""
        names = []
        for side in ("parent", "child"):
            found = joint.find(side)
            name = "" if found is None else found.get("link", "")
            if name not in self.links:
                raise ValueError(
                    f"{self.file}: {tag(joint)}: its {side} is the unknown link {name!r}{nearest(name, self.links)}"
                )
            names.append(name)
        return names[0], names[1]

    def _tree(self) -> tuple[list[Element], str]:
        """Find the joints from the root link on, and that link; ValueError where the links are no tree."""
        above: dict[str, Element] = {}
        below: dict[str, list[Element]] = {}
        for each in self.joints:
            parent, child = self._parts(each)
            if child in above:
                raise ValueError(
                    f"{self.file}: link {child!r} is the child of two joints, {above[child].get('name')!r} and "
                    f"{each.get('name')!r}: a URDF is a tree; close the loop in a file of loops, --loops "
                    "robot.yaml, in Python loops='robot.yaml'"
                )
            above[child] = each
            below.setdefault(parent, []).append(each)
        roots = [name for name in self.links if name not in above]
        if not roots:
            raise ValueError(f"{self.file}: its joints go in a circle: every link is the child of another")
        if len(roots) > 1:
            raise ValueError(
                f"{self.file}: the links {roots[0]!r} and {roots[1]!r} are both the child of no joint: a URDF is one "
                "tree; join them, or leave one out"
            )
        order, todo = [], list(below.get(roots[0], ()))
        while todo:
            each = todo.pop(0)
            order.append(each)
            todo += below.get(self._parts(each)[1], ())
        if len(order) < len(self.joints):
            left = next(each for each in self.joints if each not in order)
            raise ValueError(f"{self.file}: its joints go in a circle, with {left.get('name')!r}, apart from the root")
        return order, roots[0]

    def _origin(self, origin: Element | None, where: str) -> Transform:
        if origin is None:
            return np.eye(4)
        where = f"{self.file}: {where}: origin"
        if "quat_xyzw" in origin.attrib and "rpy" in origin.attrib:
            raise ValueError(f"{where}: it gives its rotation twice, by rpy and by quat_xyzw; write one of them")
        if "quat_xyzw" in origin.attrib:  # since version 1.2 of the format
            *xyz, w = numbers(origin.get("quat_xyzw"), 4, where)
            turn = quaternion([w, *xyz], where)
        else:
            turn = roll_pitch_yaw(numbers(origin.get("rpy"), 3, where, (0, 0, 0)))
        return placed(turn, numbers(origin.get("xyz"), 3, where, (0, 0, 0)))

    def _joint(self, each: Element, parts: tuple[str, str], pose: Transform) -> RobotJoint:
        name, said = each.get("name", ""), each.get("type", "")
        where = f"{self.file}: {tag(each)}"
        if said not in KINDS:
            raise ValueError(f"{where}: expected one of the types {', '.join(KINDS)}, got {said!r}")
        kind = self.kinds.get(name, KINDS[said])
        self.notes += unknown_parts(each, JOINT, where)
        if said == "floating" and kind is KINDS[said]:
            self.notes.append(f"{where}: it floats: {parts[1]!r} is held at rest on {parts[0]!r}")
        turn = np.eye(3)
        if kind in (JointKind.REVOLUTE, JointKind.PRISMATIC, JointKind.PLANAR):
            axis = each.find("axis")
            turn = along(direction(numbers(None if axis is None else axis.get("xyz"), 3, where, (1, 0, 0)), where))
        elif kind is JointKind.UNIVERSAL:
            turn = CARDAN
        frame = pose @ placed(turn, (0, 0, 0))
        limits = self._limits(each, where) if said in ("revolute", "prismatic") and kind is KINDS[said] else ()
        return RobotJoint(name, parts, kind, frame, frame, f"{said} {name!r}", limits)

    def _mimic(self, each: Element, joints: Collection[str]) -> tuple[Mimic, str] | None:
        """Read which of the joints a joint follows, with its element; None where it follows none of them."""
        found = each.find("mimic")
        name, where = each.get("name", ""), f"{self.file}: {tag(each)}: mimic"
        if found is None:
            return None
        self.notes += [f"{where}: a further one is left out" for _ in each.findall("mimic")[1:]]
        leader = found.get("joint", "")
        if leader not in joints:
            self.notes.append(f"{where} names the unknown joint {leader!r}{nearest(leader, joints)}; left out")
            return None
        factor, offset = (
            float(numbers(found.get(key), 1, where, (none,))[0]) for key, none in (("multiplier", 1), ("offset", 0))
        )
        return Mimic(name, leader, factor, offset), where

    def _limits(self, each: Element, where: str) -> JointLimits:
        """Read the limits of a joint: none where neither is written, and zero for the one that is not."""
        found = each.find("limit")
        if found is None or (found.get("lower") is None and found.get("upper") is None):
            return ()
        low, high = (limit(found.get(side), f"{where}: limit", 0.0) for side in ("lower", "upper"))
        if low > high:
            self.notes.append(f"{where}: its lower limit {low:g} is above the upper one {high:g}; left out")
        return limits_between(low, high) if low <= high else ()

    def _inertial(self, link: Element) -> Inertial | None:
        """Read the mass of a link: none where only others have one, unknown where no link has."""
        found, where = link.find("inertial"), f"{self.file}: {tag(link)}: inertial"
        if found is None:
            return NONE if self.root.find("link/inertial") is not None else None
        given = {each.tag: each for each in found}
        mass = numbers(given["mass"].get("value") if "mass" in given else None, 1, f"{where}: mass")
        matrix = given["inertia"].attrib if "inertia" in given else {}
        six = [float(numbers(matrix.get(name), 1, f"{where}: {name}", (0,))[0]) for name in SIX]
        return inertial(
            float(mass[0]), self._origin(given.get("origin"), f"{tag(link)}: inertial"), six, where, self.notes
        )

    def _shapes(self, link: Element, what: str) -> tuple[LinkShape, ...]:
        """Read the solids of the elements `what` of a link: "visual" or "collision"."""
        return tuple(shape for each in link.iterfind(what) if (shape := self._shape(each, tag(link))) is not None)

    def _shape(self, each: Element, where: str) -> LinkShape | None:
        pose = self._origin(each.find("origin"), where)
        where = f"{self.file}: {where}"
        for solid in each.iterfind("geometry/*"):
            if solid.tag == "box":
                return LinkShape(pose, "box", tuple(numbers(solid.get("size"), 3, where)))
            if solid.tag == "sphere":
                return LinkShape(pose, "sphere", tuple(numbers(solid.get("radius"), 1, where)))
            if solid.tag in ("cylinder", "capsule"):
                size = [float(numbers(solid.get(key), 1, where)[0]) for key in ("radius", "length")]
                return LinkShape(pose, solid.tag, tuple(size))
            if solid.tag == "mesh":
                scale = tuple(numbers(solid.get("scale"), 3, where, (1, 1, 1)))
                return LinkShape(pose, "mesh", scale, solid.get("filename", ""))
            self.notes.append(f"{where}: {tag(solid)} is no solid that is known; left out")
        return None

    def _loop(self, number: int, pair: LoopPair, joints: dict, poses: dict[str, Transform]) -> RobotJoint:
        """Make the joint that holds two frames together."""
        one, other, kind = pair
        links = [self._link_of(name, joints) for name in (one, other)]
        where = f"{self.loops.name}: closed_loop {number}"
        if links[0] == links[1]:
            raise ValueError(f"{where}: {one!r} and {other!r} are on the same link, {links[0]!r}")
        name = f"{one}-{other}"
        if name in joints:
            raise ValueError(f"{where}: there is a joint {name!r} already; rename it")
        first, second = (poses[link].copy() for link in links)
        if kind is JointKind.SPHERICAL:  # its coordinates are zero where the file has the links
            first[:3, :3] = second[:3, :3] = np.eye(3)
        what = "3d" if kind is JointKind.SPHERICAL else "6d"
        return RobotJoint(name, (links[0], links[1]), kind, first, second, f"closed_loop {name!r} ({what})")

    def _link_of(self, name: str, joints: dict[str, RobotJoint]) -> str:
        """Find the link whose frame a name means: the child of the joint, or the link itself."""
        if name in joints:
            return joints[name].parts[1]
        if name in self.links:
            return name
        known = [*joints, *self.links]
        raise ValueError(f"{self.loops.name}: closed_loop names the unknown frame {name!r}{nearest(name, known)}")

    def _known(self, name: str, joints: dict[str, RobotJoint], key: str) -> None:
        if name not in joints:
            raise ValueError(f"{self.loops.name}: {key} names the unknown joint {name!r}{nearest(name, joints)}")

    def _named_motors(self, joints: dict[str, RobotJoint]) -> list[str]:
        for name in self.loops.motors:
            self._known(name, joints, "name_mot")
        return [name for name in self.loops.motors if self._moves(joints[name], "name_mot")]

    def _transmissions(self, joints: dict[str, RobotJoint]) -> list[str]:
        """Find the joints that a transmission or a controller moves."""
        found = []
        for each in [*self.root.iterfind("transmission"), *self.root.iterfind("ros2_control")]:
            for joint in each.iterfind("joint"):
                name = joint.get("name", "")
                if each.tag == "ros2_control" and joint.find("command_interface") is None:
                    continue  # it is only measured
                if name not in joints:
                    self.notes.append(f"{self.file}: {tag(each)} is of the unknown joint {name!r}; left out")
                elif self._moves(joints[name], tag(each)):
                    found.append(name)
        return found

    def _moves(self, joint: RobotJoint, where: str) -> bool:
        if joint.kind is JointKind.FIXED:
            self.notes.append(f"{self.file}: {where} makes the joint {joint.name!r} a motor, but it is fixed")
        return joint.kind is not JointKind.FIXED
