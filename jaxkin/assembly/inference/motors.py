"""Shafts of motors: pins drawn into a housing, or loose in its blind hole, amid its screw holes, with a hub on them."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import NEAR_LENGTH, SAME_ANGLE, SAME_LENGTH, Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.standing import embedded_pins, on_floors
from jaxkin.geometry.pose import Vector
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind

MIN_SCREWS = 2
"""Screw holes of the flange of a motor round its shaft, at least."""
FLANGE_SCREWS = 3
"""Screw holes in a circle round an axis that make a flange of what has them, at least: two are those of any lug."""
MAX_FLANGE_SCREW = 0.2
"""Radius of such holes over that of their circle, at most, as of a flange for screws."""


def motor_shafts(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Make revolute joints of pins that stand in the material of a housing, or with play on the floor of its hole, and
    carry a hub.

    The screw holes of the housing are round about the pin, and the hub is one body with the pin: clamped on a pin that
    does not turn, it would be of no use. A post is set into its hole without play.
    """
    body, result = known.body, []
    for each in (*embedded_pins(known, fastening), *_in_blind_holes(known, fastening)):
        for shaft, housing in (each.parts, each.parts[::-1]):
            pins = [bore for bore in known.bores[shaft] if not bore.hole]
            if not pins or shaft not in fastening or shaft in known.fixed:
                continue  # a nut has holes only
            pin = max(pins, key=lambda bore: bore.half)
            hubs = [part for part in known.names if body[part] == body[shaft] and part not in fastening]
            around = screw_holes(known.bores[housing], pin)
            if not hubs or body[housing] == body[shaft] or not around:
                continue
            text = f"{each.evidence.text}, amid {len(around)} screw holes, and carries {hubs[0]!r}: a shaft"
            evidence = Evidence(EvidenceKind.ENCLOSED, (*each.evidence.sizes, ("radius", pin.radius)), text)
            parts = (housing, shaft)
            joint = pairs.revolute("-".join(parts), *parts, point=pin.point, axis=pin.axis)
            result.append(Inference.of(joint, evidence))
    return result


def are_flanged(known: Known, pair: CommonAxis) -> bool:
    """Tell whether both parts of a pin in its hole have screws in a circle round its axis, as a motor and the flange on
    its shaft have: they carry a torque. What slides needs none, and has one thread on its end."""
    if pair.virtual:
        return False
    for part in pair.parts:
        circle = screw_holes(known.bores[part], pair.one)
        if len(circle) < FLANGE_SCREWS:
            return False
        if circle[0].radius > MAX_FLANGE_SCREW * np.linalg.norm(_offset(circle[0], pair.one)):
            return False
    return True


def _in_blind_holes(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Find the pins that stand on the floor of a hole in which they have play."""
    on, result = on_floors(known), []
    for pair in known.axes:
        pin, host = pair.parts
        loose = not pair.virtual and pair.clearance > SAME_FIT * pair.other.radius
        if loose and pin in fastening and host in on.get(pin, ()):
            text = f"{pin!r} stands on the floor of its hole in {host!r}, with a clearance of {pair.clearance:.2g}"
            evidence = Evidence(EvidenceKind.ENCLOSED, (("clearance", pair.clearance),), text)
            result.append(Inference((pin, host), evidence))
    return result


def screw_holes(own: Sequence[Bore], pin: Bore) -> list[Bore]:
    """Find the most equal holes along a pin that are as far from its axis, and whose middle is on it; none if these are
    fewer than MIN_SCREWS."""
    along = [bore for bore in own if bore.hole and np.linalg.norm(np.cross(bore.axis, pin.axis)) <= SAME_ANGLE]
    patterns = []
    for first in along:
        away = np.linalg.norm(_offset(first, pin))
        some = [
            bore
            for bore in along
            if abs(bore.radius - first.radius) <= SAME_LENGTH * first.radius
            and abs(np.linalg.norm(_offset(bore, pin)) - away) <= NEAR_LENGTH * away
        ]
        middle = np.mean([_offset(bore, pin) for bore in some], axis=0)
        if away > pin.radius + first.radius and np.linalg.norm(middle) <= NEAR_LENGTH * away:
            patterns.append(some)
    most = max(patterns, key=len, default=[])
    return most if len(most) >= MIN_SCREWS else []


def _offset(bore: Bore, pin: Bore) -> Vector:
    """Measure how far a hole is from the axis of a pin, across it."""
    offset = bore.point - pin.point
    return offset - (offset @ pin.axis) * pin.axis
