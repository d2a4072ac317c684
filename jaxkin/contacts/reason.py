"""Write why a near miss is no contact, and what to do about it."""

from __future__ import annotations

from collections.abc import Callable

from jaxkin.contacts.region import ContactRegion
from jaxkin.contacts.remedy import ToleranceChoices, remedy, told_apart
from jaxkin.contacts.tolerance import ContactTolerance, reach, smaller_radius
from jaxkin.contacts.touch import Touch
from jaxkin.geometry.surfaces import Surface

_GIVE = " give "
"""What the tolerances with which faces would be in contact follow in a reason."""
_PRESS = ": a press fit holds the parts together, join them with "
"""What the line that joins parts of a press fit follows in a reason."""


def reason(
    parts: tuple[str, str],
    touch: Touch,
    region: ContactRegion,
    tolerance: ContactTolerance,
    surfaces: tuple[Surface, Surface],
    works: Callable[[ContactTolerance], bool],
) -> str:
    """Write a clause for each condition of a contact that a touch violates, with what to correct in the model.

    The text ends with the tolerances with which the faces would be in contact, if there are any. `works` checks whether
    given tolerances make them a contact.
    """
    clauses = []
    loose = max(tolerance.length, tolerance.fit * smaller_radius(*surfaces))
    allowed = tolerance.length + min(max(0.0, touch.clearance or 0.0), loose)
    pressed = touch.clearance is not None and touch.clearance < -tolerance.length
    if pressed:
        clauses.append(
            f"thicker than its hole by {-(touch.clearance or 0.0):.3g}{_PRESS}rigid=[[{parts[0]!r}, {parts[1]!r}]]"
        )
    wide = touch.clearance is not None and touch.clearance > loose
    if wide:
        clauses.append("radial clearance {}, allowed {}".format(*told_apart(touch.clearance or 0.0, loose)))
    if touch.tilt > tolerance.angle or reach(touch, region.extent) > allowed:
        if touch.tilt > tolerance.angle or touch.tilt * region.extent > allowed:
            clauses.append(f"tilted by {touch.tilt:.3g} rad over {region.extent:.3g}: align the parts")
        if abs(touch.gap) > allowed / 2:
            clauses.append(_gap(touch, allowed))
    if not region.inside:
        clauses.append("the faces meet only along an edge")
    options = {} if pressed else remedy(touch, region, tolerance, surfaces, works)
    if not options and wide and len(clauses) == 1:
        tighter = (touch.clearance or 0.0) - loose
        return f"{clauses[0]}: no tolerance makes it a contact; if it guides, make it tighter by {tighter:.3g}"
    return "; ".join(clauses) + _advice(options, only=wide and len(clauses) == 1)


def advises_tolerance(text: str) -> bool:
    """Tell whether a reason ends with tolerances to give."""
    return _GIVE in text


def of_moving_parts(text: str, joint: str) -> str:
    """Write a reason anew for parts that a joint lets move on each other, as a seal in its cylinder or a valve on its
    seat: a line that joins them would lock that joint."""
    thicker, press, line = text.partition(_PRESS)
    if not press:
        return text
    moves = f": joint {joint!r} lets the parts move on each other, as a seal or a seat does"
    return f"{thicker}{moves}; a press fit would hold them together, and lock that joint: {line}"


def _advice(options: ToleranceChoices, only: bool) -> str:
    """Write the end of the text: the tolerances to give; `only` says that there is nothing to correct in the model."""
    if not options:
        return ""
    given = ", ".join(f"{name}={value:g}" for name, value in options.items())
    guides = " if it guides" if "fit" in options else ""
    return f"{':' if only else ', or'}{_GIVE}{given}{guides}"


def _gap(touch: Touch, allowed: float) -> str:
    """Write the clause on a gap or overlap larger than the length `allowed`."""
    if touch.clearance is not None:
        return "off centre by {}, allowed {}: centre it".format(*told_apart(abs(touch.gap), allowed))
    if touch.gap < 0:
        return f"the parts overlap by {-touch.gap:.3g}: move them apart"
    return f"a gap of {touch.gap:.3g}: close it"
