"""URDF, and the file of its loops, written from a mechanism: a shallow tree of links, and frames held together.

The axes of all links are those of the world in the assembled pose, and a link begins where its joint is. A loop is
closed where the tree leaves a joint out: for a ball by the centres of its two sides ("3d"), else by two frames that
coincide ("6d"), the first of which is at the end of a chain with the coordinates of the joint.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from jaxkin._arguments import check_mechanism
from jaxkin._files import check_folder, whole
from jaxkin._names import listed
from jaxkin.geometry.units import METRES
from jaxkin.io.names import unique
from jaxkin.io.numbers import written
from jaxkin.io.robot_inertials import SIX
from jaxkin.io.robot_loops import SPHERICAL, has_loops
from jaxkin.io.robot_model import UNLIMITED, WORLD
from jaxkin.io.single_motions import BALL, SLIDE, SingleMotion, coordinate_names, coordinate_scale, single_motions
from jaxkin.io.writable import check_robot
from jaxkin.io.written_masses import written_inertials
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.coordinates import coordinate
from jaxkin.topology.shallow_tree import shallow_tree

if TYPE_CHECKING:
    from jaxkin.effects.forces.masses import Masses
    from jaxkin.geometry.inertial import Inertial
    from jaxkin.geometry.part import Part
    from jaxkin.mechanism.mechanism import Mechanism

NOT_IN_FILE_NAMES = re.compile(r"[^A-Za-z0-9_.-]+")
"""Letters that names of mesh files are written without, whatever parts are called."""


def write_urdf(mechanism: Mechanism, path: str | os.PathLike[str], *, masses: Masses | None = None) -> Path:
    """Write a mechanism as a robot (.urdf), in metres, and return its path.

    Beside it are written its loops, in the YAML file "NAME.yaml" with the keys of Gepetto's example-parallel-robots,
    and its solids, in the folder "NAME_meshes". `jk.load(path, loops=...)` reads it all back. The file of loops is
    there where the mechanism has loops or balls, and is taken away where it has none. A coordinate of a joint that has
    several is a joint of its own there, "joint_phi"; each file appears whole or not at all.

    Links weigh what the file says that the mechanism was read from, or what `masses`, found by `jk.masses`, say.
    Readers take a link without a mass for one that weighs nothing where others have masses: a warning names those of
    which nothing is known.

    Raises ValueError for traced numbers, for a mechanism whose lengths were changed, whose parts are not in a closed
    pose, for a coupling that is not linear in two coordinates, which is all that URDF has, and for `masses` of another
    mechanism.
    """
    check_mechanism(mechanism, "written files")
    target = Path(path)
    if target.suffix.lower() != ".urdf":
        raise ValueError(f"a robot in URDF is a .urdf file, got {str(target)!r}")
    check_folder(target)
    writer = _Writer(mechanism, target.stem, written_inertials(mechanism, masses))
    ElementTree.indent(writer.root)
    loops = target.with_suffix(".yaml")
    old = loops.is_file() and has_loops(loops)
    if writer.loops and loops.exists() and not old:
        raise ValueError(
            f"{loops} is there, and no file of loops, which it would become: choose another name for {target.name}"
        )
    if writer.meshes:
        target.with_name(writer.folder).mkdir(exist_ok=True)
    with ExitStack() as files:
        for name, text in writer.meshes.items():
            files.enter_context(whole(target.with_name(writer.folder) / name)).write_text(text, encoding="utf-8")
        if writer.loops:
            files.enter_context(whole(loops)).write_text(writer.loops, encoding="utf-8")
        ElementTree.ElementTree(writer.root).write(
            files.enter_context(whole(target)), encoding="utf-8", xml_declaration=True
        )
    if not writer.loops and old:
        loops.unlink()  # of an earlier mechanism
    return target


class _Writer:
    """The elements of one robot, and the texts of the files beside it."""

    def __init__(self, mechanism: Mechanism, name: str, inertials: Mapping[str, Inertial]) -> None:
        check_robot(mechanism, "robot")
        self.mechanism, self.metres = mechanism, METRES[mechanism.unit]
        self.folder = f"{name}_meshes"
        self.root = Element("robot", name=name)
        self.joint_names = coordinate_names(mechanism.all_joints)
        self.joints: dict[str, Element] = {}
        self.balls: list[str] = []
        self.pairs: list[tuple[str, str, str]] = []
        """Of each closed loop its two frames and its type."""
        self.meshes: dict[str, str] = {}
        self.begun: dict[str, np.ndarray] = {}
        """Of each link the place where it begins, metres."""
        self.links = {part: self._link(part, np.zeros(3)) for part in self._roots()}
        self._tree()
        for solid in mechanism.solids:
            self._solid(solid)
        for part, inertial in inertials.items():
            self._inertial(part, inertial)
        if inertials:
            _warn_of_unknown_masses(mechanism, inertials)
        for coupling in mechanism.linkage.couplings:
            self._coupling(coupling)
        motors = [self._motor(motor) for motor in mechanism.motors]
        self.loops = self._loops(motors) if self.pairs or self.balls else ""

    def _roots(self) -> tuple[str, ...]:
        """List the fixed parts, first that which is the root link."""
        fixed = self.mechanism.fixed
        return (WORLD, *(part for part in fixed if part != WORLD)) if WORLD in fixed else fixed

    def _tree(self) -> None:
        """Write the links in the order of the tree from the root, and close the loops."""
        root, *others = self._roots()
        for part in others:
            self._join(f"{part} on {root}", "fixed", self.links[root], self.links[part])
        joints = self.mechanism.all_joints
        costs = [joint.freedoms for joint in joints]
        tree = shallow_tree(self.mechanism.structure.joint_parts, self._roots(), costs)
        for part, parent, number, sign in tree:
            self.links[part] = self._chain(number, sign, self.links[parent], part)
        for number in sorted({*range(len(joints))} - {branch.joint for branch in tree}):
            self._close(number, joints[number])

    def _link(self, name: str, begin: np.ndarray) -> str:
        """Write a link that begins at a point of the world, metres; returns its name, which no other link has."""
        name = unique([*self.begun, name])[-1]
        SubElement(self.root, "link", name=name)
        self.begun[name] = begin
        return name

    def _join(self, name: str, kind: str, parent: str, child: str) -> Element:
        """Write a joint where the child link begins."""
        name = unique([*self.joints, name])[-1]
        joint = self.joints[name] = SubElement(self.root, "joint", name=name, type=kind)
        SubElement(joint, "origin", xyz=written(*self.begun[child] - self.begun[parent]), rpy="0 0 0")
        SubElement(joint, "parent", link=parent)
        SubElement(joint, "child", link=child)
        return joint

    def _chain(self, number: int, sign: int, parent: str, part: str) -> str:
        """Write a joint as a chain of links that ends in the link of a part; returns the name of that one."""
        joint = self.mechanism.all_joints[number]
        motions = single_motions(joint, self.joint_names[number], self.metres, sign)
        if not motions:
            point = np.asarray(joint.frames_1, float)[0, :3, 3] * self.metres
            child = self._link(part, point)
            self._join(joint.name, "fixed", parent, child)
            return child
        for step, motion in enumerate(motions, start=1):
            child = self._link(part if step == len(motions) else f"{part}/{step}", motion.point)
            self._motion(motion, parent, child)
            parent = child
        return parent

    def _motion(self, motion: SingleMotion, parent: str, child: str) -> None:
        limited = np.isfinite(motion.limits).any()
        kind = "prismatic" if motion.kind == SLIDE else "revolute" if limited else "continuous"
        joint = self._join(motion.name, kind, parent, child)
        SubElement(joint, "axis", xyz=written(*motion.axis))
        low, high = np.clip(motion.limits, -UNLIMITED, UNLIMITED)
        # a slide needs its ends, since readers take zero for an end that is not written
        ends = {"lower": written(low), "upper": written(high)} if kind != "continuous" else {}
        SubElement(joint, "limit", ends | {"effort": written(UNLIMITED), "velocity": written(UNLIMITED)})
        if motion.follows is not None:
            leader, factor = motion.follows
            self._mimic(motion.name, leader, factor, 0.0)
        if motion.kind == BALL:
            self.balls.append(motion.name)

    def _mimic(self, follower: str, leader: str, factor: float, offset: float) -> None:
        SubElement(self.joints[follower], "mimic", joint=leader, multiplier=written(factor), offset=written(offset))

    def _close(self, number: int, joint: Joint) -> None:
        """Close a loop at a joint that the tree leaves out."""
        one, other = (self.links[part] for part in joint.parts)
        point = np.asarray(joint.frames_1, float)[0, :3, 3] * self.metres
        ball = joint.kind is JointKind.SPHERICAL
        if joint.freedoms and not ball:
            one = self._chain(number, 1, one, f"{joint.name} end")
        first, second = (self._frame(f"{joint.name} {side}", link, point) for side, link in ((1, one), (2, other)))
        self.pairs.append((first, second, "3d" if ball else "6d"))

    def _frame(self, name: str, link: str, point: np.ndarray) -> str:
        """Write a frame on a link, a link that is fixed to it, with a name that no joint has either."""
        taken = dict.fromkeys([*self.begun, *self.joints, *(each for names in self.joint_names for each in names)])
        frame, joint = unique([*taken, name, f"{name} fixed"])[-2:]
        self._link(frame, point)
        self._join(joint, "fixed", link, frame)
        return frame

    def _element(self, part: str) -> Element:
        """Find the element of the link of a part."""
        name = self.links[part]
        return next(each for each in self.root.iterfind("link") if each.get("name") == name)

    def _inertial(self, part: str, given: Inertial) -> None:
        """Write what a part weighs into its link, whose axes are those of the world."""
        inertial = SubElement(self._element(part), "inertial")
        SubElement(inertial, "origin", xyz=written(*given.centre - self.begun[self.links[part]]), rpy="0 0 0")
        SubElement(inertial, "mass", value=written(given.mass))
        rows = {name: given.inertia["xyz".index(name[1]), "xyz".index(name[2])] for name in SIX}
        SubElement(inertial, "inertia", {name: written(value) for name, value in rows.items()})

    def _solid(self, solid: Part) -> None:
        """Write the triangles of a part into a mesh of its own, and name it in its link."""
        if not len(solid.triangles) or not solid.is_solid:
            return
        corners = np.asarray(solid.triangles, float).reshape(-1, 3) * self.metres
        points, faces = np.unique(corners, axis=0, return_inverse=True)
        lines = [f"v {written(*point)}" for point in points]
        lines += [f"f {' '.join(map(str, face))}" for face in faces.reshape(-1, 3) + 1]
        clean = NOT_IN_FILE_NAMES.sub("_", solid.name)
        file = unique([*(name.removesuffix(".obj") for name in self.meshes), clean])[-1].replace("#", "_") + ".obj"
        self.meshes[file] = "\n".join(lines) + "\n"
        visual = SubElement(self._element(solid.name), "visual")
        SubElement(visual, "origin", xyz=written(*-self.begun[self.links[solid.name]]), rpy="0 0 0")
        SubElement(SubElement(visual, "geometry"), "mesh", filename=f"{self.folder}/{file}")

    def _coupling(self, coupling: Coupling) -> None:
        """Write a coupling of two coordinates as a joint that follows the other one."""
        linkage, joints = self.mechanism.linkage, self.mechanism.all_joints
        places = [coordinate(linkage, name) for name in coupling.coordinates]
        names = [self.joint_names[joint][column] for joint, column in places]
        factors = np.asarray(coupling.coefficients, float)
        free = [name not in self.balls and self.joints[name].find("mimic") is None for name in names]
        if len(names) != 2 or factors[:, 1:].any() or not factors[:, 0].all() or not any(free):
            raise ValueError(
                f"URDF cannot say the coupling {coupling.name!r}, {coupling}: a joint there follows one other joint, "
                "linearly, and only one; write the mechanism without it, and what it ties, "
                f"{listed(list(map(repr, coupling.coordinates)))}, moves on its own; jk.write_mjcf has more couplings"
            )
        scales = [coordinate_scale(joints[joint], column, self.metres) for joint, column in places]
        by = factors[:, 0] / scales
        driven = [name in self.mechanism.motors for name in coupling.coordinates]
        follower = max((0, 1), key=lambda side: (free[side], not driven[side]))
        leader = 1 - follower
        self._mimic(names[follower], names[leader], -by[leader] / by[follower], float(coupling.offset) / by[follower])

    def _motor(self, motor: str) -> str:
        joint, column = coordinate(self.mechanism.linkage, motor)
        name = self.joint_names[joint][column]
        transmission = SubElement(self.root, "transmission", name=f"{name} transmission")
        SubElement(transmission, "type").text = "transmission_interface/SimpleTransmission"
        SubElement(transmission, "joint", name=name)
        SubElement(transmission, "actuator", name=f"{name} motor")
        return name

    def _loops(self, motors: Sequence[str]) -> str:
        """Write the file of loops."""
        pairs = ", ".join(f"[{_quoted(one)}, {_quoted(other)}]" for one, other, _ in self.pairs)
        keys = {
            "closed_loop": pairs,
            "type": ", ".join(_quoted(kind) for *_, kind in self.pairs),
            "name_mot": ", ".join(map(_quoted, motors)),
            "joint_name": ", ".join(map(_quoted, self.balls)),
            "joint_type": ", ".join(_quoted(SPHERICAL) for _ in self.balls),
        }
        return "".join(f"{key}: [{said}]\n" for key, said in keys.items() if said)


def _warn_of_unknown_masses(mechanism: Mechanism, inertials: Mapping[str, Inertial]) -> None:
    """Name the parts that move, and will be read as weighing nothing."""
    if unknown := [part for part in mechanism.parts if part not in {*inertials, *mechanism.fixed}]:
        one = len(unknown) == 1
        warnings.warn(
            f"nothing is known of what {listed(list(map(repr, unknown)))} {'weighs' if one else 'weigh'}, and "
            f"readers of URDF take {'it' if one else 'them'} to weigh nothing, since other links have masses: write "
            "jk.write_urdf(mechanism, path, masses=jk.masses(mechanism, ...))",
            stacklevel=4,
        )


def _quoted(name: str) -> str:
    """Write a name in single quotes, which are doubled inside."""
    doubled = name.replace("'", "''")
    return f"'{doubled}'"
