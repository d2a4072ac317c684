"""Nuts of lead screws: flanged nuts that screws hold to a carriage, on a long rod beside the guides of the carriage,
and those of screws that turn in what slides along them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.axes import shared_length
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.moves import moves
from jaxkin.assembly.inference.sleeves import flanged_to
from jaxkin.assembly.inference.stop_faces import WIDER
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind

MINOR = 0.31
"""Radius of a lead screw less that of its nut, over that of the screw, at most: at the minor diameter it is pitch over
diameter of a trapezoidal thread, 0.12 (Tr 100 x 12) to 0.3 (Tr 10 x 3); the nut of T8 has 0.19 to 0.25."""
THREAD = 0.09
"""The same, from which on a hole is drawn at the minor diameter; what is wider may be a flanged bush on a guide rod."""
PLAY = 0.05
"""Clearance of a nut that is drawn at the major diameter, over the radius of the screw, at most."""
SAME = 0.005
"""Interference of such a nut, over the radius of the screw, that is rounding."""
LONG = 3.0
"""Length of a lead screw over that of its nut, at least: the screw of a clamp ends at its nut."""
BEYOND = 1.0
"""Length of a rod beyond both ends of what is on it, over its radius, at least: bolts end at the faces that they
clamp."""
BOLTS = 2
"""Screws or empty holes beside the screw that hold the flange of a nut to its carriage, at least."""
DECIMALS = 6
"""Decimals of the point and the axis in the line of a screw joint."""


class LeadNut(NamedTuple):
    """A rod that is a lead screw, and its nut."""

    screw: Bore
    nut: Bore
    carriage: str
    """The part that the flange of the nut is on."""
    guide: str
    """The part with a rod on which the carriage slides."""


def lead_nuts(known: Known) -> list[LeadNut]:
    """Find the flanged nuts of lead screws, threads drawn plain, at the minor or the major diameter.

    A rod goes through the nut and far beyond it on both sides; two or more parallel axes hold the flange to a part that
    a rod beside it guides. A flanged bush on a guide rod looks alike where the hole is as wide as the rod: there the
    screw has a collar or a bearing, on which it turns and does not slide.
    """
    bearings = {each.inner for each in known.measured.bearings}
    result = []
    for pair in known.axes:
        screw, nut = pair.one, pair.other
        thinner = -pair.clearance / screw.radius
        at_minor = THREAD <= thinner <= MINOR
        if pair.virtual or screw.hole or not (at_minor or -PLAY <= thinner <= SAME) or not _goes_beyond(screw, nut):
            continue
        length = 2 * nut.half
        if 2 * screw.half < LONG * length or (not at_minor and not _turns(known, screw, nut, bearings)):
            continue
        hosts = [host for host, count in flanged_to(known, nut.part, nut).items() if count >= BOLTS]
        hosts = [host for host in hosts if host != screw.part]
        guides = [(host, guide) for host in hosts if (guide := _guide(known, host, screw)) is not None]
        for host, guide in guides[:1]:
            result.append(LeadNut(screw, nut, host, guide))
    return result


def on_lead_screws(known: Known, found: list[LeadNut]) -> list[Inference]:
    """Make cylindrical joints of lead screws with their nuts, whose pitch is not drawn, if exact contacts do not make
    them; a note has the line of the screw joint."""
    result = []
    for screw, nut, carriage, guide in found:
        body = known.body
        owners = {body[screw.part], body[nut.part]}
        if any({body[part] for part in each.parts} == owners for each in known.contacts):
            continue
        result.append(_on_thread(known, screw, nut, f"whose flange is on {carriage!r}, which {guide!r} guides"))
    return result


def on_travelling_screws(known: Known) -> list[Inference]:
    """Make cylindrical joints of threads drawn plain, thicker than their nut, where a third body says that they move on
    each other: the screw turns in it about its axis, and the nut slides on it along that, as in a vise.

    A thread that is held in its nut would lock that slide.
    """
    body, result = known.body, []
    tied = {*known.jointed, *(frozenset(body[part] for part in each.parts) for each in known.contacts)}
    for pair in known.axes:
        screw, nut = pair.one, pair.other
        owners = frozenset(body[part] for part in pair.parts)
        if not pair.threaded or len(owners) < 2 or owners in tied or -pair.clearance > MINOR * screw.radius:
            continue
        one, other = body[screw.part], body[nut.part]
        others = [each for each in dict.fromkeys(body.values()) if each not in owners]
        between = [each for each in others if moves(known, one, each, screw, turning=True)]
        between = [each for each in between if moves(known, other, each, screw, turning=False)]
        if between:
            why = f"and turns in {between[0]!r}, which slides along it on {other!r}"
            result.append(_on_thread(known, screw, nut, why))
            tied.add(owners)
    return result


def is_lead_screw(joint: Joint) -> bool:
    """Tell whether a joint is that of a lead screw, drawn thicker than its nut as a thread is."""
    fit = joint.evidence.relative_clearance if joint.evidence else None
    return joint.kind is JointKind.CYLINDRICAL and fit is not None and fit <= -THREAD


def _on_thread(known: Known, screw: Bore, nut: Bore, why: str) -> Inference:
    """Make the cylindrical joint of a screw with its nut, and tell the line of the screw joint."""
    parts = known.in_order((screw.part, nut.part))
    name = "-".join(parts)
    point, axis = ((np.round(each, DECIMALS) + 0.0).tolist() for each in (nut.point, screw.axis))
    line = f"jk.screw({name!r}, {parts[0]!r}, {parts[1]!r}, point={point}, axis={axis}, pitch=...)"
    text = f"the rod of radius {screw.radius:.4g} goes through the hole of {nut.radius:.4g} of {nut.part!r}, {why}: a "
    text += f"lead screw whose pitch is not drawn; say joints=[{line}] with the advance per turn"
    sizes = (("radius", screw.radius), ("clearance", nut.radius - screw.radius))
    joint = pairs.cylindrical(name, *parts, point=nut.point, axis=screw.axis)
    return Inference.of(joint, Evidence(EvidenceKind.CLEARANCE, sizes, text))


def _goes_beyond(rod: Bore, hole: Bore) -> bool:
    """Tell whether a rod goes on beyond both ends of a hole."""
    (low, high), (first, last) = rod.reach(rod.axis), hole.reach(rod.axis)
    return min(first - low, high - last) >= BEYOND * rod.radius


def _turns(known: Known, screw: Bore, nut: Bore, bearings: set[str]) -> bool:
    """Tell whether a rod has a collar of its own beside a nut, or is in a bearing."""
    own = [bore for bore in known.bores_on(screw.part, screw) if not bore.hole and bore.radius > WIDER * screw.radius]
    collar = any(shared_length(bore, nut) <= 0 for bore in own)
    seated = {each.one.part for each in known.axes if not each.virtual} & known.closed  # others roll on it
    return collar or any(each.one.part == screw.part and each.other.part in bearings | seated for each in known.axes)


def _guide(known: Known, carriage: str, screw: Bore) -> str | None:
    """Find a part with a rod parallel to a screw, on another axis, that goes through a hole of a carriage, whatever
    bush is between."""
    holes = [bore for bore in known.bores[carriage] if bore.hole and beside(bore, screw)]
    for part in known.names:
        if part in (carriage, screw.part):
            continue
        for rod in (bore for bore in known.bores[part] if not bore.hole):
            for hole in holes:
                near = np.linalg.norm(np.cross(rod.point - hole.point, hole.axis)) <= PLAY * hole.radius
                thin = rod.radius <= hole.radius and 2 * rod.half >= LONG * 2 * hole.half
                if near and thin and beside(rod, screw) and _goes_beyond(rod, hole):
                    return part
    return None
