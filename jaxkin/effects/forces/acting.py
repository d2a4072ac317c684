"""What a user lets act on a mechanism, as drive forces and reactions are given it: checked, and in numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import check_motion, check_one, numbers, several
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.effects.forces.friction_of import check_friction
from jaxkin.effects.forces.given import (
    Applied,
    Force,
    JointFriction,
    JointLoad,
    Spring,
    Torque,
    batch_of,
    rows_per_pose,
)
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.rates import tangents_of
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import Inputs
from jaxkin.mechanism.motion import Motion

STANDARD_GRAVITY = (0.0, 0.0, -9.81)

Load = Force | Torque | Spring | JointLoad


class Acting(NamedTuple):
    """What a user asks for: the arguments that drive forces and reactions share."""

    masses: Masses | None = None
    gravity: Any = STANDARD_GRAVITY
    applied: tuple[Applied, ...] = ()
    """As `all_applied` returns them."""
    rates: Mapping[str, Any] | None = None
    accelerations: Mapping[str, Any] | None = None


class ActingNumbers(NamedTuple):
    """The numbers of an `Acting` that a program is given: no rates, and no friction, which depends on all else."""

    masses: Masses | None
    gravity: Float[Array | np.ndarray, "3"]
    applied: tuple[Load, ...]


def all_applied(given: Iterable[Applied] | Applied) -> tuple[Applied, ...]:
    """List what is applied, once: an iterator has nothing left for whoever asks again; ValueError for all else."""
    applied = (given,) if isinstance(given, Applied) else several(given, "applied", "loads", "[jk.force(...)]")
    for each in applied:
        if not isinstance(each, Applied):
            raise ValueError(f"applied loads are made by jk.force, jk.torque, jk.spring, ..., got {each!r}")
    return applied


def loads_and_frictions(applied: Sequence[Applied]) -> tuple[tuple[Load, ...], tuple[JointFriction, ...]]:
    """Split what is applied into loads and friction of joints, which depends on the loads."""
    loads = tuple(each for each in applied if not isinstance(each, JointFriction))
    return loads, tuple(each for each in applied if isinstance(each, JointFriction))


def check(motion: Motion, acting: Acting) -> None:
    """Raise ValueError for arguments that do not fit the motion, with what to write instead."""
    check_motion(motion, "forces")
    mechanism, masses, (applied, frictions) = motion.mechanism, acting.masses, loads_and_frictions(acting.applied)
    for each in applied:
        parts = each.parts if isinstance(each, Spring) else () if isinstance(each, JointLoad) else (each.part,)
        for part in parts:
            if part not in mechanism.parts:
                raise ValueError(f"there is no part {part!r} to act on{nearest(str(part), mechanism.parts)}")
    if masses is not None and not isinstance(masses, Masses):
        raise ValueError(f"masses are made by jk.masses(mechanism, density), got {type(masses).__name__}")
    if masses is not None and (masses.parts != mechanism.parts or masses.unit != mechanism.unit):
        raise ValueError(
            "the masses are those of another mechanism: its parts or its unit differ; write "
            "jk.masses(motion.mechanism, ...)"
        )
    if masses is not None:
        check_one("forces", "the masses of one mechanism", masses.batch)
    for each in acting.applied:
        check_one("forces", _name_of(each), batch_of(each))
    if masses is None and not applied:
        raise ValueError("nothing acts: give jk.masses(mechanism, density), or applied=[jk.force(...)], or both")
    poses = len(motion)
    for each in applied:
        for name in rows_per_pose(each):
            count = len(getattr(each, name))
            if count != poses:
                raise ValueError(
                    f"{_name_of(each)} must be given once or for each of the {poses} poses, got {count} rows"
                )
        if isinstance(each, JointLoad):
            loaded_coordinate(mechanism.linkage, each)
    check_friction(mechanism.linkage, frictions, acting.rates is not None)
    if acting.rates is None and acting.accelerations is not None:
        raise ValueError("accelerations were given without rates: write rates={'A': 0.0} for a start from rest")


def acting_numbers(acting: Acting) -> ActingNumbers:
    """Make arrays of what acts; ValueError for a gravity that is no vector."""
    expected = "three finite numbers, m/s^2, as (0, 0, -9.81)"
    gravity = numbers(acting.gravity, "gravity", expected)
    if gravity.shape != (3,) or not (traced(gravity) or np.isfinite(gravity).all()):
        raise ValueError(f"gravity must be {expected}, got {acting.gravity!r}")
    return ActingNumbers(acting.masses, gravity, loads_and_frictions(acting.applied)[0])


def given_rates(motion: Motion, acting: Acting) -> tuple[Inputs, Inputs] | None:
    """Complete first and second derivatives of all inputs; None at rest; ValueError as `jk.accelerations`."""
    if acting.rates is None:
        return None
    return tangents_of(motion, acting.rates), tangents_of(motion, acting.accelerations or {})


def _name_of(load: Applied) -> str:
    """Name a load in a message."""
    if isinstance(load, JointFriction):
        return f"the friction of {load.joint!r}"
    if isinstance(load, Spring):
        return f"the spring of {load.parts[0]!r} and {load.parts[1]!r}"
    return f"the load in {load.coordinate!r}" if isinstance(load, JointLoad) else f"the load on {load.part!r}"


def loaded_coordinate(linkage: Linkage, load: JointLoad) -> JointCoordinate:
    """Resolve the (joint, coordinate) of a load; ValueError where it is an angle of a ball."""
    joint, index = coordinate(linkage, load.coordinate)
    if any(index in group and len(group) > 1 for group in linkage.joints[joint].driven_together):
        raise ValueError(
            f"{load.coordinate!r} is an angle of a ball, which has no axis of its own: write jk.torque or jk.spring"
        )
    return joint, index
