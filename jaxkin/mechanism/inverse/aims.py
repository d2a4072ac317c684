"""What an inverse problem asks for: places and orientations of parts, and displacements of joints, at each pose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from jaxkin._arguments import exact_numbers
from jaxkin._names import nearest
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.mechanism.target_values import check_rigid, rounding, target_values
from jaxkin.mechanism.targets import Target, middle_of_joints

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

Weight = float | int | Sequence[float | int]


@dataclass(frozen=True, eq=False)
class PartAim:
    """The place of a point of a part, or the orientation of the part, or both."""

    part: str
    at: Float[np.ndarray, "3"]
    """The point, in the assembled pose."""
    places: Float[np.ndarray, "poses 3"] | None
    turns: Float[np.ndarray, "poses 3 3"] | None
    weights: tuple[float, float]
    """Of place and orientation."""


@dataclass(frozen=True, eq=False)
class JointAim:
    """The displacement of one coordinate."""

    place: JointCoordinate
    """Number of the joint, and of its coordinate."""
    values: Float[np.ndarray, " poses"]
    weight: float


Aim = PartAim | JointAim


def aims_of(mechanism: Mechanism, targets: Mapping[Any, Any], weights: Mapping[Any, Weight]) -> tuple[Aim, ...]:
    """Check targets and weights, and read them; ValueError for what is not there or has another shape."""
    for key in weights:
        if key not in targets:
            raise ValueError(f"weights: {key!r} is no target; there are {', '.join(map(repr, targets))}")
    aims = tuple(_aim(mechanism, key, values, weights.get(key, 1.0)) for key, values in targets.items())
    if len({poses_of(aim) for aim in aims}) != 1:
        raise ValueError("targets must have the same number of poses, and there must be at least one target")
    return aims


def poses_of(aim: Aim) -> int:
    """Count the poses of an aim."""
    if isinstance(aim, JointAim):
        return len(aim.values)
    return next(len(each) for each in (aim.places, aim.turns) if each is not None)


def _aim(mechanism: Mechanism, key: str | Target, values: Any, weight: Weight) -> Aim:
    """Read the values of one target, a row a pose: of a coordinate named by `key`, or of a part.

    Raises ValueError for names that are not there, parts that are fixed, arrays of another shape, NaN and infinity,
    matrices that are no rotations, and weights that are negative or no numbers.
    """
    both = _weights(key, weight)
    if not isinstance(key, Target):
        given = exact_numbers(values, f"target {key!r}: the displacements", "real numbers")
        if given.ndim != 1:
            raise ValueError(f"target {key!r}: expected one displacement a pose, got shape {np.shape(values)}")
        return JointAim(coordinate(mechanism.linkage, key), _finite(key, given), both[0])
    if key.part not in mechanism.parts or key.part in mechanism.fixed:
        moving = [part for part in mechanism.parts if part not in mechanism.fixed]
        raise ValueError(f"{key.joint}: there is no part {key.part!r} that moves{nearest(key.part, moving)}")
    given = _finite(key, target_values(key, values))
    if key.kind == "point":
        return PartAim(key.part, np.array(key.at), given, None, both)
    turns = given[:, :3, :3]
    check_rigid(key, given, rounding(values))
    at = np.asarray(middle_of_joints(mechanism.linkage, key.part))
    places = turns @ at + given[:, :3, 3] if key.kind == "pose" else None
    return PartAim(key.part, at, places, turns, both)


def _finite(key: str | Target, given: np.ndarray) -> np.ndarray:
    """Return the values of a target; ValueError where one of them is NaN or infinite."""
    if not np.isfinite(given).all():
        raise ValueError(f"the target {_named(key)} has NaN or infinity; leave those poses out")
    return given


def _weights(key: object, weight: Weight) -> tuple[float, float]:
    """Return the weights (place, orientation) of a target, equal where one number is given.

    Raises ValueError for what is negative, infinite or no number, and for two numbers where one of them says nothing.
    """
    has_both = isinstance(key, Target) and key.kind == "pose"
    try:
        both = tuple(float(each) for each in np.broadcast_to(np.asarray(weight, float), 2 if has_both else ()).flat)
    except (TypeError, ValueError):
        both = (np.nan,)
    if not all(0 <= each < np.inf for each in both):
        choices = "zero or more, or (place, orientation)" if has_both else "one number, zero or more"
        raise ValueError(f"the weight of {_named(key)} must be {choices}, got {weight!r}")
    return both[0], both[-1]


def _named(key: object) -> str:
    """Name a target as messages do: one of a part as that of a sweep."""
    return key.joint if isinstance(key, Target) else repr(key)
