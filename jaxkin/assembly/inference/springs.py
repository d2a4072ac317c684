"""Springs that are drawn as tubes: they push two parts from each other, and stop neither of them."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.axes import shared_length
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.measured import Measured
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Part
from jaxkin.geometry.surfaces import Cylinder, Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind

LOOSE = 0.08
"""Radial clearance of a spring about its rod, over the radius of the rod, at least: tubes that are springs have 0.10 to
0.15 in 4 kinds of machines, spacers, bushes and sleeves up to 0.056 in 16."""
MAX_WIRE = 0.45
"""Thickness of the wall over the outer radius, at most: that of a spring is its wire. Springs have 0.20 to 0.43,
spacers 0.40 to 0.56."""
SLENDER = 1.0
"""Length over the outer diameter, at least: washers and rings are shorter."""
WIDE = 0.5
"""Radial clearance about the rod, over the radius of the rod, from which on a tube may be as short as `STOUT`: ten
times that of spacers. The spring of the one valve that was drawn has 2.2 about its stem."""
STOUT = 0.6
"""The same as `SLENDER` of tubes that are `WIDE`, which no washer is: that spring has 0.95."""
PILOT = 0.4
"""Length over that of the tube, up to which a pin of what it lies on is a pilot, which centres a spring: the rod
goes through more of it. The retainer of that valve has 0.10."""


class DrawnSpring(NamedTuple):
    """A tube of the form of a compressed spring, and what it is between."""

    part: str
    seat: str
    """The part that it lies on with one end, and stays on."""
    pushed: str
    """The part that it lies on with the other end."""
    inference: Inference


def springs(
    measured: Measured, contacts: Sequence[Contact], fixed: Collection[str], by_hand: Collection[str]
) -> list[DrawnSpring]:
    """Find the tubes with thin walls that are loose about a rod and lie with both ends on different parts, and on
    nothing else but pilots of these; those of which a user says something `by_hand` are left to that.

    Form alone does not tell a spring from a spacer that is loose on its screw: whether the parts at its ends move on
    each other without it does.
    """
    pins = [pair for pair in measured.axes(None) if not pair.virtual]
    set_in = {id(pair.one) for pair in pins if pair.clearance < LOOSE * pair.other.radius}  # bushes; cans are wider
    touching: dict[str, list[Contact]] = {}
    for contact in contacts:
        for part in contact.parts:
            touching.setdefault(part, []).append(contact)
    result = []
    for part in measured.parts:
        tube = _tube(part, measured.bores[part.name])
        if tube is None or part.name in by_hand or id(tube[1]) in set_in:
            continue
        ends = _ends(part.name, tube[0], touching.get(part.name, []))
        rod = None if ends is None else _rod(measured, *tube, ends)
        if ends is None or rod is None:
            continue
        clearance = tube[0].radius - rod.radius
        short = SLENDER if clearance < WIDE * rod.radius else STOUT
        if clearance < LOOSE * rod.radius or tube[1].half < short * tube[1].radius:
            continue
        seat, pushed = sorted(ends, key=lambda end: end not in fixed)
        text = f"{part.name!r} is taken for a spring, a tube with a clearance of {clearance:.2g} about its rod, which "
        text += f"pushes {pushed!r} from {seat!r}; say rigid=[[{part.name!r}, {pushed!r}]] if it is a spacer"
        evidence = Evidence(EvidenceKind.ENCLOSED, (("radius", tube[1].radius), ("clearance", clearance)), text)
        result.append(DrawnSpring(part.name, seat, pushed, Inference((seat, part.name), evidence)))
    return result


def _tube(part: Part, own: Sequence[Bore]) -> tuple[Bore, Bore] | None:
    """Find the bore and the outside of a part that is a tube of thin walls with two plane ends, and nothing else."""
    holes, pins = [each for each in own if each.hole], [each for each in own if not each.hole]
    planes = [face.surface for face in part.faces if isinstance(face.surface, Plane)]
    round_faces = [face for face in part.faces if isinstance(face.surface, Cylinder)]
    if len(holes) != 1 or len(pins) != 1 or len(planes) != 2 or len(planes) + len(round_faces) != len(part.faces):
        return None
    hole, pin = holes[0], pins[0]
    thin = pin.radius - hole.radius <= MAX_WIRE * pin.radius
    return (hole, pin) if thin and hole.on_axis_of(pin) else None


def _rod(measured: Measured, hole: Bore, outside: Bore, ends: Collection[str]) -> Bore | None:
    """Find the thickest pin that a tube is about, whatever its room; pilots of the parts at its ends are none, however
    they fit, nor is the can that is about the tube."""
    found = []
    for part, own in measured.bores.items():
        for bore in own if part != hole.part else ():
            within = not bore.hole and bore.radius < outside.radius
            shared = 0.0 if not within or not bore.on_axis_of(hole) else shared_length(bore, hole)
            if shared > (PILOT * 2 * hole.half if part in ends else 0.0):
                found.append(bore)
    return max(found, key=lambda bore: bore.radius, default=None)


def _ends(name: str, axis: Bore, touching: Sequence[Contact]) -> tuple[str, str] | None:
    """Find the two parts that a tube lies on with its ends; None where it touches others but for their pilots in it,
    or one part twice."""
    ends: dict[bool, set[str]] = {True: set(), False: set()}
    piloted: set[str] = set()
    for contact in touching:
        plane = contact.surfaces[contact.parts.index(name)]
        if contact.contact_state.is_pin:
            piloted |= {*contact.parts} - {name}
            continue
        if not contact.contact_state.is_flat or not isinstance(plane, Plane):
            return None
        along = float(plane.normal @ axis.axis)
        if abs(along) < np.cos(ACROSS):
            return None
        ends[along > 0] |= {*contact.parts} - {name}
    apart = len(ends[True]) == len(ends[False]) == 1 and ends[True] != ends[False]
    if not apart or piloted - ends[True] - ends[False]:
        return None
    return next(iter(ends[True])), next(iter(ends[False]))
