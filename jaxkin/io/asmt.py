"""ASMT, the assemblies of FreeCAD's solver (OndselSolver): parts with markers, and joints between two markers.

The text is a tree by the tabs at the beginnings of its lines. It names no unit of length.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from jaxkin._files import check_file
from jaxkin._names import nearest
from jaxkin.geometry.pose import Pose, is_rigid
from jaxkin.io.robot_model import WORLD, RobotJoint, RobotLink, RobotModel, numbers, placed
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.two_frames import two_frames

FIRST_LINES = ("OndselSolver", "freeCAD: 3D CAD with Motion Simulation  by  askoh.com")
"""First lines of the files, of the solver and of the program that it comes from."""

MAX_BYTES = 256_000_000
"""Bytes of a file: most of a long one are the results of a simulation, which are not read."""

MAX_DEEP = 40
"""Tabs at the beginning of a line; markers are at eight."""

KINDS = {
    "FixedJoint": JointKind.FIXED, "RevoluteJoint": JointKind.REVOLUTE, "TranslationalJoint": JointKind.PRISMATIC,
    "CylindricalJoint": JointKind.CYLINDRICAL, "SphericalJoint": JointKind.SPHERICAL, "PlanarJoint": JointKind.PLANAR,
    "UniversalJoint": JointKind.UNIVERSAL,
}  # fmt: skip
"""Joints -> kind."""

IN_TURN = {
    "PointInLineJoint": (JointKind.PRISMATIC, JointKind.SPHERICAL),
    "PointInPlaneJoint": (JointKind.PLANAR, JointKind.SPHERICAL),
}
"""Joints that are two in turn, with a part without a solid between them: from the first marker to the second."""

NOT_KEPT = ("AngleJoint", "GearJoint", "NoRotationJoint", "ParallelAxesJoint", "PerpendicularJoint", "RackPinionJoint",
            "ConstantVelocityJoint", "SphSphJoint", "CylSphJoint", "RevCylJoint", "RevRevJoint",
            "LineInPlaneJoint")  # fmt: skip
"""Joints that are relations between others, or that no joint here is."""

SCREW = "ScrewJoint"
"""A relation between the turn and the advance of a cylindrical joint."""

MOTIONS = {"RotationalMotion": "phi", "TranslationalMotion": "z"}
"""Motions -> the coordinate of a joint that they drive."""

LIMITS = {"RotationLimit": "phi", "TranslationLimit": "z"}
"""Limits -> the coordinate of a joint."""

ROTATION = 1e-5
"""Largest error of the entries of a rotation that is made exact: six digits."""


@dataclass
class Node:
    """A line of the file, with those below it that begin with more tabs."""

    text: str
    number: int
    inner: list[Node] = field(default_factory=list)

    def find(self, key: str) -> Node | None:
        return next((each for each in self.inner if each.text == key), None)

    def every(self, *keys: str) -> Iterator[Node]:
        """Yield what is inside of the elements along a path."""
        found = self
        for key in keys:
            if (found := found.find(key)) is None:
                return
        yield from found.inner

    def said(self, key: str) -> str:
        """Read the one line inside of an element; empty where there is none."""
        found = self.find(key)
        return found.inner[0].text if found is not None and found.inner else ""


def read_asmt(path: Path) -> RobotModel:
    """Read an assembly; ValueError, in one line, for what is no such file or not understood."""
    if (size := check_file(path, "ASMT file")) > MAX_BYTES:
        raise ValueError(f"{path.name}: {size} bytes; at most {MAX_BYTES} are read")
    return _Reader(path.name, _tree(path)).model()


def _tree(path: Path) -> Node:
    """Read the assembly of a file as a tree."""
    with path.open(encoding="utf-8", errors="replace") as file:
        if file.readline().strip() not in FIRST_LINES:
            raise ValueError(f"{path.name}: expected an assembly of FreeCAD's solver, {FIRST_LINES[0]!r} in line 1")
        root = Node("", 0)
        open_nodes = [root]
        for number, line in enumerate(file, start=2):
            text = line.strip("\t\r\n")
            if not text.strip():
                continue
            depth = len(line) - len(line.lstrip("\t"))
            if depth == 0 and len(root.inner) == 1:
                break  # the results of a simulation
            if not depth < min(MAX_DEEP, len(open_nodes)):
                raise ValueError(f"{path.name}, line {number}: {text[:40]!r} begins with too many tabs")
            node = Node(text, number)
            open_nodes[depth].inner.append(node)
            open_nodes[depth + 1 :] = [node]
    if (found := root.find("Assembly")) is None:
        raise ValueError(f"{path.name}: there is no Assembly in it")
    return found


class _Reader:
    """The parts and joints of one assembly."""

    def __init__(self, file: str, root: Node) -> None:
        self.file, self.root = file, root
        self.notes: list[str] = []
        self.name = root.said("Name")
        self.links = {WORLD: RobotLink(WORLD, np.eye(4))}
        self.markers: dict[str, tuple[str, Pose]] = {}
        self.joints: list[RobotJoint] = []

    def model(self) -> RobotModel:
        ground = self._pose(self.root)
        self._markers(self.root, WORLD, ground, f"/{self.name}")
        for each in self.root.every("Parts"):
            name = each.said("Name")
            if name in self.links:
                raise ValueError(f"{self.file}, line {each.number}: another part is called {name!r}")
            pose = ground @ self._pose(each)
            self.links[name] = RobotLink(name, pose)
            self._markers(each, name, pose, f"/{self.name}/{name}")
        if len(self.links) == 1:
            raise ValueError(f"{self.file}: there are no Parts in it")
        sides: dict[str, tuple[str, str]] = {}
        for each in self.root.every("ConstraintSets", "Joints"):
            sides[f"/{self.name}/{each.said('Name')}"] = each.said("MarkerI"), each.said("MarkerJ")
            self._joint(each)
        known = {each.name: each for each in self.joints}
        for each in self.root.every("ConstraintSets", "Joints"):
            if each.text == SCREW:
                self._screw(each, known)
        motors = [self._motor(each, known, sides) for each in self.root.every("ConstraintSets", "Motions")]
        for each in self.root.every("ConstraintSets", "Limits"):
            self._limit(each, known, sides)
        for each in self.root.every("ConstraintSets", "GeneralConstraintSets"):
            self.notes.append(f"{self.file}: {each.text} {each.said('Name')!r} is not understood; left out")
        joints = tuple(known.values())
        needed = {part for each in joints for part in each.parts}
        links = tuple(link for name, link in self.links.items() if name != WORLD or name in needed)
        driven = tuple(dict.fromkeys(each for each in motors if each))
        return RobotModel(links, joints, (WORLD,) if WORLD in needed else (), driven, tuple(self.notes), unit="")

    def _pose(self, node: Node) -> Pose:
        where = f"{self.file}, line {node.number}: {node.text}"
        place = node.find("Position3D")
        point = numbers(node.said("Position3D"), 3, f"{where}: Position3D") if place else np.zeros(3)
        rows = [numbers(each.text, 3, f"{where}: RotationMatrix") for each in node.every("RotationMatrix")]
        turn = np.array(rows) if rows else np.eye(3)
        if turn.shape != (3, 3) or np.abs(turn @ turn.T - np.eye(3)).max() > ROTATION or np.linalg.det(turn) < 0:
            raise ValueError(f"{where}: expected a RotationMatrix of three rows, got {turn.tolist()}")
        left, _, right = np.linalg.svd(turn)
        return placed(turn if is_rigid(placed(turn, point)) else left @ right, point)

    def _markers(self, node: Node, link: str, pose: Pose, path: str) -> None:
        for point in node.every("RefPoints"):
            for each in point.every("Markers"):
                self.markers[f"{path}/{each.said('Name')}"] = link, pose @ self._pose(point) @ self._pose(each)

    def _joint(self, node: Node) -> None:
        """Read a joint; what is none is added to the notes."""
        name = node.said("Name")
        where = f"{self.file}: {node.text} {name!r}"
        if node.text == SCREW:
            return  # it relates the coordinates of another joint
        if node.text in NOT_KEPT:
            self.notes.append(f"{where} is not kept")
            return
        if node.text not in KINDS and node.text not in IN_TURN:
            raise ValueError(f"{where}: expected one of {', '.join((*KINDS, *IN_TURN, *NOT_KEPT))}")
        (one, first), (other, second) = (self._marker(node.said(key), where) for key in ("MarkerI", "MarkerJ"))
        if one == other:
            self.notes.append(f"{where} is between two markers of {one!r}; left out")
            return
        offset = float(numbers(node.said("offset") or "0", 1, f"{where}: offset")[0])
        first = first @ placed(np.eye(3), (0.0, 0.0, offset))
        kinds = (KINDS[node.text],) if node.text in KINDS else IN_TURN[node.text]
        text, before = f"{node.text} {name!r}", one
        if len(kinds) > 1:
            between = f"{name}/1"
            self.links[between] = RobotLink(between, second)
            self._add(f"{name}/1", (one, between), kinds[0], first, placed(first[:3, :3], second[:3, 3]), text, where)
            first, before = second, between
        self._add(name, (before, other), kinds[-1], first, second, text, where)

    def _screw(self, node: Node, known: dict[str, RobotJoint]) -> None:
        """Make a screw of the cylindrical joint between the same two parts; without one it is noted."""
        where = f"{self.file}: {node.text} {node.said('Name')!r}"
        parts = {self._marker(node.said(key), where)[0] for key in ("MarkerI", "MarkerJ")}
        pin = next((e for e in known.values() if e.kind is JointKind.CYLINDRICAL and {*e.parts} == parts), None)
        if pin is None:
            self.notes.append(f"{where} is not kept: there is no CylindricalJoint between its two parts")
        else:
            pitch = float(numbers(node.said("pitch"), 1, f"{where}: pitch")[0])
            known[pin.name] = replace(pin, kind=JointKind.SCREW, pitch=pitch, values=pin.values[1:])

    def _add(self, name: str, parts: tuple, kind: JointKind, first: Pose, second: Pose, text: str, where: str) -> None:
        try:
            frames = two_frames(kind, first, second)
        except ValueError as error:
            raise ValueError(f"{where}: {error}") from None
        self.joints.append(RobotJoint(name, parts, kind, frames.frame_1, frames.frame_2, text, values=frames.values))

    def _marker(self, path: str, where: str) -> tuple[str, Pose]:
        if path not in self.markers:
            raise ValueError(f"{where}: unknown marker {path!r}{nearest(path, self.markers)}")
        return self.markers[path]

    def _target(self, node: Node, known: dict[str, RobotJoint], sides: dict[str, tuple[str, str]]) -> RobotJoint | None:
        """Find the joint that a motion or a limit is of: named, or between the same two markers."""
        path = node.said("MotionJoint")
        if path not in sides:
            markers = node.said("MarkerI"), node.said("MarkerJ")
            path = next((name for name, own in sides.items() if own == markers and all(own)), path)
        return known.get(path.removeprefix(f"/{self.name}/"))

    def _motor(self, node: Node, known: dict[str, RobotJoint], sides: dict[str, tuple[str, str]]) -> str | None:
        joint, coordinate = self._target(node, known, sides), MOTIONS.get(node.text)
        where = f"{self.file}: {node.text} {node.said('Name')!r}"
        names = () if joint is None else COORDINATES.get(joint.kind, ())
        if joint is None or coordinate not in names:
            self.notes.append(f"{where} drives no coordinate of a joint that is read; left out")
            return None
        return joint.name if len(names) == 1 else f"{joint.name}.{coordinate}"

    def _limit(self, node: Node, known: dict[str, RobotJoint], sides: dict[str, tuple[str, str]]) -> None:
        """Add a limit to its joint; one that is of none, or not understood, is noted."""
        joint, coordinate = self._target(node, known, sides), LIMITS.get(node.text)
        where = f"{self.file}: {node.text} {node.said('Name')!r}"
        names = () if joint is None else COORDINATES.get(joint.kind, ())
        bound, side = evaluated(node.said("Limit")), node.said("Type")
        if joint is None or coordinate not in names or bound is None or side not in ("=>", ">=", "=<", "<="):
            self.notes.append(f"{where} is of no coordinate of a joint that is read; left out")
            return
        limits = list(joint.limits or ((-np.inf, np.inf),) * len(names))
        number = names.index(coordinate)
        low, high = limits[number]
        bound -= joint.values[number] if joint.values else 0.0
        limits[number] = (max(low, bound), high) if ">" in side else (low, min(high, bound))
        known[joint.name] = replace(joint, limits=tuple(limits))


COORDINATES = {
    JointKind.REVOLUTE: ("phi",),
    JointKind.PRISMATIC: ("z",),
    JointKind.SCREW: ("phi",),
    JointKind.CYLINDRICAL: ("z", "phi"),
}
"""Kinds of joints whose coordinates motions and limits are of -> names of these."""

_OPERATIONS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}


def evaluated(text: str) -> float | None:
    """Compute an expression of numbers, pi, + - * / and brackets, such as "30.0*pi/180.0"; None for any other."""

    def value(node: ast.AST) -> float:
        if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            return float(node.value)
        if isinstance(node, ast.Name) and node.id == "pi":
            return float(np.pi)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            return -value(node.operand)
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATIONS:
            return _OPERATIONS[type(node.op)](value(node.left), value(node.right))
        raise ValueError

    try:
        return value(ast.parse(text.strip(), mode="eval").body) if len(text) <= 200 else None
    except (ValueError, SyntaxError, ZeroDivisionError, RecursionError):
        return None
