"""Angles of loops of which a full turn is a displacement, since couplings tie them to what does not turn alike."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage

WHOLE = 1e-9
"""How far the ratio of two angles may be from a whole number, and still count as one."""


def coupled_turns(linkage: Linkage, driven: Iterable[str]) -> tuple[str, ...]:
    """List the angles in loops, by their full names, whose full turns are closed poses of their own.

    A turn of a rocker that moves a rack closes its loops as they were, with the rack elsewhere. No such angle is one
    that follows from the `driven` coordinates by couplings alone, or that whole numbers of turns tie to another angle.
    """
    known, before = set(driven), -1
    while len(known) > before:
        before = len(known)
        for coupling in linkage.couplings:
            if len(left := set(coupling.coordinates) - known) == 1:
                known |= left
    inside = [linkage.joints[number] for group in linkage.structure.uncoupled_groups for number in group.joints]
    angles = {joint.full_names[k] for joint in inside for k in turning(joint)}
    tied = [coupling for coupling in linkage.couplings if not _by_whole_turns(coupling, angles)]
    found = [name for coupling in tied for name in coupling.coordinates if name in angles and name not in known]
    return tuple(dict.fromkeys(found))


def turning(joint: Joint) -> list[int]:
    """List the coordinates of a joint that turn about an axis and do nothing else: a full turn of them is no motion."""
    return [
        own[element.coordinate]
        for movement, own in zip(joint.movements, coordinate_ranges(joint.movements), strict=True)
        for element in MOVEMENTS[movement].elements
        if element.kind == "rotate" and element.law is None
    ]


def _by_whole_turns(coupling: Coupling, angles: set[str]) -> bool:
    """Tell whether a coupling ties two angles of loops, one of which makes whole turns where the other makes one."""
    factors = np.abs(np.asarray(coupling.coefficients, float))
    if len(factors) != 2 or np.any(factors[:, 1:]) or not set(coupling.coordinates) <= angles:
        return False
    ratio = factors[:, 0].max() / factors[:, 0].min()
    return abs(ratio - round(ratio)) <= WHOLE * ratio
