"""Joints of the exports of CAD systems, by the names of their kinds: movements and frames."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np

from jaxkin.contacts.states import find_state
from jaxkin.geometry.pose import Transform, inverse
from jaxkin.joints import pairs
from jaxkin.joints.combine import SUBGROUP_JOINTS, Chain
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind

_ALONE = {str(kind): (kind, movement) for kind, movement in SUBGROUP_JOINTS.values()}
"""Name of a subgroup joint -> its kind and movement."""
_OTHER_NAMES = {
    "weld": "fixed", "fastened": "fixed", "rigid": "fixed", "gimbal": "spherical", "ball": "spherical",
    "hinge": "revolute", "pin": "revolute", "slider": "prismatic", "cylinder": "cylindrical",
    "parallel": "schoenflies",
}  # fmt: skip
"""What systems call the subgroup joints. A gimbal has the rotations of a ball, as angles about successive axes."""
NEARLY_PERPENDICULAR = 1e-4
"""Cosine between the two axes of a universal joint, up to which what they are not perpendicular by is rounding."""


class ExportedKind(NamedTuple):
    """What a kind of joint leaves free between two frames."""

    kind: JointKind
    chain: Chain
    swapped: bool = False
    """Whether the chain begins at the follower."""
    offset: float = 0.0
    """Distance of the two frames along the directions in which the joint holds them together."""
    tilt: float = 0.0
    """Angle between them about the axes about which the joint does not turn, radians."""


class _Held(NamedTuple):
    """What a joint holds of the frame that it ends at, in the one that its chain begins at."""

    places: str
    """Coordinates of its origin that are zero, of "xyz"."""
    turns: Literal["none", "axis", "all"] = "none"
    """Whether z of the two frames is the same, or all axes are."""


def joint_of_kind(kind: str, base: Transform, follower: Transform) -> ExportedKind | None:
    """Return the kind and the displacements of a joint between two frames; None for kinds that are not known.

    The axis of most kinds is the z axis of the frames. A universal joint turns about the x axis of the base and the y
    axis of the follower; the slot of a pin is along the x axis of the base. Of a bearing joint the centre of the
    follower slides along the axis of the base and turns about all axes; a telescoping one is that the other way round.
    """
    name = "".join(letter for letter in kind.lower() if letter.isalnum()).removesuffix("joint")
    name = _OTHER_NAMES.get(name, name)
    if name in _ALONE:
        known, movement = _ALONE[name]
        found = ExportedKind(known, Chain((movement,), base[None]))
    elif name not in _MADE or (found := _MADE[name](base, follower)) is None:
        return None
    first, second = (follower, base) if found.swapped else (base, follower)
    offset, tilt = _apart(_HELD[name], first, second)
    return found._replace(offset=offset, tilt=tilt)


def _apart(held: _Held, first: Transform, second: Transform) -> tuple[float, float]:
    """Measure the distance and the angle by which two frames differ in what a joint holds."""
    between = inverse(first) @ second
    offset = float(np.linalg.norm([between["xyz".index(each), 3] for each in held.places]))
    if held.turns == "none":
        return offset, 0.0
    if held.turns == "axis":
        return offset, float(np.arctan2(np.linalg.norm(between[:2, 2]), between[2, 2]))
    turn = between[:3, :3]
    sine = 0.5 * np.linalg.norm([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return offset, float(np.arctan2(sine, 0.5 * (np.trace(turn) - 1.0)))


def _universal(base: Transform, follower: Transform) -> ExportedKind | None:
    axis1, axis2 = base[:3, 0], follower[:3, 1]
    along = float(axis1 @ axis2)
    if abs(along) > NEARLY_PERPENDICULAR:
        return None
    axis2 = axis2 - along * axis1
    return _as(pairs.universal("universal", "base", "follower", point=base[:3, 3], axis1=axis1, axis2=axis2))


def _pin_slot(base: Transform, follower: Transform) -> ExportedKind:
    centre, axis = _on_axis(base, follower, 0), base[:3, 2]
    return _as(pairs.pin_in_slot("slot", "base", "follower", point=centre, axis=axis, direction=base[:3, 0]))


def _free(base: Transform, follower: Transform) -> ExportedKind:
    return _as(pairs.free("free", "base", "follower", point=follower[:3, 3]))


def _bearing(base: Transform, follower: Transform) -> ExportedKind:
    centre = base.copy()
    centre[:3, 3] = _on_axis(base, follower, 2)
    movements = find_state("j", "circle").movements
    return ExportedKind(JointKind.of_state("j"), Chain(movements, np.stack([base, centre])))


def _telescoping(base: Transform, follower: Transform) -> ExportedKind:
    return _bearing(follower, base)._replace(swapped=True)


def _on_axis(base: Transform, follower: Transform, axis: int) -> np.ndarray:
    """Find the point of an axis of the base next to the follower, which is beside it by rounding at least."""
    direction = base[:3, axis]
    return base[:3, 3] + float((follower[:3, 3] - base[:3, 3]) @ direction) * direction


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

_HELD = {
    "fixed": _Held("xyz", "all"), "revolute": _Held("xyz", "axis"), "prismatic": _Held("xy", "all"),
    "cylindrical": _Held("xy", "axis"), "planar": _Held("z", "axis"), "spherical": _Held("xyz"),
    "universal": _Held("xyz"), "pinslot": _Held("yz", "axis"), "pininslot": _Held("yz", "axis"),
    "bearing": _Held("xy"), "telescoping": _Held("xy"),
    "rectangular": _Held("z", "all"), "cartesian": _Held("", "all"), "schoenflies": _Held("", "axis"),
    **dict.fromkeys(("6dof", "sixdof", "free", "bushing"), _Held("")),
}  # fmt: skip
"""Kinds of joints, as `joint_of_kind` knows them -> what they hold."""
