"""Where the parts of a mechanism are in each pose of a motion, and how they move there."""

from __future__ import annotations

from typing import NamedTuple

from jaxkin.effects.forces.changes import Changes
from jaxkin.effects.forces.places import Places, places, twists_of_parts
from jaxkin.effects.forces.screws import Twist
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import Rows


class MovingParts(NamedTuple):
    """Where the parts are, and how they move."""

    at: Places
    displacements: Rows
    velocity: Rows | None
    """Rates of all joints; None at rest."""
    twists: dict[str, Twist]
    """Of all parts that are not fixed; none at rest."""
    changes: dict[str, Twist]
    """Their derivatives."""

    @staticmethod
    def of(linkage: Linkage, found: Changes, chords: bool) -> MovingParts:
        """Place the parts, and find their twists."""
        at = places(linkage, found.displacements, chords)
        if found.velocity is None:
            return MovingParts(at, found.displacements, None, {}, {})
        twists = twists_of_parts(linkage, at, found.velocity, found.acceleration)
        return MovingParts(at, found.displacements, found.velocity, *twists)
