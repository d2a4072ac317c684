"""When a touch counts as a contact, and when it is near enough to be reported as a miss."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from jaxkin.contacts.touch import Touch
from jaxkin.geometry.part import Part, size
from jaxkin.geometry.surfaces import Surface

NEAR = 100.0
"""Gaps of so many length tolerances are still reported: 1e-3 of the size, below what is left free on purpose."""
NEAR_PART = 0.01
"""Of the smaller part's diagonal; gaps up to here are reported: a large assembly must not make small parts near."""
NEAR_TILT = 0.05
"""Radians; tilts up to here are reported. Assemblies saved in a sloppy pose were seen at 0.02."""
NEAR_FIT = 0.25
"""Of the radius; clearances, interferences and eccentricities of a fit up to here are reported."""


@dataclass(frozen=True)
class Tolerance:
    """Tolerances of contact detection. The lengths scale with the assembly, so that its unit does not matter."""

    length: float
    """Gap that still counts as touching, in the unit of the assembly."""
    angle: float = 1e-4
    """Radians between directions that count as parallel."""
    fit: float = 0.02
    """Clearance, relative to the radius, up to which a pin fills its hole and a ball its socket."""
    near_length: float = 0.0
    """Gap up to which a miss is reported."""

    def between(self, one: Part, other: Part) -> Tolerance:
        """The same with the gap that is worth a report between these two parts."""
        return replace(self, near_length=min(NEAR * self.length, NEAR_PART * min(size((one,)), size((other,)))))

    def fits(self, touch: Touch, extent: float, s1: Surface, s2: Surface) -> bool:
        """Whether a touch is a contact, given the extent of its region."""
        return touch.tilt <= self.angle and self.excess(touch, extent, s1, s2) == 0.0

    def excess(self, touch: Touch, extent: float, s1: Surface, s2: Surface) -> float:
        """The length by which a touch misses a contact after all that is allowed."""
        if touch.clearance is None:
            return max(0.0, reach(touch, extent) - self.length)
        loose = max(self.length, self.fit * smaller_radius(s1, s2))
        beyond = max(0.0, -self.length - touch.clearance, touch.clearance - loose)
        allowed = self.length + min(max(0.0, touch.clearance), loose)  # the pin may lie anywhere in its hole
        return beyond + max(0.0, reach(touch, extent) - allowed)

    def near(self, touch: Touch, s1: Surface, s2: Surface) -> bool:
        """Whether a touch is worth a report if it is no contact."""
        allowed = max(self.length, self.near_length)
        if touch.clearance is not None:
            allowed = max(allowed, NEAR_FIT * smaller_radius(s1, s2))
            if abs(touch.clearance) > allowed:
                return False
        return touch.tilt <= NEAR_TILT and abs(touch.gap) <= allowed


def reach(touch: Touch, extent: float) -> float:
    """The largest distance between the surfaces over the region: the gap, and the tilt over half its extent."""
    return abs(touch.gap) + touch.tilt * extent / 2


def default_length(parts: tuple[Part, ...]) -> float:
    """1e-5 of the diagonal of the assembly, or 1e-6 of its largest coordinate: placements come in single precision."""
    farthest = max(float(np.abs(part.box).max()) for part in parts)
    return max(1e-5 * size(parts), 1e-6 * farthest)


def smaller_radius(s1: Surface, s2: Surface) -> float:
    """What a fit is relative to."""
    return min(getattr(surface, "radius", np.inf) for surface in (s1, s2))
