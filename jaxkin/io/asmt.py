"""ASMT, the assemblies of FreeCAD's solver (OndselSolver): parts with markers, and joints between two markers.

The text is a tree by the tabs at the beginnings of its lines. It names no unit of length.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from jaxkin._files import check_file
from jaxkin._names import nearest
from jaxkin.geometry.inertial import Inertial
from jaxkin.geometry.pose import Transform, is_rigid
from jaxkin.io.marker_joints import ANGLE, ANGLES, CHAINS, KINDS, Marker, MarkerJoints
from jaxkin.io.marker_ties import GEAR, RACK, SCREW, TIES, MarkerTie, RigidGroups, add_tie
from jaxkin.io.robot_inertials import inertial
from jaxkin.io.robot_model import WORLD, RobotLink, RobotModel, numbers, placed

FIRST_LINES = ("OndselSolver", "freeCAD: 3D CAD with Motion Simulation  by  askoh.com")
"""First lines of the files, of the solver and of the program that it comes from."""

MAX_BYTES = 256_000_000
"""Bytes of a file: most of a long one are the results of a simulation, which are not read."""

BEHIND_JOINTS = "ForceTorques"
"""What the solver writes and asks for behind parts, joints, motions and limits: a file without it has lost some."""

MAX_DEEP = 40
"""Tabs at the beginning of a line; markers are at eight."""

NOT_KEPT = ("ConstantVelocityJoint",)
"""Joints that are named and left out."""

SIZES = {
    "offset": "offset", "distance": "distanceIJ", "angle": "theIzJz", "radius_i": "radiusI", "radius_j": "radiusJ",
    "radius": "pitchRadius", "pitch": "pitch",
}  # fmt: skip
"""Size of a joint -> its key in the file."""

SIZES_OF = {GEAR: ("radius_i", "radius_j"), RACK: ("radius",), SCREW: ("pitch",)}
"""Joints that tie others -> the sizes that they must have."""

UNKNOWN_MASS = 1.0
"""Mass, and each moment of inertia, of a part of which these are not known: the solver asks for some, and FreeCAD
computes none, but writes these for every part that it exports (its `AssemblyObject::makeMbdPart`)."""

MOTIONS = {"RotationalMotion": "phi", "TranslationalMotion": "z"}
"""Motions -> the coordinate of a joint that they drive."""

LIMITS = {"RotationLimit": "phi", "TranslationLimit": "z"}
"""Limits -> the coordinate of a joint."""

ROTATION = 1e-5
"""Largest error of the entries of a rotation that is made exact: six digits."""


@dataclass
class AsmtNode:
    """A line of the file, with those below it that begin with more tabs."""

    text: str
    number: int
    inner: list[AsmtNode] = field(default_factory=list)

    def find(self, key: str) -> AsmtNode | None:
        return next((each for each in self.inner if each.text == key), None)

    def every(self, *keys: str) -> Iterator[AsmtNode]:
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


def _tree(path: Path) -> AsmtNode:
    """Read the assembly of a file as a tree."""
    with path.open(encoding="utf-8", errors="replace") as file:
        if file.readline().strip() not in FIRST_LINES:
            raise ValueError(f"{path.name}: expected an assembly of FreeCAD's solver, {FIRST_LINES[0]!r} in line 1")
        root = AsmtNode("", 0)
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
            node = AsmtNode(text, number)
            open_nodes[depth].inner.append(node)
            open_nodes[depth + 1 :] = [node]
    if (found := root.find("Assembly")) is None:
        raise ValueError(f"{path.name}: there is no Assembly in it")
    return found


class _Reader:
    """The parts and joints of one assembly."""

    def __init__(self, file: str, root: AsmtNode) -> None:
        self.file, self.root = file, root
        self.name = root.said("Name")
        self.made = MarkerJoints(file, {WORLD: RobotLink(WORLD, np.eye(4))})
        self.markers: dict[str, Marker] = {}
        self.sides: dict[str, tuple[str, str]] = {}
        """Path of a joint -> paths of its markers."""

    def model(self) -> RobotModel:
        made = self.made
        ground = self._pose(self.root)
        self._markers(self.root, WORLD, ground, f"/{self.name}")
        for each in self.root.every("Parts"):
            name = each.said("Name")
            if name in made.links:
                raise ValueError(f"{self.file}, line {each.number}: another part is called {name!r}")
            pose = ground @ self._pose(each)
            made.links[name] = RobotLink(name, pose, inertial=self._inertial(each, name))
            self._markers(each, name, pose, f"/{self.name}/{name}")
        if len(made.links) == 1:
            raise ValueError(f"{self.file}: there are no Parts in it")
        if self.root.find(BEHIND_JOINTS) is None:
            raise ValueError(
                f"{self.file} is cut off: there is no {BEHIND_JOINTS} behind the joints; copy or export it again"
            )
        joints = list(self.root.every("ConstraintSets", "Joints"))
        for each in joints:
            self.sides[f"/{self.name}/{each.said('Name')}"] = each.said("MarkerI"), each.said("MarkerJ")
            self._joint(each)
        bodies = RigidGroups.among(made, (WORLD,))
        for each in sorted(joints, key=lambda joint: joint.text != SCREW):  # screws first: gears may turn them
            if each.text in TIES:
                sizes = self._sizes(each, SIZES_OF[each.text])
                add_tie(made, bodies, MarkerTie(each.text, each.said("Name"), *self._ends(each), sizes, _called(each)))
        motors = [
            made.motor(self._target(each), MOTIONS.get(each.text), _called(each))
            for each in self.root.every("ConstraintSets", "Motions")
        ]
        for each in self.root.every("ConstraintSets", "Limits"):
            self._limit(each)
        for each in self.root.every("ConstraintSets", "GeneralConstraintSets"):
            made.notes.append(f"{self.file}: {_called(each)} is not understood; left out")
        needed = {part for each in made.joints.values() for part in each.parts}
        return RobotModel(
            tuple(link for name, link in made.links.items() if name != WORLD or name in needed),
            tuple(made.joints.values()),
            (WORLD,) if WORLD in needed else (),
            tuple(dict.fromkeys(each for each in motors if each)),
            tuple(made.notes),
            tuple(made.couplings),
            unit="",
        )

    def _pose(self, node: AsmtNode) -> Transform:
        where = f"{self.file}, line {node.number}: {node.text}"
        place = node.find("Position3D")
        point = numbers(node.said("Position3D"), 3, f"{where}: Position3D") if place else np.zeros(3)
        rows = [numbers(each.text, 3, f"{where}: RotationMatrix") for each in node.every("RotationMatrix")]
        turn = np.array(rows) if node.find("RotationMatrix") else np.eye(3)
        if turn.shape != (3, 3) or np.abs(turn @ turn.T - np.eye(3)).max() > ROTATION or np.linalg.det(turn) < 0:
            raise ValueError(f"{where}: expected a RotationMatrix of three rows, got {turn.tolist()}")
        left, _, right = np.linalg.svd(turn)
        return placed(turn if is_rigid(placed(turn, point)) else left @ right, point)

    def _inertial(self, node: AsmtNode, name: str) -> Inertial | None:
        """Read the mass of a part, its centre and its principal moments; None for the placeholder of unknown ones."""
        found = node.find("PrincipalMassMarker")
        if found is None or not found.said("Mass"):
            return None
        where = f"{self.file}: Part {name!r}: PrincipalMassMarker"
        mass = float(numbers(found.said("Mass"), 1, f"{where}: Mass")[0])
        moments = numbers(found.said("MomentOfInertias"), 3, f"{where}: MomentOfInertias")
        if mass == UNKNOWN_MASS and np.all(moments == UNKNOWN_MASS):
            return None
        return inertial(mass, self._pose(found), (*moments, 0.0, 0.0, 0.0), where, self.made.notes)

    def _markers(self, node: AsmtNode, link: str, pose: Transform, path: str) -> None:
        for point in node.every("RefPoints"):
            for each in point.every("Markers"):
                place = pose @ self._pose(point) @ self._pose(each)
                self.markers[f"{path}/{each.said('Name')}"] = Marker(link, place)

    def _joint(self, node: AsmtNode) -> None:
        """Read a joint; what is none is added to the notes."""
        where = f"{self.file}: {_called(node)}"
        if node.text in NOT_KEPT:
            self.made.notes.append(f"{where} is not kept")
        elif node.text in (*KINDS, *ANGLES, *CHAINS):
            sizes = self._sizes(node, ("offset", "distance", "angle"))
            self.made.add(node.text, node.said("Name"), *self._ends(node), sizes, _called(node))
        elif node.text not in TIES:
            raise ValueError(f"{where}: expected one of {', '.join((*KINDS, *ANGLES, *CHAINS, *TIES, *NOT_KEPT))}")

    def _sizes(self, node: AsmtNode, names: Sequence[str]) -> dict[str, float]:
        """Read the sizes of a joint: of a tie and an angle those that it must have, of others those that are there."""
        where = f"{self.file}: {_called(node)}"
        said = {name: node.said(SIZES[name]) for name in names}
        return {
            name: float(numbers(text, 1, f"{where}: {SIZES[name]}")[0])
            for name, text in said.items()
            if text or node.text in TIES or (node.text == ANGLE and name == "angle")
        }

    def _ends(self, node: AsmtNode) -> tuple[Marker, Marker]:
        paths = node.said("MarkerI"), node.said("MarkerJ")
        for path in paths:
            if path not in self.markers:
                known = nearest(path, self.markers)
                raise ValueError(f"{self.file}: {_called(node)}: unknown marker {path!r}{known}")
        return self.markers[paths[0]], self.markers[paths[1]]

    def _target(self, node: AsmtNode) -> str:
        """Find the joint that a motion or a limit is of: named, or between the same two markers."""
        path = node.said("MotionJoint")
        if path not in self.sides:
            markers = node.said("MarkerI"), node.said("MarkerJ")
            path = next((name for name, own in self.sides.items() if own == markers and all(own)), path)
        return path.removeprefix(f"/{self.name}/")

    def _limit(self, node: AsmtNode) -> None:
        """Add a limit to its joint; one that is of none, or not understood, is noted."""
        bound, side = evaluated(node.said("Limit")), node.said("Type")
        if bound is None or side not in ("=>", ">=", "=<", "<="):
            self.made.notes.append(f"{self.file}: {_called(node)} is not understood; left out")
            return
        ends = (bound, np.inf) if ">" in side else (-np.inf, bound)
        self.made.limit(self._target(node), LIMITS.get(node.text), *ends, _called(node))


def _called(node: AsmtNode) -> str:
    """Call an element by its kind and name, for messages."""
    return f"{node.text} {node.said('Name')!r}"


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
