"""Joints as chains of hinges, slides and balls, for formats whose joints have one axis each: MJCF, URDF, ASMT."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.io.names import unique
from jaxkin.joints.joint import Joint

HINGE, SLIDE, BALL = "hinge", "slide", "ball"


@dataclass(frozen=True, eq=False)
class SingleMotion:
    """A turn about an axis, a slide along it, or the turn of a ball, all at the assembled pose in the world."""

    name: str
    kind: Literal["hinge", "slide", "ball"]
    point: Float[np.ndarray, "3"]
    """A point of the axis, or the centre of the ball, in the unit of the file."""
    axis: Float[np.ndarray, "3"]
    limits: tuple[float, float]
    """Radians or lengths in the unit of the file, from the assembled pose; infinite where there is none."""
    follows: tuple[str, float] | None = None
    """The motion of the same joint whose displacement it repeats, and the factor; None for one of its own."""


def coordinate_scale(joint: Joint, column: int, metres: float) -> float:
    """Return the metres in the unit of a coordinate that is a length, 1 for an angle."""
    return metres if is_length(joint.coordinates[column]) else 1.0


def single_motions(joint: Joint, names: Sequence[str], metres: float, sign: int = 1) -> list[SingleMotion]:
    """Split a joint into single motions, from its first part to its second; against that where `sign` is -1.

    `names` are those of its coordinates (`coordinate_names`), `metres` the length of the unit of the mechanism in that
    of the file, which is a metre for robots. A motion that repeats the displacement of another one, as the advance of a
    screw does, follows it. Raises ValueError for a joint along a curve or over a surface, which is no product of turns
    and slides.
    """
    if joint.curves:
        raise ValueError(
            f"the format has no joints along curves and over surfaces, as {joint.name!r} ({joint.kind}) is one: leave "
            "it out, and drive what follows by what jaxkin computes"
        )
    made: list[SingleMotion] = []
    first = 0
    for frame, key in zip(np.asarray(joint.frames_1, float), joint.movements, strict=True):
        movement = MOVEMENTS[key]
        point = frame[:3, 3] * metres
        free = (-np.inf, np.inf)
        if movement.ball:
            made.append(SingleMotion(names[first], BALL, point, sign * frame[:3, 2], free))
        for motion in () if movement.ball else movement.elements:
            column = first + motion.coordinate
            name, axis, follows = names[column], sign * frame[:3, motion.axis], None
            limits = joint.limits[column] if joint.limits else free
            scale = coordinate_scale(joint, column, metres)
            limits = (limits[0] * scale, limits[1] * scale)
            if any(each.name == name for each in made):  # a motion has one axis: this one repeats the other
                follows, name = (name, 1.0), f"{name}_again"
            kind = SLIDE if motion.kind == "translate" else HINGE
            made.append(SingleMotion(name, kind, point, axis, limits, follows))
            if motion.kind == "screw":
                advance = float(joint.pitch) * metres / (2 * np.pi)
                made.append(SingleMotion(f"{name}_advance", SLIDE, point, axis, free, (name, advance)))
        first += len(movement.coordinates)
    return made[::sign]


def coordinate_names(joints: Sequence[Joint]) -> list[list[str]]:
    """Make a name for each coordinate: that of the joint, followed by that of the coordinate if there are several.

    The angles of a ball have one name together, since a ball is one joint.
    """
    result: list[list[str]] = []
    taken: list[str] = []
    for joint in joints:
        together = joint.driven_together
        own: list[str] = []
        for columns in together:
            coordinate = "ball" if len(columns) > 1 else joint.coordinates[min(columns)]
            name = joint.name if len(together) == 1 else f"{joint.name}_{coordinate}"
            taken = unique([*taken, name])
            own += [taken[-1]] * len(columns)
        result.append(own)
    return result
