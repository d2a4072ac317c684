"""Joints of the exports of CAD systems, by the names of their kinds: movements and frames."""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.pose import Transform
from jaxkin.joints import pairs
from jaxkin.joints.combine import LOWER_PAIRS, Chain
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.two_frames import PERPENDICULAR

_PAIRS = {"weld": (JointKind.FIXED, LOWER_PAIRS[0, 0][1])} | {str(pair[0]): pair for pair in LOWER_PAIRS.values()}
_BALLS = ("gimbal", "ball")
"""Other names of the spherical pair: three rotations, as angles about successive axes."""
FREE = ("6dof", "sixdof", "bushing")
"""Joints that hold nothing: all six freedoms, perhaps with springs, which exports do not say."""


def joint_of_kind(kind: str, base: Transform, follower: Transform) -> tuple[JointKind, Chain] | None:
    """Return the kind and the displacements of a joint between two frames; None for kinds that are not known.

    The axis of most kinds is the z axis of the frames. A universal joint turns about the x axis of the base and the y
    axis of the follower; the slot of a pin is along the x axis of the base.
    """
    name = "".join(letter for letter in kind.lower() if letter.isalnum()).removesuffix("joint")
    name = str(JointKind.SPHERICAL) if name in _BALLS else name
    if name in _PAIRS:
        found, movement = _PAIRS[name]
        return found, Chain((movement,), base[None])
    if name == "universal":
        axis1, axis2 = base[:3, 0], follower[:3, 1]
        if abs(float(axis1 @ axis2)) > PERPENDICULAR:
            return None
        return _as(pairs.universal(kind, "base", "follower", point=base[:3, 3], axis1=axis1, axis2=axis2))
    if name in ("pinslot", "pininslot"):
        direction, axis = base[:3, 0], base[:3, 2]
        return _as(pairs.pin_in_slot(kind, "base", "follower", point=follower[:3, 3], axis=axis, direction=direction))
    return None


def _as(made: Joint) -> tuple[JointKind, Chain]:
    return made.kind, Chain(made.movements, np.asarray(made.frames_1))
