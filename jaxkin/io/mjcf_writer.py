"""MJCF, the models of MuJoCo, written from a mechanism: a tree of bodies, loops closed by <equality>, inline meshes.

The frame of each body is that of the world in the assembled pose, so `xpos` and `xmat` of MuJoCo are the transforms of
a `Motion`. A loop is closed where the tree leaves a joint out: by <connect> for a ball, else by a body without a solid
that has the coordinates of the joint, and a <weld> of it to the second part.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from jaxkin._arguments import check_mechanism
from jaxkin._files import whole
from jaxkin._names import listed
from jaxkin.geometry.units import METRES
from jaxkin.io.mjcf_masses import LEAST_INERTIA, LEAST_MASS
from jaxkin.io.names import unique
from jaxkin.io.numbers import written
from jaxkin.io.robot_model import UNLIMITED, WORLD
from jaxkin.io.single_motions import BALL, SLIDE, coordinate_names, coordinate_scale, single_motions
from jaxkin.io.writable import check_robot
from jaxkin.io.written_masses import principal_axes, written_inertials
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

LARGEST_POWER = 4
"""Of the polynomials by which MuJoCo couples two joints."""


def write_mjcf(mechanism: Mechanism, path: str | os.PathLike[str], *, masses: Masses | None = None) -> Path:
    """Write a mechanism as a model of MuJoCo (.xml), in metres, and return its path.

    The file holds bodies, joints with their ranges, loops, couplings, motors as actuators, and the solids as meshes; it
    appears whole or not at all. A locked joint, whose limits are equal, is held by an equality. MuJoCo pulls loops
    together by springs, so the poses that it settles at agree with a sweep to their softness. A coordinate of a joint
    that has several is a joint of its own there, "joint_phi".

    Bodies weigh what the file says that the mechanism was read from, or what `masses`, found by `jk.masses`, say. Of
    others MuJoCo computes the masses from their meshes, as shells.

    Raises ValueError for traced numbers, for a mechanism whose lengths were changed, whose parts are not in a closed
    pose, for a joint along a curve or over a surface, for a coupling that MuJoCo cannot say (a polynomial in several
    coordinates, or of a power above four), and for `masses` of another mechanism.
    """
    check_mechanism(mechanism, "written files")
    target = Path(path)
    if target.suffix.lower() != ".xml":
        raise ValueError(f"a model of MuJoCo is an .xml file, got {str(target)!r}")
    root = _Writer(mechanism, target.stem, written_inertials(mechanism, masses)).root
    ElementTree.indent(root)
    with whole(target) as draft:
        ElementTree.ElementTree(root).write(draft, encoding="utf-8", xml_declaration=False)
    return target


class _Writer:
    """The elements of one model."""

    def __init__(self, mechanism: Mechanism, model: str, inertials: Mapping[str, Inertial]) -> None:
        check_robot(mechanism, "model")
        self.mechanism = mechanism
        self.metres = METRES[mechanism.unit]
        self.root = Element("mujoco", model=model)
        SubElement(self.root, "compiler", angle="radian", autolimits="true", balanceinertia="true",
                   boundmass=written(LEAST_MASS), boundinertia=written(LEAST_INERTIA))  # fmt: skip
        self.assets = SubElement(self.root, "asset")
        world = SubElement(self.root, "worldbody")
        self.equality = Element("equality")
        self.tendons = Element("tendon")
        ground = [WORLD] if WORLD in mechanism.linkage.fixed else []
        others = [part for part in mechanism.parts if part not in ground]
        names = unique([WORLD, *others])
        self.body_names = dict(zip(others, names[1:], strict=True)) | dict.fromkeys(ground, WORLD)
        self.bodies = {WORLD: world}
        self.joint_names = coordinate_names(mechanism.all_joints)
        self._write_bodies()
        for part, inertial in inertials.items():
            self._inertial(part, inertial)
        self._write_couplings()
        for element in (self.equality, self.tendons, self._actuators()):
            if len(element):
                self.root.append(element)
        if not len(self.assets):
            self.root.remove(self.assets)

    def _write_bodies(self) -> None:
        """Write the bodies in the order of the tree from the fixed parts, and close the loops."""
        mechanism = self.mechanism
        for part in mechanism.linkage.fixed:
            if self.body_names[part] != WORLD:
                self._body(self.body_names[part], WORLD)
        of_tree = set()
        costs = [joint.freedoms for joint in mechanism.all_joints]
        for part, parent, number, sign in shallow_tree(mechanism.structure.joint_parts, mechanism.fixed, costs):
            of_tree.add(number)
            self._chain(self._body(self.body_names[part], self.body_names[parent]), number, sign)
        for number, joint in enumerate(mechanism.all_joints):
            if number not in of_tree:
                self._close(number, joint)
        for solid in mechanism.solids:
            self._solid(solid)

    def _body(self, name: str, parent: str) -> Element:
        self.bodies[name] = SubElement(self.bodies[parent], "body", name=name)
        return self.bodies[name]

    def _chain(self, body: Element, number: int, sign: int) -> None:
        """Write the elementary motions of a joint into the body on its second part; backwards where `sign` is -1."""
        joint = self.mechanism.all_joints[number]
        for each in single_motions(joint, self.joint_names[number], self.metres, sign):
            attributes = {"name": each.name, "type": each.kind}
            if each.kind != SLIDE:
                attributes["pos"] = written(*each.point)
            if each.kind != BALL:
                attributes["axis"] = written(*each.axis)
            low, high = each.limits
            if low == high:  # which MuJoCo takes for no range
                held = [low, *[0.0] * LARGEST_POWER]
                name, numbers = f"{each.name} locked", written(*held)
                SubElement(self.equality, "joint", name=name, joint1=each.name, polycoef=numbers)
            elif np.isfinite(each.limits).any():
                attributes["range"] = written(*np.clip(each.limits, -UNLIMITED, UNLIMITED))
            SubElement(body, "joint", attributes)
            if each.follows is not None:
                leader, factor = each.follows
                self._polynomial(f"{joint.name} {each.name}", each.name, leader, [factor])

    def _close(self, number: int, joint: Joint) -> None:
        """Close a loop at a joint that the tree leaves out."""
        one, other = (self.body_names[part] for part in joint.parts)
        if joint.kind is JointKind.SPHERICAL:
            anchor = written(*np.asarray(joint.frames_1, float)[0, :3, 3] * self.metres)
            SubElement(self.equality, "connect", name=joint.name, body1=one, body2=other, anchor=anchor)
            return
        if joint.freedoms:
            end = unique([*self.bodies, f"{joint.name} end"])[-1]
            self._chain(self._body(end, one), number, 1)
            one = end
        # with its pose, since MuJoCo takes the pose of the bodies where this is left out, but other readers zeros
        SubElement(self.equality, "weld", name=f"{joint.name} closed" if joint.freedoms else joint.name, body1=one,
                   body2=other, relpose=written(0, 0, 0, 1, 0, 0, 0))  # fmt: skip

    def _inertial(self, part: str, given: Inertial) -> None:
        """Write what a part weighs into its body, whose axes are those of the world."""
        if self.body_names[part] == WORLD:
            return  # which has no mass in MuJoCo
        moments, turn = principal_axes(given.inertia)
        inertial = Element("inertial", pos=written(*given.centre), quat=written(*turn), mass=written(given.mass),
                           diaginertia=written(*moments))  # fmt: skip
        self.bodies[self.body_names[part]].insert(0, inertial)

    def _solid(self, solid: Part) -> None:
        """Write the triangles of a part as a mesh in the frame of its body."""
        if not len(solid.triangles) or not solid.is_solid:
            return
        corners = np.asarray(solid.triangles, float).reshape(-1, 3) * self.metres
        points, faces = np.unique(corners, axis=0, return_inverse=True)
        faces = faces.reshape(-1, 3)
        faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
        # as a shell, since MuJoCo refuses solids whose surface is not closed, and measures the inertia of each
        SubElement(self.assets, "mesh", name=solid.name, inertia="shell", vertex=written(*points.ravel()),
                   face=" ".join(map(str, faces.ravel())))  # fmt: skip
        # joined parts touch each other by design: collisions of their meshes would push them apart
        SubElement(self.bodies[self.body_names[solid.name]], "geom", type="mesh", mesh=solid.name, contype="0",
                   conaffinity="0")  # fmt: skip

    def _polynomial(self, name: str, follower: str, leader: str, factors: Sequence[float], constant: float = 0) -> None:
        """Couple two joints: follower = constant + factors[0] leader + factors[1] leader^2 + ..."""
        coefficients = [constant, *factors, *[0.0] * LARGEST_POWER][: LARGEST_POWER + 1]
        SubElement(self.equality, "joint", name=name, joint1=follower, joint2=leader, polycoef=written(*coefficients))

    def _write_couplings(self) -> None:
        for coupling in self.mechanism.linkage.couplings:
            places = [coordinate(self.mechanism.linkage, name) for name in coupling.coordinates]
            names = [self.joint_names[joint][column] for joint, column in places]
            scales = [
                coordinate_scale(self.mechanism.all_joints[joint], column, self.metres) for joint, column in places
            ]
            self._coupling(coupling, names, np.array(scales))

    def _coupling(self, coupling: Coupling, names: Sequence[str], scales: np.ndarray) -> None:
        """Write a coupling: two joints by a polynomial, more by the length of a tendon that does not change."""
        powers = np.arange(1, np.asarray(coupling.coefficients).shape[-1] + 1)
        factors = np.asarray(coupling.coefficients, float) / scales[:, None] ** powers
        offset = float(coupling.offset)
        linear = [row for row in range(len(names)) if not factors[row, 1:].any() and factors[row, 0]]
        if len(names) == 2 and linear and len(powers) <= LARGEST_POWER:
            follower = linear[-1]
            leader, by = 1 - follower, factors[linear[-1], 0]
            self._polynomial(coupling.name, names[follower], names[leader], -factors[leader] / by, offset / by)
        elif len(linear) == len(names):
            tendon = SubElement(self.tendons, "fixed", name=coupling.name)
            for name, factor in zip(names, factors[:, 0], strict=True):
                SubElement(tendon, "joint", joint=name, coef=written(factor))
            SubElement(self.equality, "tendon", name=coupling.name, tendon1=coupling.name, polycoef=written(offset, 0))
        else:
            raise ValueError(
                f"MuJoCo cannot say the coupling {coupling.name!r}, {coupling}: it couples two joints by a polynomial "
                f"of at most power {LARGEST_POWER} in one of them, or several joints linearly; write the mechanism "
                f"without it, and what it ties, {listed(list(map(repr, coupling.coordinates)))}, moves on its own"
            )

    def _actuators(self) -> Element:
        actuators = Element("actuator")
        for motor in self.mechanism.motors:
            joint, column = coordinate(self.mechanism.linkage, motor)
            SubElement(actuators, "motor", name=motor, joint=self.joint_names[joint][column])
        return actuators
