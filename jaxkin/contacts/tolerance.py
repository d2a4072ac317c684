"""Decide whether a touch of two surfaces counts as a contact, or is near enough to be reported as a near miss."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from jaxkin._arguments import one_number, positive_number
from jaxkin.contacts.touch import Touch
from jaxkin.geometry.part import Part, size
from jaxkin.geometry.surfaces import Surface

USUAL_LENGTH = 1e-5
"""Length tolerance over the diagonal of the assembly, where the numbers of the files are known well enough."""
NEAR = 100.0
"""Largest gap that is reported, over the length tolerance: by default 1e-3 of the size of the assembly, less than gaps
that are there on purpose."""
NEAR_PART = 0.01
"""Largest gap that is reported, over the diagonal of the smaller part: in a large assembly small parts with gaps of
their own size must not count as near."""
NEAR_TILT = 0.05
"""Largest tilt that is reported, radians: assemblies saved in an inexact pose were seen with tilts of 0.02."""
NEAR_FIT = 0.25
"""Largest clearance, interference or eccentricity of a fit that is reported, over its radius."""

NEAR_SLOT = 0.1
"""Largest gap on either side of a pin in a slot that is reported, over its radius: printed machines have 0.05. Machined
ones have less, which `NEAR` covers."""


@dataclass(frozen=True)
class ContactTolerance:
    """The tolerances of contact detection."""

    length: float
    """Largest gap that counts as touching, in the unit of the assembly."""
    least_length: float
    """Length with which the region of a touch is judged at the strictest, in the unit of the assembly: see
    `outline_length`. Faces touch wherever they do within any length from this one to `length`, so that a larger
    `length` loses no contact."""
    angle: float = 1e-4
    """Largest angle between directions that count as parallel, radians."""
    fit: float = 0.02
    """Largest clearance, over the radius, with which a pin fills its hole and a ball its socket."""
    near_length: float = 0.0
    """Largest gap that is reported as a near miss, in the unit of the assembly."""

    def between(self, one: Part, other: Part) -> ContactTolerance:
        """Return these tolerances with `near_length` set for two given parts."""
        return replace(self, near_length=min(NEAR * self.length, NEAR_PART * min(size((one,)), size((other,)))))

    def fits(self, touch: Touch, extent: float, s1: Surface, s2: Surface) -> bool:
        """Check whether a touch of surfaces `s1`, `s2` is a contact; `extent` is the length of the contact region."""
        return touch.tilt <= self.angle and self.excess(touch, extent, s1, s2) == 0.0

    def excess(self, touch: Touch, extent: float, s1: Surface, s2: Surface) -> float:
        """Compute by how much a touch exceeds the tolerances on lengths, as a length: zero for a contact."""
        if touch.clearance is None:
            return max(0.0, reach(touch, extent) - self.length)
        loose = max(self.length, self.fit * smaller_radius(s1, s2))
        beyond = max(0.0, -self.length - touch.clearance, touch.clearance - loose)
        allowed = self.length + min(max(0.0, touch.clearance), loose)  # the pin may lie anywhere in its hole
        return beyond + max(0.0, reach(touch, extent) - allowed)

    def near(self, touch: Touch, s1: Surface, s2: Surface) -> bool:
        """Check whether a touch is near enough to be reported if it is no contact."""
        allowed = max(self.length, self.near_length)
        if touch.clearance is not None:
            allowed = max(allowed, NEAR_FIT * smaller_radius(s1, s2))
            if abs(touch.clearance) > allowed:
                return False
        return touch.tilt <= NEAR_TILT and abs(touch.gap) <= allowed


def check_tolerances(length: object, angle: object, fit: object) -> None:
    """Raise ValueError for tolerances of contacts that are no numbers or negative; `length` may be None."""
    if length is not None:
        positive_number(length, "the length of contacts")
    positive_number(angle, "the angle of contacts")
    if one_number(fit, "the fit of contacts") < 0:
        raise ValueError(f"the fit of contacts must be a number, zero or more, got {fit!r}")


def reach(touch: Touch, extent: float) -> float:
    """Compute the largest distance of the surfaces over the contact region: |gap| + tilt x extent / 2."""
    return abs(touch.gap) + touch.tilt * extent / 2


def default_length(parts: tuple[Part, ...]) -> float:
    """Choose the length tolerance: 1e-5 of the diagonal of the assembly, or what rounding leaves of two surfaces."""
    return max(USUAL_LENGTH * size(parts), 2 * max(part.resolution for part in parts))


def outline_length(parts: tuple[Part, ...]) -> float:
    """Choose the length within which outlines of faces are known: as `default_length`, but of corners of triangles."""
    return max(USUAL_LENGTH * size(parts), 2 * max(part.vertex_resolution for part in parts))


def smaller_radius(s1: Surface, s2: Surface) -> float:
    """Return the smaller radius of two surfaces, to which the clearance of a fit is relative; infinite without one."""
    return min(getattr(surface, "radius", np.inf) for surface in (s1, s2))
