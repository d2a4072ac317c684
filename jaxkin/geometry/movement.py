"""What defines an allowable movement: coordinates, elementary motions, and all else that differs from one to another.

All movements are rows of `jaxkin.geometry.movements.MOVEMENTS`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from jaxkin.geometry.elementary_motions import ElementaryMotion
from jaxkin.geometry.figures import Figure


class InvariantFeature(NamedTuple):
    """The point, axis or plane that a movement leaves in place. Lengths of a part are measured between features."""

    kind: Literal["point", "axis", "plane"]
    axis: int = 2
    """Axis of the frame, 0, 1, 2 for x, y, z, that is the axis, or the normal of the plane; unused for a point."""
    marked: bool = False
    """Whether the origin of the frame is a definite point of the axis: it is for a hinge, not for a pin that slides."""


class AngleLock(NamedTuple):
    """The angles of a ball that two successive movements of a chain share, as in the contact states (d), (p).

    They have a gimbal lock after a quarter turn of the ball, so the solver uses a quaternion in their place
    (`jaxkin.solve.system.loop_system`).
    """

    follower: str
    """Key of the second of the two movements; the first is the one whose row holds this lock."""
    ball: int
    """The movement in whose frame the ball turns: 0 for the first, 1 for the second."""
    columns: tuple[int, ...]
    """Coordinates that turn the ball about x, y, z, counted from the first coordinate of the first movement. Where only
    two are given, the rotation about z belongs to the second movement."""


@dataclass(frozen=True, kw_only=True)
class Movement:
    """All that defines an allowable movement: one row of `MOVEMENTS`."""

    coordinates: tuple[str, ...] = ()
    """Names of the coordinates of the movement, in their order in `q`."""
    elements: tuple[ElementaryMotion, ...] = ()
    """The elementary motions of which the movement is the product, leftmost factor first."""
    ball: bool = False
    """True for the three angles of a spherical pair, which have a gimbal lock at phi = 90 deg, so that the solver uses
    a quaternion in their place."""
    subgroup_joint: str | None = None
    """Value of the `JointKind` of the joint with this movement alone whose displacements form a subgroup of those of
    space: a lower pair, or slides in a plane or in space, with or without a turn; None where no such joint has it."""
    letter: str | None = None
    """Letter of the joint in the names of loops, such as RSSR; None where the letters of the elementary motions are
    written: R for a rotation, P for a translation, H for a screw."""
    feature: InvariantFeature | None = None
    """The feature that the movement leaves in place on both parts; None for the identity."""
    features_alone: tuple[InvariantFeature, InvariantFeature] | None = None
    """The features on part 1 and part 2 for a joint of this movement only, where they differ from `feature`."""
    surface: Literal["plane", "cylinder", "cone", "sphere"] | None = None
    """Kind of surface for which this is the movement with most freedoms that maps the surface onto itself."""
    aligned: frozenset[Literal["axis", "direction", "centre"]] = frozenset()
    """What of the frame matters for the closure of loops, so that noise in it is removed: "axis", the line along z;
    "direction", the direction of z; "centre", the origin."""
    figures: tuple[tuple[Figure, ...], tuple[Figure, ...]] = ((), ())
    """The solids drawn for part 1 (bearing, rail, plate) and for part 2 (pin, slider, puck, ball)."""
    lock: AngleLock | None = None
    """The gimbal lock of this movement and the next one in a chain; None where there is none."""

    @property
    def has_pitch(self) -> bool:
        """Whether the movement advances by a pitch."""
        return any(element.kind == "screw" for element in self.elements)

    @property
    def repeats(self) -> bool:
        """Whether a coordinate drives more than one of the elementary motions, each by itself and not by a law."""
        return len(self.elements) > len(self.coordinates) and not self.follows

    @property
    def follows(self) -> bool:
        """Whether the movement travels along a curve or over a surface of the joint, whose parameters are all of its
        coordinates."""
        return any(element.law is not None for element in self.elements)

    @property
    def only_slides(self) -> bool:
        """Whether the movement is one translation along z and nothing else."""
        return self.elements == (ElementaryMotion("translate", 2, 0),)

    @property
    def turns_and_slides(self) -> tuple[int, int]:
        """Number of rotations and number of translations among the elementary motions; screws count as neither."""
        kinds = [element.kind for element in self.elements]
        return kinds.count("rotate"), kinds.count("translate")
