"""Joints of the exports of CAD systems, by the names of their kinds: movements and frames."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from jaxkin.geometry.pose import Transform
from jaxkin.joints import pairs
from jaxkin.joints.combine import LOWER_PAIRS, Chain
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.mates import MateFeature, mate

_PAIRS = {str(pair[0]): pair for pair in LOWER_PAIRS.values()}
_OTHER_NAMES = {
    "weld": "fixed", "fastened": "fixed", "rigid": "fixed", "gimbal": "spherical", "ball": "spherical",
    "hinge": "revolute", "pin": "revolute", "slider": "prismatic", "cylinder": "cylindrical",
}  # fmt: skip
"""What systems call the lower pairs. A gimbal has the rotations of a ball, as angles about successive axes."""
NEARLY_PERPENDICULAR = 1e-4
"""Cosine between the two axes of a universal joint, up to which what they are not perpendicular by is rounding."""


class ExportedKind(NamedTuple):
    """What a kind of joint leaves free between two frames."""

    kind: JointKind
    chain: Chain
    swapped: bool = False
    """Whether the chain begins at the follower."""


def joint_of_kind(kind: str, base: Transform, follower: Transform) -> ExportedKind | None:
    """Return the kind and the displacements of a joint between two frames; None for kinds that are not known.

    The axis of most kinds is the z axis of the frames. A universal joint turns about the x axis of the base and the y
    axis of the follower; the slot of a pin is along the x axis of the base. Of a bearing joint the centre of the
    follower slides along the axis of the base and turns about all axes; a telescoping one is that the other way round.
    """
    name = "".join(letter for letter in kind.lower() if letter.isalnum()).removesuffix("joint")
    name = _OTHER_NAMES.get(name, name)
    if name in _PAIRS:
        found, movement = _PAIRS[name]
        return ExportedKind(found, Chain((movement,), base[None]))
    make = _MADE.get(name)
    return None if make is None else make(base, follower)


def _universal(base: Transform, follower: Transform) -> ExportedKind | None:
    axis1, axis2 = base[:3, 0], follower[:3, 1]
    along = float(axis1 @ axis2)
    if abs(along) > NEARLY_PERPENDICULAR:
        return None
    axis2 = axis2 - along * axis1
    return _as(pairs.universal("universal", "base", "follower", point=base[:3, 3], axis1=axis1, axis2=axis2))


def _pin_slot(base: Transform, follower: Transform) -> ExportedKind:
    direction, axis = base[:3, 0], base[:3, 2]
    return _as(pairs.pin_in_slot("slot", "base", "follower", point=follower[:3, 3], axis=axis, direction=direction))


def _free(base: Transform, follower: Transform) -> ExportedKind:
    return _as(pairs.free("free", "base", "follower", point=follower[:3, 3]))


def _bearing(base: Transform, follower: Transform) -> ExportedKind | None:
    line = MateFeature("line", base[:3, 3], base[:3, 2])
    found = mate("coincident", line, MateFeature("point", follower[:3, 3], base[:3, 2]), 0.0, 0.0)
    return None if found is None or found.kind is None else ExportedKind(found.kind, found.chain)


def _telescoping(base: Transform, follower: Transform) -> ExportedKind | None:
    found = _bearing(follower, base)
    return None if found is None else found._replace(swapped=True)


def _as(made: Joint) -> ExportedKind:
    return ExportedKind(made.kind, Chain(made.movements, np.asarray(made.frames_1)))


_MADE: dict[str, Callable[[Transform, Transform], ExportedKind | None]] = {
    "universal": _universal,
    "pinslot": _pin_slot,
    "pininslot": _pin_slot,
    "bearing": _bearing,
    "telescoping": _telescoping,
    "6dof": _free,
    "sixdof": _free,
    "free": _free,
    "bushing": _free,  # three springs along and about the axes, which exports do not say
}
