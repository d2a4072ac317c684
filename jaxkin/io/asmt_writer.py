"""ASMT, the assemblies of FreeCAD's solver, written from a mechanism: parts with markers, joints between two markers.

The frame of each part is that of the world in the assembled pose, so markers are joint frames as they are. Joints make
a graph there, so that loops need nothing of their own.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin._arguments import check_mechanism
from jaxkin._files import whole
from jaxkin._names import listed
from jaxkin.geometry.inertial import Inertial
from jaxkin.geometry.pose import Transform
from jaxkin.geometry.units import METRES
from jaxkin.io.asmt import FIRST_LINES, LIMITS, MOTIONS, UNKNOWN_MASS
from jaxkin.io.asmt_joints import JOINT_OF, is_known, marked
from jaxkin.io.asmt_ties import tie
from jaxkin.io.marker_joints import COORDINATES
from jaxkin.io.marker_ties import SCREW
from jaxkin.io.names import unique
from jaxkin.io.numbers import written
from jaxkin.io.robot_model import WORLD, along, placed
from jaxkin.io.single_motions import BALL, HINGE, SLIDE, coordinate_names, single_motions
from jaxkin.io.writable import check_robot
from jaxkin.io.written_masses import principal_axes, written_inertials
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.coordinates import coordinate

if TYPE_CHECKING:
    from jaxkin.effects.forces.masses import Masses
    from jaxkin.mechanism.mechanism import Mechanism

SINGLE_OF = {
    HINGE: JOINT_OF[JointKind.REVOLUTE],
    SLIDE: JOINT_OF[JointKind.PRISMATIC],
    BALL: JOINT_OF[JointKind.SPHERICAL],
}
"""Kind of a single motion -> joint."""

GROUND = ""
"""What the assembly itself is called here: no part has this name."""

EXPRESSION = {"RotationalMotion": "RotationZ", "TranslationalMotion": "TranslationZ"}
"""Motions -> the key of their law."""

MOTION_OF = {coordinate: name for name, coordinate in MOTIONS.items()}
LIMIT_OF = {coordinate: name for name, coordinate in LIMITS.items()}

LAST = (
    "\tForceTorques\n\tConstantGravity\n\t\t0\t0\t0\n\tSimulationParameters\n\t\ttstart\n\t\t\t0\n\t\ttend\n\t\t\t1\n"
    "\t\thmin\n\t\t\t1e-09\n\t\thmax\n\t\t\t1\n\t\thout\n\t\t\t0.1\n\t\terrorTol\n\t\t\t1e-06\n\tAnimationParameters\n"
    "\t\tnframe\n\t\t\t11\n\t\ticurrent\n\t\t\t1\n\t\tistart\n\t\t\t1\n\t\tiend\n\t\t\t11\n\t\tisForward\n\t\t\ttrue\n"
    "\t\tframesPerSecond\n\t\t\t30\n"
)
"""What the solver expects behind the joints: how it is to simulate, which no mechanism says."""


def write_asmt(mechanism: Mechanism, path: str | os.PathLike[str], *, masses: Masses | None = None) -> Path:
    """Write a mechanism as an assembly of FreeCAD's solver (.asmt), in its own unit, and return its path.

    The file holds parts, joints, limits, gears, racks and screws, and motors as motions that hold still; it names no
    unit, and has no place for solids. Joints that the format does not have are chains of joints of one coordinate each,
    named "joint_phi". The file appears whole or not at all.

    Parts weigh what the file says that the mechanism was read from, or what `masses`, found by `jk.masses`, say: in
    kilograms, with centres and moments in the unit of the mechanism. The solver asks for the mass of every part: one
    that is not known is written as 1 with the moments 1, 1, 1, as FreeCAD does, and read back as unknown.

    Raises ValueError for traced numbers, for a mechanism whose lengths were changed, whose parts are not in a closed
    pose, for couplings that are no gear, rack or screw of two joints on one other part, and for a joint with a
    coordinate that turns or slides twice, as a constant velocity joint; and for `masses` of another mechanism.
    """
    check_mechanism(mechanism, "written files")
    target = Path(path)
    if target.suffix.lower() != ".asmt":
        raise ValueError(f"an assembly of FreeCAD's solver is an .asmt file, got {str(target)!r}")
    text = _Writer(mechanism, target.stem, written_inertials(mechanism, masses)).text()
    with whole(target) as draft:
        draft.write_text(text, encoding="utf-8")
    return target


class _Written(NamedTuple):
    """A joint of the file."""

    kind: str
    name: str
    sides: tuple[tuple[str, Transform], tuple[str, Transform]]
    """Of each marker its part, and its pose."""
    more: tuple[tuple[str, str], ...] = ()


class _Writer:
    """What one file holds."""

    def __init__(self, mechanism: Mechanism, name: str, inertials: Mapping[str, Inertial]) -> None:
        check_robot(mechanism, "assembly")
        self.name = name
        metres = METRES[mechanism.unit]
        self.inertials = {
            part: Inertial(own.mass, own.centre / metres, own.inertia / metres**2) for part, own in inertials.items()
        }
        self.grounds = (GROUND, WORLD) if WORLD in mechanism.fixed else (GROUND,)
        self.parts = [part for part in mechanism.parts if part not in self.grounds]
        self.motors = {coordinate(mechanism.linkage, motor): motor for motor in mechanism.motors}
        self.joints: list[_Written] = []
        self.motions: list[tuple[int, str]] = []
        """Of each motor the index of its joint in `joints`, and its coordinate there, "phi" or "z"."""
        self.limits: list[tuple[int, str, tuple[float, float]]] = []
        """The same of each limited coordinate, with its limits."""
        self.threads: list[_Written] = []
        names = coordinate_names(mechanism.all_joints)
        taken = [each for own in names for each in own] + [joint.name for joint in mechanism.all_joints]
        for part in mechanism.fixed:
            if part not in self.grounds:
                sides = ((GROUND, np.eye(4)), (part, np.eye(4)))
                name = unique([*dict.fromkeys(taken), f"{part} on the ground"])[-1]
                self.joints.append(_Written(JOINT_OF[JointKind.FIXED], name, sides))
        for number, joint in enumerate(mechanism.all_joints):
            moved = [column for place, column in self.motors if place == number]
            if is_known(joint, moved):
                self._one(joint, moved)
            else:
                self._chain(joint, names[number], moved)
        self.joints += self.threads  # last, as couplings: joints keep their names where others have the same
        by_name = {joint.name: joint for joint in mechanism.all_joints}
        for coupling in mechanism.linkage.couplings:
            if (found := tie(coupling, by_name, mechanism.fixed)) is None:
                raise ValueError(
                    f"ASMT cannot say the coupling {coupling.name!r}, {coupling}: its gears, racks and screws tie two "
                    "joints on one other part, a turn and a turn about parallel axes or a slide; write the mechanism "
                    f"without it, and what it ties, {listed(list(map(repr, coupling.coordinates)))}, moves on its own; "
                    "jk.write_mjcf and mechanism.save keep couplings"
                )
            sizes = tuple((key, written(size)) for key, size in found.sizes)
            self.joints.append(_Written(found.kind, coupling.name, found.sides, sizes))

    def _one(self, joint: Joint, moved: Sequence[int]) -> None:
        """Write a joint that the format has."""
        kind, markers, sizes = marked(joint)
        sides = ((joint.parts[0], markers[0]), (joint.parts[1], markers[1]))
        if joint.kind is JointKind.SCREW:
            pitch = ("pitch", written(float(joint.pitch)))
            self.threads.append(_Written(SCREW, f"{joint.name} thread", sides, (pitch,)))
        place, columns = len(self.joints), COORDINATES.get(joint.kind, ())
        self.joints.append(_Written(kind, joint.name, sides, tuple((key, written(size)) for key, size in sizes)))
        self.motions += [(place, columns[column]) for column in moved]
        self.limits += [(place, *both) for both in zip(columns, joint.limits, strict=False)]

    def _chain(self, joint: Joint, names: Sequence[str], moved: Sequence[int]) -> None:
        """Write a joint as a chain of joints of one coordinate each, with parts between them."""
        driven = {names[column] for column in moved}
        before, last = joint.parts
        motions = single_motions(joint, names, 1.0)
        for step, motion in enumerate(motions, start=1):
            if motion.follows is not None:
                raise ValueError(
                    f"ASMT cannot say the joint {joint.name!r} ({joint.kind}): its {motion.follows[0]!r} moves twice, "
                    "and no coupling of the format ties two motions of one joint; jk.write_mjcf and mechanism.save "
                    "keep it"
                )
            if motion.kind == BALL and motion.name in driven:
                raise ValueError(
                    f"ASMT cannot say that angles of the ball {joint.name!r} are motors: its motions turn about one "
                    "axis; give the mechanism without these motors, replace(mechanism, motors=())"
                )
            after = last if step == len(motions) else unique([*self.parts, f"{joint.name} link {step}"])[-1]
            self.parts += [after] if after != last else []
            frame = placed(np.eye(3) if motion.kind == BALL else along(motion.axis), motion.point)
            place, key = len(self.joints), "z" if motion.kind == SLIDE else "phi"
            self.joints.append(_Written(SINGLE_OF[motion.kind], motion.name, ((before, frame), (after, frame))))
            self.motions += [(place, key)] if motion.name in driven else []
            self.limits += [(place, key, motion.limits)] if motion.kind != BALL else []
            before = after

    def text(self) -> str:
        """Write the assembly, in the order that its solver reads."""
        names = unique(each.name for each in self.joints)
        paths = [f"/{self.name}/{name}" for name in names]
        markers: dict[str, list[tuple[str, Transform]]] = {part: [] for part in (*self.grounds, *self.parts)}
        for ground in self.grounds:
            markers[ground] = markers[GROUND]
        # readers call the assembly WORLD: a part that is called so, and moves, gets another name
        part_names = dict(zip(self.parts, unique([WORLD, *self.parts])[1:], strict=True))
        joints = ""
        for each, name in zip(self.joints, names, strict=True):
            said = _node(4, "Name", name)
            for side, (part, frame) in zip("IJ", each.sides, strict=True):
                marker = f"Marker{len(markers[part]) + 1}"
                markers[part].append((marker, frame))
                said += _node(4, f"Marker{side}", self._path(part_names.get(part, GROUND), marker))
            joints += f"\t\t\t{each.kind}\n{said}{''.join(_node(4, *pair) for pair in each.more)}"
        parts = "".join(
            f"\t\tPart\n{_node(3, 'Name', part_names[part])}{_place(3, np.eye(4))}{_at_rest(3)}\t\t\tFeatureOrder\n"
            f"{self._mass(3, part)}{_markers(3, markers[part])}"
            for part in self.parts
        )
        return (
            f"{FIRST_LINES[0]}\nAssembly\n{_node(1, 'Notes', 'written by jaxkin')}{_node(1, 'Name', self.name)}"
            f"{_place(1, np.eye(4))}{_at_rest(1)}{_markers(1, markers[GROUND])}\tParts\n{parts}\tKinematicIJs\n"
            f"\tConstraintSets\n\t\tJoints\n{joints}\t\tMotions\n{self._motions(paths)}{self._limits(paths)}"
            f"\t\tGeneralConstraintSets\n{LAST}"
        )

    def _mass(self, depth: int, part: str) -> str:
        """Write the mass of a part, which the solver asks for: a placeholder where it is not known."""
        own, inner = self.inertials.get(part), depth + 1
        mass, moments, place = UNKNOWN_MASS, (UNKNOWN_MASS,) * 3, np.eye(4)
        if own is not None:
            from scipy.spatial.transform import Rotation

            moments, quaternion = principal_axes(own.inertia)
            place = placed(Rotation.from_quat(quaternion, scalar_first=True).as_matrix(), own.centre)
            mass = own.mass
        said = _node(inner, "Name", "MassMarker") + _place(inner, place) + _node(inner, "Mass", written(mass))
        said += _node(inner, "MomentOfInertias", "\t".join(map(written, moments))) + _node(inner, "Density", "1")
        return "\t" * depth + "PrincipalMassMarker\n" + said

    def _path(self, part: str, marker: str) -> str:
        return f"/{self.name}/{marker}" if part == GROUND else f"/{self.name}/{part}/{marker}"

    def _motions(self, paths: Sequence[str]) -> str:
        result = ""
        for number, (joint, key) in enumerate(self.motions, start=1):
            kind = MOTION_OF[key]
            result += f"\t\t\t{kind}\n{_node(4, 'Name', f'Motion{number}')}{_node(4, 'MotionJoint', paths[joint])}"
            result += _node(4, EXPRESSION[kind], "0.0")
        return result

    def _limits(self, paths: Sequence[str]) -> str:
        """Write the limits; no heading where there are none, since older versions of the solver know none."""
        result, number = "", 0
        for joint, key, ends in self.limits:
            for bound, kind in zip(ends, ("=>", "=<"), strict=True):
                if np.isfinite(bound):
                    number += 1
                    result += f"\t\t\t{LIMIT_OF[key]}\n{_node(4, 'Name', f'Limit{number}')}"
                    result += _node(4, "MotionJoint", paths[joint]) + _node(4, "Limit", written(bound))
                    result += _node(4, "Type", kind) + _node(4, "Tol", "1e-09")
        return f"\t\tLimits\n{result}" if result else ""


def _node(depth: int, key: str, value: str) -> str:
    tabs = "\t" * depth
    return f"{tabs}{key}\n{tabs}\t{value}\n"


def _row(depth: int, numbers: Iterable[float]) -> str:
    return "\t" * depth + "\t".join(map(written, numbers)) + "\n"


def _place(depth: int, pose: Transform) -> str:
    tabs = "\t" * depth
    rows = "".join(_row(depth + 1, row) for row in pose[:3, :3])
    return f"{tabs}Position3D\n{_row(depth + 1, pose[:3, 3])}{tabs}RotationMatrix\n{rows}"


def _at_rest(depth: int) -> str:
    return "".join(_node(depth, key, "0\t0\t0") for key in ("Velocity3D", "Omega3D"))


def _markers(depth: int, markers: Sequence[tuple[str, Transform]]) -> str:
    """Write the points of reference of a part: one, with all its markers."""
    tabs = "\t" * depth
    said = "".join(
        f"{tabs}\t\t\tMarker\n{_node(depth + 4, 'Name', name)}{_place(depth + 4, pose)}" for name, pose in markers
    )
    point = f"{tabs}\tRefPoint\n{_place(depth + 2, np.eye(4))}{tabs}\t\tMarkers\n{said}"
    return f"{tabs}RefPoints\n{point}{tabs}RefCurves\n{tabs}RefSurfaces\n"
