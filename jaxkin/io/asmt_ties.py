"""Couplings as FreeCAD's solver has them: gears, racks and screws between two markers.

The equations are those of `jaxkin.io.marker_ties`, the other way round.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from itertools import product
from typing import NamedTuple

import numpy as np

from jaxkin.geometry.pose import Transform
from jaxkin.io.marker_ties import GEAR, PARALLEL_MARKERS, RACK, SCREW
from jaxkin.io.robot_model import placed
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind

CARRYING = (JointKind.REVOLUTE, JointKind.CYLINDRICAL, JointKind.PRISMATIC)
"""Joints whose coordinates the format can tie."""

APART = 1e-9
"""Distance between the axes of two wheels, over that of their joints from each other and the origin, from which on the
line between their centres has a direction."""


class Tie(NamedTuple):
    """What the file says of a coupling."""

    kind: str
    sides: tuple[tuple[str, Transform], tuple[str, Transform]]
    """Of each marker its part, and its pose."""
    sizes: tuple[tuple[str, float], ...]


class _Moved(NamedTuple):
    """A coordinate of a joint: the part that it moves, on which carrier, and in which sense."""

    part: str
    carrier: str
    sign: float
    frame: Transform
    factor: float
    turns: bool


def tie(coupling: Coupling, joints: Mapping[str, Joint], fixed: Collection[str]) -> Tie | None:
    """Find the gear, rack or screw that a coupling is; None where the format has none such.

    It is a linear relation of two coordinates, of joints on one other part: two turns about parallel axes, or a turn
    and a slide across its axis or along it.
    """
    factors = np.asarray(coupling.coefficients, float)
    if len(factors) != 2 or factors[:, 1:].any() or float(coupling.offset):
        return None
    sides = [
        _moved(name, factor, joints, fixed) for name, factor in zip(coupling.coordinates, factors[:, 0], strict=True)
    ]
    for one, other in product(*sides):
        if one.carrier != other.carrier or one.part == other.part or not (one.turns or other.turns):
            continue
        if one.turns and other.turns:
            found = _gear(one, other)
        else:
            found = _across_or_along(*((other, one) if one.turns else (one, other)))
        if found is not None:
            return found
    return None


def _moved(name: str, factor: float, joints: Mapping[str, Joint], fixed: Collection[str]) -> list[_Moved]:
    """List both ways round in which a joint moves one of its parts on the other."""
    joint_name, _, coordinate = name.rpartition(".")
    joint = joints[joint_name]
    turns = coordinate == "phi"
    if joint.kind not in CARRYING or (joint.kind is JointKind.CYLINDRICAL and not turns):
        return []
    frame = np.asarray(joint.frames_1, float)[0]
    one, other = joint.parts
    ground = next(iter(fixed), "")
    ends = ((other, one, 1.0), (one, other, -1.0))
    return [
        _Moved(part, ground if carrier in fixed else carrier, sign, frame, factor, turns)
        for part, carrier, sign in ends
        if part not in fixed
    ]


def _gear(one: _Moved, other: _Moved) -> Tie | None:
    axis, away = one.frame[:3, 2], other.frame[:3, 3] - one.frame[:3, 3]
    size = np.linalg.norm(away) + np.linalg.norm(one.frame[:3, 3])
    distance = float(np.linalg.norm(np.cross(axis, away)))
    if np.linalg.norm(np.cross(axis, other.frame[:3, 2])) > PARALLEL_MARKERS or distance <= APART * size:
        return None
    radii = np.array([one.factor * one.sign, other.factor * other.sign])
    radii = radii if radii[0] > 0 else -radii
    if (radii > 0).all():
        radii *= distance / radii.sum()  # pitch circles that touch
    sides = (one.part, one.frame), (other.part, other.frame)
    return Tie(GEAR, sides, (("radiusI", float(radii[0])), ("radiusJ", float(radii[1]))))


def _across_or_along(slide: _Moved, turn: _Moved) -> Tie | None:
    """Make a rack of a slide across the axis of a turn, and a screw of a slide along it."""
    x, z = slide.frame[:3, 2], turn.frame[:3, 2]
    ratio = -turn.factor / slide.factor * slide.sign * turn.sign
    if np.linalg.norm(np.cross(x, z)) <= PARALLEL_MARKERS:
        pitch = -2.0 * np.pi * ratio * float(np.sign(x @ z))
        return Tie(SCREW, ((slide.part, slide.frame), (turn.part, turn.frame)), (("pitch", pitch),))
    if abs(float(x @ z)) > PARALLEL_MARKERS:
        return None
    x = x * np.sign(ratio)
    y = np.cross(z, x)
    radius = abs(ratio)
    rack = placed(np.stack([x, y, z], axis=1), turn.frame[:3, 3] - radius * y)
    return Tie(RACK, ((slide.part, rack), (turn.part, turn.frame)), (("pitchRadius", radius),))
