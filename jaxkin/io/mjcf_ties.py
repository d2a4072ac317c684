"""What ties the bodies of a MuJoCo model beside their joints, <equality>, and what moves them, <actuator>."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import listed, nearest
from jaxkin.geometry.pose import Transform
from jaxkin.io.mjcf_text import Compiler, Defaults
from jaxkin.io.names import unique
from jaxkin.io.robot_couplings import SINGLE
from jaxkin.io.robot_model import WORLD, RobotJoint, numbers, placed, quaternion, tag
from jaxkin.joints.coupling import Coupling, polynomial, relation, shifted_coupling
from jaxkin.joints.kinds import JointKind

KINDS = {"connect": JointKind.SPHERICAL, "weld": JointKind.FIXED}
"""Constraints between two bodies -> kind of the joint that they are."""

ON_JOINTS = ("joint", "jointinparent")
"""Attributes by which an actuator names a joint."""


class Ties:
    """The constraints and actuators of one model; `notes` tell those that are not kept."""

    def __init__(
        self,
        file: str,
        root: Element,
        compiler: Compiler,
        defaults: Defaults,
        poses: Mapping[str, Transform],
        sites: Mapping[str, tuple[str, Transform]],
    ) -> None:
        """Take the elements of a model; `poses` and `sites` are its bodies and sites in the world, metres."""
        self.file, self.root = file, root
        self.compiler, self.defaults, self.poses, self.sites = compiler, defaults, poses, sites
        self.notes: list[str] = []
        self.enabled = not disabled(root, "equality")
        if not self.enabled and root.find("equality/*") is not None:
            self.notes.append(f"{file}: its <flag> disables equality constraints: none is active; left out")
        self.held: dict[str, float] = {}
        """Joints that a constraint holds, and where, counted from the pose that is written; found with `couplings`."""

    def loops(self, taken: Collection[str]) -> list[RobotJoint]:
        """Make the joints of <connect> and <weld>; `taken` are names of joints that there are."""
        result: list[RobotJoint] = []
        names = {*taken}
        for each in self.root.iterfind("equality/*"):
            said, where = self.defaults.said(each, key="equality"), f"{self.file}: {tag(each)}"
            if not self._is_active(said):
                self.notes += [f"{where} is not active; left out"] if self.enabled else []
            elif each.tag == "joint" or (each.tag == "tendon" and self._lengths(said, where)):
                continue  # see `couplings`
            elif each.tag not in KINDS:
                about = [repr(value) for key, value in each.attrib.items() if key.rstrip("12") in ("joint", "tendon")]
                between = f" between {listed(about)}" if about else ""
                self.notes.append(f"{where}{between} is not kept: what it ties moves on its own")
            else:
                made = self._loop(each, said, names, where)
                names.add(made.name)
                result.append(made)
        return result

    def couplings(self, joints: Mapping[str, RobotJoint]) -> tuple[Coupling, ...]:
        """Make the couplings of <joint>: `q_1 - r_1 = sum_k a_k (q_2 - r_2)^k`, with `r` as the bodies are written."""
        result: list[Coupling] = []
        for each in self.root.iterfind("equality/joint"):
            said, where = self.defaults.said(each, key="equality"), f"{self.file}: {tag(each)}"
            if not self._is_active(said):
                continue  # noted with the loops
            names = [said[key] for key in ("joint1", "joint2") if key in said]
            for name in names:
                if name not in joints:
                    raise ValueError(f"{where}: unknown joint {name!r}{nearest(name, joints)}")
            stiff = [name for name in names if joints[name].kind not in SINGLE]
            factors = _polycoef(said, where)
            if len(names) == 1 and not stiff:
                self.held[names[0]] = float(factors[0])
                at = f"{factors[0]:g} from the pose that is written" if factors[0] else "zeros"
                self.notes.append(
                    f"{where} holds {names[0]!r}, which is a freedom of its own here; drive it with {at} to hold it"
                )
                continue
            if len({*names}) < 2 or stiff or not factors[1:].any():
                of = f" of {listed(list(map(repr, names)))}" if names else ""
                self.notes.append(f"{where}{of} is not kept: it ties no two coordinates")
                continue
            powers = int(np.flatnonzero(factors)[-1]) + 1
            made = polynomial(names[0], names[1], factors[: max(powers, 2)], name=f"{names[0]} follows {names[1]}")
            at = np.array([-joints[name].values[0] if joints[name].values else 0.0 for name in names[::-1]])
            result.append(shifted_coupling(made, at))
        result += self._length_couplings(joints)
        names = unique(each.name for each in result)  # two constraints may tie the same joints
        return tuple(replace(each, name=name) for each, name in zip(result, names, strict=True))

    def _is_active(self, said: Mapping[str, str]) -> bool:
        return self.enabled and said.get("active", "true") != "false"

    def _length_couplings(self, joints: Mapping[str, RobotJoint]) -> Iterator[Coupling]:
        """Make the couplings of <tendon>: the lengths of fixed tendons are sums of joints, `y_1 - a_1 y_2 = a_0`."""
        for each in self.root.iterfind("equality/tendon"):
            said, where = self.defaults.said(each, key="equality"), f"{self.file}: {tag(each)}"
            if not self._is_active(said) or not (lengths := self._lengths(said, where)):
                continue
            for name in lengths:
                if name not in joints:
                    raise ValueError(f"{where}: unknown joint {name!r}{nearest(name, joints)}")
            name = said.get("name") or f"tendon {said['tendon1']}"
            made = relation(lengths, _polycoef(said, where)[0], name=name)
            at = np.array([-joints[each].values[0] if joints[each].values else 0.0 for each in lengths])
            yield shifted_coupling(made, at)

    def _lengths(self, said: Mapping[str, str], where: str) -> dict[str, float]:
        """Read the factor of each joint in a constraint of tendons; nothing where it is not linear in two joints or
        more."""
        factors = _polycoef(said, where)
        result: dict[str, float] = defaultdict(float)
        for key, by in (("tendon1", 1.0), ("tendon2", -factors[1])):
            if key in said:
                joints = self.root.findall(f"tendon/fixed[@name='{said[key]}']/joint")
                if not joints or factors[2:].any():
                    return {}
                for each in joints:
                    result[each.get("joint", "")] += by * float(numbers(each.get("coef"), 1, f"{where}: coef", (1,))[0])
        moved = {name: factor for name, factor in result.items() if factor}
        return moved if len(moved) > 1 else {}

    def _loop(self, each: Element, said: dict[str, str], names: Collection[str], where: str) -> RobotJoint:
        """Make the joint of a constraint, closed where the bodies are written unless two sites or a pose say else."""
        kind = KINDS[each.tag]
        if each.tag == "weld" and float(numbers(said.get("torquescale"), 1, f"{where}: torquescale", (1,))[0]) == 0.0:
            kind = JointKind.SPHERICAL  # it holds points together, and no orientations
        if "site1" in said or "site2" in said:
            (one, first), (other, second) = (self._site(said.get(key, ""), where) for key in ("site1", "site2"))
        else:
            one, other = self._body(said.get("body1", ""), where), self._body(said.get("body2", WORLD), where)
            anchor = numbers(said.get("anchor"), 3, where, (0, 0, 0))
            if each.tag == "connect":
                first = second = self.poses[one] @ placed(np.eye(3), anchor)
            else:
                first = second = self.poses[other] @ placed(np.eye(3), anchor)
                relative = numbers(said.get("relpose"), 7, where, (0, 1, 0, 0, 0, 0, 0))
                if relative[3:].any():  # else the bodies hold each other as they are written
                    first = self.poses[one] @ placed(quaternion(relative[3:], where), relative[:3])
        if one == other:
            raise ValueError(f"{where}: it ties the body {one!r} to itself; give body1 and body2, or two sites")
        if kind is JointKind.SPHERICAL:  # its coordinates are zero where the file has the bodies
            first, second = placed(np.eye(3), first[:3, 3]), placed(np.eye(3), second[:3, 3])
        name = said.get("name") or f"{one}-{other}"
        name = unique([*names, name])[-1]
        return RobotJoint(name, (one, other), kind, first, second, f"{each.tag} {name!r}")

    def _body(self, name: str, where: str) -> str:
        if name not in self.poses:
            raise ValueError(f"{where}: unknown body {name!r}{nearest(name, self.poses)}")
        return name

    def _site(self, name: str, where: str) -> tuple[str, Transform]:
        if name not in self.sites:
            raise ValueError(f"{where}: unknown site {name!r}{nearest(name, self.sites)}")
        return self.sites[name]

    def motors(self, joints: Sequence[RobotJoint]) -> tuple[str, ...]:
        """Find the joints that actuators move, those of the fixed tendons that they pull too."""
        kinds = {each.name: each.kind for each in joints}
        tendons = {
            each.get("name", ""): [joint.get("joint", "") for joint in each.iterfind("joint")]
            for each in self.root.iterfind("tendon/fixed")
        }
        found: dict[str, None] = {}
        pulled: set[str] = set()
        for each in self.root.iterfind("actuator/*"):
            where = f"{self.file}: {tag(each)}"
            name = next((each.get(key, "") for key in ON_JOINTS if key in each.attrib), None)
            tendon = each.get("tendon")
            if tendon in tendons:
                moved = [joint for joint in tendons[tendon] if joint in kinds]
                pulled.add(tendon)
                self.notes.append(
                    f"{where} pulls the tendon {tendon!r}, which is not kept: each of the joints "
                    f"{listed(list(map(repr, moved)))} is taken for a motor"
                )
                found |= dict.fromkeys(moved)
            elif name is None:
                on = ", ".join(f"{key}={value!r}" for key, value in each.attrib.items() if key in _OTHERS)
                self.notes.append(f"{where}, an actuator of {on or 'no joint'}, moves no joint by itself; left out")
            elif kinds.get(name) in (JointKind.REVOLUTE, JointKind.PRISMATIC):
                found[name] = None
            elif name in kinds:
                self.notes.append(f"{where} moves the ball {name!r} about one axis; not kept as a motor")
            else:
                self.notes.append(f"{where} is of {name!r}, which is no joint that is read; left out")
        held = {each.get(key) for each in self.root.iterfind("equality/tendon") for key in ("tendon1", "tendon2")}
        for each in self.root.iterfind("tendon/*"):
            if each.get("name", "") not in pulled | held:
                self.notes.append(f"{self.file}: {tag(each)}, a tendon, is not kept")
        return tuple(found)


def _polycoef(said: Mapping[str, str], where: str) -> np.ndarray:
    """Read the five numbers of the polynomial of a constraint; those that are not written are 0 1 0 0 0."""
    text = said.get("polycoef") or "0"
    found = numbers(text, min(len(text.split()), 5), f"{where}: polycoef")
    return np.append(found, [0.0, 1.0, 0.0, 0.0, 0.0][len(found) :])


def disabled(root: Element, what: str) -> bool:
    """Tell whether a <flag> of the options of a model disables constraints of a kind, "equality" or "limit", or all."""
    flags: dict[str, str] = {}
    for each in root.iterfind("option/flag"):
        flags |= each.attrib
    return "disable" in (flags.get(what), flags.get("constraint"))


_OTHERS = ("tendon", "site", "body", "cranksite", "slidersite", "refsite")
"""Attributes by which an actuator names what is no joint."""
