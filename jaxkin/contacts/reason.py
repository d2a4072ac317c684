"""Why a near miss is no contact, and what to do about it, in words."""

from __future__ import annotations

from jaxkin.contacts.region import ContactRegion
from jaxkin.contacts.tolerance import Tolerance, reach, smaller_radius
from jaxkin.contacts.touch import Touch
from jaxkin.geometry.surfaces import Surface


def reason(touch: Touch, region: ContactRegion, tolerance: Tolerance, s1: Surface, s2: Surface) -> str:
    """One clause for each thing that keeps the touch from being a contact."""
    clauses = []
    loose = max(tolerance.length, tolerance.fit * smaller_radius(s1, s2))
    allowed = tolerance.length
    if touch.clearance is not None:
        allowed += max(0.0, touch.clearance)
        if touch.clearance < -tolerance.length:
            clauses.append(
                f"thicker than its hole by {-touch.clearance:.3g}: a press fit holds the parts together, join them"
            )
        elif touch.clearance > loose:
            fit = touch.clearance / smaller_radius(s1, s2)
            clauses.append(
                f"radial clearance {touch.clearance:.3g}, allowed {loose:.3g}: give fit={fit:.2g} if it guides"
            )
    if touch.tilt > tolerance.angle or reach(touch, region.extent) > allowed:
        if touch.tilt > tolerance.angle or touch.tilt * region.extent > allowed:
            clauses.append(f"tilted by {touch.tilt:.3g} rad over {region.extent:.3g}: align the parts")
        if abs(touch.gap) > allowed / 2:
            clauses.append(_gap(touch, allowed))
    if not region.inside:
        clauses.append("the faces meet only along an edge")
    return "; ".join(clauses)


def _gap(touch: Touch, allowed: float) -> str:
    if touch.clearance is not None:
        return f"off centre by {touch.gap:.3g}, allowed {allowed:.3g}: centre it"
    if touch.gap < 0:
        return f"the parts overlap by {-touch.gap:.3g}: move them apart"
    return f"a gap of {touch.gap:.3g}: close it, or give length={2 * touch.gap:.1g}"
