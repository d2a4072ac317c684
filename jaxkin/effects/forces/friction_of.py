"""Which joints may have friction, and which forces press their faces together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.effects.forces.given import JointFriction
from jaxkin.effects.forces.undetermined import Undetermined
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.linkage import Linkage


class PairFriction(NamedTuple):
    """The friction of a pair with one pair of faces."""

    along: bool
    """Whether forces along its axis, the normal of a plane, press the faces together."""
    across: bool
    """Whether forces across its axis do."""
    radius: str
    """Whether a radius is "needed", has "none" or "may" be given."""
    components: tuple[str, ...]
    """What of its reactions counts, in the axes of its last frame."""


_ALL = ("force x", "force y", "force z")
_ACROSS = ("force x", "force y")

FRICTION_OF: dict[str | None, PairFriction] = {
    JointKind.REVOLUTE: PairFriction(along=True, across=True, radius="needed", components=_ALL),
    JointKind.PRISMATIC: PairFriction(along=False, across=True, radius="none", components=_ACROSS),
    JointKind.CYLINDRICAL: PairFriction(along=False, across=True, radius="needed", components=_ACROSS),
    JointKind.SCREW: PairFriction(along=True, across=True, radius="needed", components=_ALL),
    JointKind.PLANAR: PairFriction(along=True, across=False, radius="may", components=("force z",)),
    JointKind.SPHERICAL: PairFriction(along=True, across=True, radius="needed", components=_ALL),
}
"""Kind of a lower pair -> its friction. In a screw the part of all forces across its thread presses.
Torques about axes that a joint does not turn about press nothing."""


def pair_friction(joint: Joint) -> PairFriction | None:
    """Find the friction of a joint that is one lower pair; None for other joints."""
    return FRICTION_OF.get(MOVEMENTS[joint.movements[0]].subgroup_joint) if len(joint.movements) == 1 else None


def check_friction(linkage: Linkage, given: Sequence[JointFriction], moves: bool) -> None:
    """Raise ValueError for joints that are not there or have no known friction, and for friction at rest."""
    joints = {joint.name: joint for joint in linkage.joints}
    seen = set()
    for each in given:
        name = each.joint
        if name not in joints:
            raise ValueError(f"there is no joint {name!r} to have friction{nearest(str(name), joints)}")
        if name in seen:
            raise ValueError(f"the friction of {name!r} is given twice: give it once")
        seen.add(name)
        if (pair := pair_friction(joints[name])) is None:
            raise ValueError(
                f"friction is known of revolute, prismatic, cylindrical, screw, planar and spherical joints, and "
                f"{name!r} is {joints[name].kind}: write jk.joint_load({name!r}, ...) for a load that you know"
            )
        if pair.radius == "needed" and each.radius is None:
            raise ValueError(
                f"the friction of {name!r}, {joints[name].kind}, needs the radius at which its faces touch: "
                f"jk.joint_friction({name!r}, {_shown(each.coefficient)}, radius=5)"
            )
        if pair.radius == "none" and each.radius is not None:
            raise ValueError(f"{name!r} is {joints[name].kind} and does not turn: leave out the radius of its friction")
    if given and not moves:
        raise ValueError(
            f"friction has no direction at rest, and {given[0].joint!r} has friction: give rates={{'A': 10.0}}, or "
            "very small ones for a mechanism that is about to move"
        )


def _shown(coefficient: object) -> str:
    return "0.1" if traced(coefficient) else f"{float(np.asarray(coefficient)):g}"


def undetermined_friction(linkage: Linkage, names: Sequence[str], found: Sequence[Undetermined]) -> list[Undetermined]:
    """Find the joints among `names` whose friction rests on reactions that are not determined, with these."""
    pairs = {joint.name: pair_friction(joint) for joint in linkage.joints if joint.name in names}
    told = []
    for each in found:
        if (pair := pairs.get(each.joint)) is not None:
            components = [name for name in each.components if name in pair.components]
            if components:
                told.append(Undetermined(each.joint, each.parts, tuple(components)))
    return told
