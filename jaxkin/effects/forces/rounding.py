"""How large the terms are that a drive force at rest adds up: what rounding leaves of a force that is none.

A force of some newtons may do no work along a drive, as across the plane of a linkage, or balance another one, as a
spring a weight: what is left is some units of rounding of each, of either sign. Numbers of the host.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.effects.forces.acting import Load, loaded_coordinate
from jaxkin.effects.forces.given import Force, JointLoad, Spring, Torque
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.screws import Scale
from jaxkin.effects.forces.wrenches import metres_of, units_of
from jaxkin.effects.rates import velocities
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import METRES
from jaxkin.mechanism.motion import Motion

PerPose = Float[np.ndarray, " poses"]


class _Going(NamedTuple):
    """How fast a part goes along a drive, each joint before it counted by itself: a part may rest where two joints turn
    against each other, and its twist is their rounding then."""

    turns: PerPose
    """Radians per unit of the drive."""
    slides: PerPose
    """Speed of the point at the middle of the mechanism, its unit per unit of the drive."""
    far: PerPose
    """How far its joints have slid, unit of the mechanism."""


def force_terms(
    motion: Motion, name: str, masses: Masses | None, gravity: Any, loads: Sequence[Load]
) -> Float[np.ndarray, " poses"]:
    """Add up the sizes of all terms of the force of a drive at rest: newton metres of an angle, newtons of a length.

    A term is a force times the speed of its point, a torque times the rate at which its part turns. Parts that the
    drive leaves at rest have none. Speeds are those of all joints that carry a part, added up, and lengths count from
    the middle and from the origin of the world: their rounding is in the force. Zero in poses that are not closed.
    """
    linkage, unit = motion.mechanism.linkage, motion.mechanism.unit
    scale = Scale.of(linkage, np)
    size, middle = float(scale.size), np.asarray(scale.middle, float)
    rates = velocities(motion, {each: float(each == name) for each in motion.inputs})
    going = _going(motion, [np.abs(np.asarray(rows, float)) for rows in rates.displacements], size, middle)
    metre, total = METRES[unit], np.zeros(len(motion))
    if masses is not None:
        weights = np.linalg.norm(np.asarray(gravity, float)) * np.asarray(masses.mass, float)
        arms = np.linalg.norm(np.asarray(masses.centre, float) - middle, axis=1) + size
        for part, weight, arm in zip(masses.parts, weights, arms, strict=True):
            total += metre * weight * (going[part].slides + going[part].turns * arm)
    for load in loads:
        if isinstance(load, JointLoad):
            joint, k = loaded_coordinate(linkage, load)
            own = metres_of(linkage.joints[joint].coordinates[k], unit)
            q = np.abs(np.asarray(motion.displacements[joint], float)[:, k]) + np.abs(np.asarray(load.rest, float))
            held = np.abs(np.asarray(load.load, float)) + np.abs(np.asarray(load.stiffness, float)) * own * q
            total += own * held * np.abs(np.asarray(rates.displacements[joint], float)[:, k])
        else:
            total += _of_load(load, going, size, middle, metre)
    return total / units_of(motion, name)[1]


def weights_of_all(motion: Motion, name: str, masses: Masses | None, gravity: Any) -> float:
    """Add up all weights, newtons; for an angle times their distances from the middle and its size, newton metres."""
    if masses is None:
        return 0.0
    size, middle = Scale.of(motion.mechanism.linkage, np)
    arms = np.linalg.norm(np.asarray(masses.centre) - np.asarray(middle), axis=1) + float(size)
    lever = 1.0 if is_length(name.rpartition(".")[2]) else arms * METRES[motion.mechanism.unit]
    return float(np.linalg.norm(np.asarray(gravity, float)) * np.sum(np.asarray(masses.mass) * lever))


def _going(motion: Motion, rates: Sequence[np.ndarray], size: float, middle: np.ndarray) -> dict[str, _Going]:
    """Add up for each part the sizes of the `rates` of the joints that carry it, along the tree of joints."""
    linkage, none = motion.mechanism.linkage, np.zeros(len(motion))
    found = dict.fromkeys(linkage.parts, _Going(none, none, none))
    for part, parent, number, _ in linkage.structure.tree:
        joint, before = linkage.joints[number], found.get(parent, _Going(none, none, none))
        lengths = np.array([is_length(each) for each in joint.coordinates], bool)
        q = np.abs(np.asarray(motion.displacements[number], float))
        far = before.far + q[:, lengths].sum(axis=1)
        turns = rates[number][:, ~lengths].sum(axis=1)
        arm = np.linalg.norm(np.asarray(joint.frames_1, float)[:, :3, 3] - middle, axis=1).max()
        slides = rates[number][:, lengths].sum(axis=1) + turns * (size + arm + far + abs(float(joint.pitch)))
        found[part] = _Going(before.turns + turns, before.slides + slides, far)
    return found


def _of_load(
    load: Force | Torque | Spring, going: Mapping[str, _Going], size: float, middle: np.ndarray, metre: float
) -> PerPose:
    """Add up the terms of a load on parts: joules per unit of the drive."""
    if isinstance(load, Torque):
        return np.linalg.norm(np.asarray(load.vector, float)) * going[load.part].turns
    parts, points = ((load.part,), [load.point]) if isinstance(load, Force) else (load.parts, load.points)
    lengths = [np.linalg.norm(np.asarray(point, float)) for point in points]
    # from the middle, and from the origin of the world, by which places are rounded
    reach = [
        size + np.linalg.norm(middle) + 2 * own + going[part].far for part, own in zip(parts, lengths, strict=True)
    ]
    if isinstance(load, Force):
        force = np.linalg.norm(np.asarray(load.vector, float))
    else:
        force = (
            metre * np.abs(np.asarray(load.stiffness, float)) * (sum(reach) + np.abs(np.asarray(load.length, float)))
        )
    speeds = [going[part].slides + going[part].turns * own for part, own in zip(parts, reach, strict=True)]
    return metre * force * np.sum(speeds, axis=0)
