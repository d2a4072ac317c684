"""Gears, racks and screws between two markers, as couplings of the joints that carry the two parts.

FreeCAD's solver demands of the markers I and J, with angles about their z axes and `c` their value in the file,

    gear    radius_I phi_I + radius_J phi_J = c    angles from the line between the two origins; a belt has radius_J < 0
    rack    x + radius theta = c                   x and theta: the pinion J relative to the rack I, along x and about z
    screw   2 pi z - pitch theta = c               J relative to I, along and about z
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np

from jaxkin.io.marker_joints import Marker, MarkerJoints
from jaxkin.io.robot_model import RobotJoint
from jaxkin.joints.coupling import relation
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.components import connected

GEAR, RACK, SCREW = "GearJoint", "RackPinionJoint", "ScrewJoint"
TIES = (GEAR, RACK, SCREW)
"""Joints that relate the coordinates of other joints, and join nothing."""

PARALLEL_MARKERS = 1e-6
"""Sine of the angle between two axes of markers up to which they are parallel, and cosine up to which they are
perpendicular: numbers of six digits."""

COAXIAL = 1e-5
"""Distance of the origin of a wheel's marker from the axis of its bearing, over that of the two markers."""


class _Carried(NamedTuple):
    """A coordinate of a joint that moves a part on another one, its carrier."""

    joint: RobotJoint
    column: int
    name: str
    """Of the coordinate."""
    sign: float
    """1 where the coordinate counts as the part moves on its carrier, along or about the direction asked for."""
    carrier: frozenset[str]


@dataclass(frozen=True)
class RigidGroups:
    """The parts of a file that do not move against each other."""

    of: Mapping[str, frozenset[str]]
    """Part -> all parts of its body."""

    @staticmethod
    def among(made: MarkerJoints, fixed: Collection[str]) -> RigidGroups:
        """Find what fixed joints hold together, and what is at rest."""
        rigid = [each.parts for each in made.joints.values() if each.kind is JointKind.FIXED]
        held = [(first, other) for first, other in product(tuple(fixed)[:1], tuple(fixed)[1:])]
        groups = connected(list(made.links), [*rigid, *held])
        return RigidGroups({part: frozenset(group) for group in groups for part in group})

    def carried(
        self, made: MarkerJoints, link: str, kinds: Collection[JointKind], name: str, axis: np.ndarray
    ) -> Iterator[_Carried]:
        """Yield the coordinates `name` of the joints of a part that are along, or about, a direction."""
        body = self.of[link]
        for joint in made.joints.values():
            own = joint.frame_1[:3, 2]
            ends = [self.of[part] for part in joint.parts]
            parallel = np.linalg.norm(np.cross(own, axis)) <= PARALLEL_MARKERS
            if joint.kind not in kinds or not parallel or ends[0] == ends[1] or body not in ends:
                continue
            column = 1 if joint.kind is JointKind.CYLINDRICAL and name == "phi" else 0
            sign = float(np.sign(own @ axis)) * (1.0 if ends[1] == body else -1.0)
            full = f"{joint.name}.{name}" if joint.kind is JointKind.CYLINDRICAL else joint.name
            yield _Carried(joint, column, full, sign, ends[0] if ends[1] == body else ends[1])


TURNS = (JointKind.REVOLUTE, JointKind.CYLINDRICAL, JointKind.SCREW)
SLIDES = (JointKind.PRISMATIC,)


class MarkerTie(NamedTuple):
    """A gear, a rack or a screw between two markers, as a file gives it."""

    kind: str
    """One of `TIES`."""
    name: str
    one: Marker
    other: Marker
    sizes: Mapping[str, float]
    """`radius_i` and `radius_j` of gears, the `radius` of a pinion, the `pitch` of a screw."""
    text: str
    """What messages call it."""


def add_tie(made: MarkerJoints, bodies: RigidGroups, tie: MarkerTie) -> None:
    """Add the coupling of a gear, a rack or a screw.

    All joints of the file are there. Where no two joints carry the parts as the relation needs, a note says so.
    """
    if not all(tie.sizes.values()):
        zero = next(key for key, size in tie.sizes.items() if not size)
        made.notes.append(f"{made.file}: {tie.text} is not kept: its {zero} is zero")
        return
    if tie.kind == SCREW and _screw(made, bodies, tie):
        return
    factors = {GEAR: _gear, RACK: _rack, SCREW: _nut}[tie.kind](made, bodies, tie)
    if factors is None:
        made.notes.append(
            f"{made.file}: {tie.text} is not kept, and what it ties moves on its own: {_NEEDED[tie.kind]}"
        )
        return
    ties = {each.name: factor for each, factor in factors}
    offset = sum(factor * (each.joint.values or (0.0, 0.0))[each.column] for each, factor in factors)
    made.couplings.append(relation(ties, offset, name=tie.name))


_NEEDED = {
    GEAR: "there are no two joints that turn its parts about the axes of their markers on one other part",
    RACK: "there is no joint that slides the rack along it, and one that turns the pinion, on one other part",
    SCREW: "there is no cylindrical joint between its parts, nor a slide of the one and a turn of the other on one "
    "part",
}

Factors = tuple[tuple[_Carried, float], tuple[_Carried, float]] | None


def _about(
    made: MarkerJoints, bodies: RigidGroups, marker: Marker, axis: np.ndarray, near: float
) -> Iterator[_Carried]:
    """Yield the joints that turn the part of a marker about a line through it."""
    for each in bodies.carried(made, marker.link, TURNS, "phi", axis):
        away = marker.pose[:3, 3] - each.joint.frame_1[:3, 3]
        if np.linalg.norm(np.cross(away, axis)) <= near:
            yield each


def _gear(made: MarkerJoints, bodies: RigidGroups, tie: MarkerTie) -> Factors:
    one, other = tie.one, tie.other
    near = COAXIAL * float(np.linalg.norm(one.pose[:3, 3] - other.pose[:3, 3]))
    first, second = (tuple(_about(made, bodies, each, each.pose[:3, 2], near)) for each in (one, other))
    for a, b in product(first, second):
        if a.carrier == b.carrier and a.joint is not b.joint:
            return (a, tie.sizes["radius_i"] * a.sign), (b, tie.sizes["radius_j"] * b.sign)
    return None


def _rack(made: MarkerJoints, bodies: RigidGroups, tie: MarkerTie) -> Factors:
    one, other = tie.one, tie.other
    near = COAXIAL * float(np.linalg.norm(one.pose[:3, 3] - other.pose[:3, 3]))
    slides = tuple(bodies.carried(made, one.link, SLIDES, "z", one.pose[:3, 0]))
    for a, b in product(slides, tuple(_about(made, bodies, other, one.pose[:3, 2], near))):
        if a.carrier == b.carrier:
            return (a, -a.sign), (b, tie.sizes["radius"] * b.sign)
    return None


def _nut(made: MarkerJoints, bodies: RigidGroups, tie: MarkerTie) -> Factors:
    """Relate a slide of the one part and a turn of the other: the relation is the same for both ways round."""
    one, other, z = tie.one, tie.other, tie.one.pose[:3, 2]
    for sliding, turning in ((one, other), (other, one)):
        slides = tuple(bodies.carried(made, sliding.link, SLIDES, "z", z))
        for a, b in product(slides, tuple(bodies.carried(made, turning.link, TURNS[:1], "phi", z))):
            if a.carrier == b.carrier:
                return (a, -2.0 * np.pi * a.sign), (b, -tie.sizes["pitch"] * b.sign)
    return None


def _screw(made: MarkerJoints, bodies: RigidGroups, tie: MarkerTie) -> bool:
    """Make a screw of the cylindrical joint between the same two bodies; False where there is none."""
    ends = {bodies.of[tie.one.link], bodies.of[tie.other.link]}
    for each in made.joints.values():
        if each.kind is JointKind.CYLINDRICAL and {bodies.of[part] for part in each.parts} == ends:
            limits = each.limits[1:] if each.limits else ()
            made.joints[each.name] = replace(
                each, kind=JointKind.SCREW, pitch=tie.sizes["pitch"], values=each.values[1:], limits=limits
            )
            return True
    return False
