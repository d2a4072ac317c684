"""Where the parts of a mechanism are in each pose of a motion, and how they move there."""

from __future__ import annotations

from typing import NamedTuple

from jaxkin.effects.forces.changes import ByCoordinate, Changes
from jaxkin.effects.forces.places import Places, places, twists_of_parts
from jaxkin.effects.forces.screws import Twist
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import JointRates


class MovingParts(NamedTuple):
    """Where the parts are, and how they move."""

    at: Places
    displacements: JointDisplacements
    velocity: JointRates | None
    """Rates of all joints; None at rest."""
    twists: dict[str, Twist]
    """Of all parts that are not fixed; none at rest."""
    changes: dict[str, Twist]
    """Their derivatives."""
    along: dict[str, ByCoordinate]
    """First derivatives of the coordinates by each driven displacement, as `Changes` has them."""

    @staticmethod
    def of(linkage: Linkage, found: Changes, chords: bool) -> MovingParts:
        """Place the parts, and find their twists."""
        at = places(linkage, found.displacements, chords)
        if found.velocity is None:
            return MovingParts(at, found.displacements, None, {}, {}, found.along)
        twists, changes = twists_of_parts(linkage, at, found.velocity, found.acceleration)
        return MovingParts(at, found.displacements, found.velocity, twists, changes, found.along)
