"""Keys: a small part in a slot of a shaft and in one of the hub on it, which hold each other; flats and squares of
shafts."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.meshing_wheels import outer_teeth
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.stop_faces import ACROSS, MAX_LIFT, play
from jaxkin.assembly.inference.walls import between_faces, is_on_polygon, lengths_beside
from jaxkin.geometry.part import Part
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind

MAX_WIDTH = 1.0
"""Width of a key between the walls of its slots, over the radius of the shaft, at most: keys of tables have 0.4 to
0.7."""


MAX_HUB = 4.0
"""Length of a hub on a shaft with a flat, over the radius of the shaft, at most: what slides on such a shaft is longer,
so that it does not jam."""

MAX_SEAT = 1.25
"""Length of the polygon of a shaft over that of the hub on it, at most, to be the seat of the hub: one to slide on is
longer."""

MAX_SEAT_TURN = 0.15
"""Radians by which a hub turns to and fro on such a seat in all, at most: printed ones have a quarter of a millimetre
on each side of a square of 7."""

AT_BORE = 1.2
"""Distance of the inner ends of a slit from the axis over that of the bore: a hexagon is wider by 1.15 at its edges."""
AT_RIM = 0.98
"""Length of the sides of a slit over that of the rim, and distance of their outer ends over its radius, at least."""
MAX_SLIT = 0.5
"""Width of the slit of a collar over the radius of its rim, at most."""


def flatted_hubs(known: Known) -> list[Inference]:
    """Join hubs with the shafts whose flats keep them from turning, as those of motors and servos do: one flat, or two
    opposite ones.

    What keeps the hub from sliding, a set screw or a press fit, is mostly not drawn, and is assumed.
    """
    result = []
    for pair in known.axes:
        if (
            pair.virtual
            or frozenset(pair.parts) not in known.pinned
            or pair.other.half > MAX_HUB / 2 * pair.other.radius
        ):
            continue
        flats = [
            each.surfaces[0].normal
            for each in known.between[frozenset(pair.parts)]
            if each.contact_state.is_flat and isinstance(each.surfaces[0], Plane)
        ]
        along = [normal for normal in flats if abs(normal @ pair.one.axis) < ACROSS]
        if along and all(np.linalg.norm(np.cross(normal, along[0])) < ACROSS for normal in along):
            shaft, hub = pair.parts
            parts = known.in_order(pair.parts)
            sizes = (("radius", pair.one.radius),)
            text = f"a flat of {shaft!r} keeps {hub!r} from turning on it"
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def squared_hubs(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Join hubs with the shafts whose square or hexagon they are on with play, where a nut or a screw on the axis of
    the shaft and a shoulder keep them from sliding."""
    result = []
    tight = [pair for pair in known.axes if not pair.virtual and pair.clearance <= SAME_FIT * pair.other.radius]
    for pair in tight:
        for shaft, end in (pair.parts, pair.parts[::-1]):
            for hub, room in _on_polygon(known, shaft, pair, fastening) if end in fastening else ():
                text = f"flat sides of {shaft!r} keep {hub!r} from turning on it, and {end!r} from sliding off"
                sizes = (("radius", pair.one.radius), ("play", room))
                parts = known.in_order((shaft, hub, end))
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def slit_hubs(known: Known) -> list[Inference]:
    """Join hubs on the hexagon or the like of a shaft, without play, with the shaft where a slit goes from the bore of
    the hub to its rim: a clamp collar, whose screw may be left out. What slides on a hexagon has no slit."""
    result = []
    for hub in known.parts:
        rims = [bore for bore in known.bores[hub.name] if not bore.hole]
        if not rims:
            continue
        rim = max(rims, key=lambda bore: bore.radius)
        if not (slits := _slits(hub, rim)):
            continue
        for shaft in known.measured.beside(hub):
            touching = frozenset((shaft.name, hub.name)) in known.touching
            if touching and is_on_polygon(hub, shaft, rim.point, rim.axis, SAME_FIT):
                text = f"flat sides of {shaft.name!r} keep {hub.name!r} from turning on it, and its slit, "
                text += f"{slits[0]:.3g} wide from the bore to the rim, is that of a clamp"
                sizes = (("radius", rim.radius), ("width", slits[0]))
                parts = known.in_order((shaft.name, hub.name))
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _slits(hub: Part, rim: Bore) -> list[float]:
    """List the widths of the slits of a part, as long as its rim, that go from its bore to the rim on one side."""

    def away(triangles: Float[np.ndarray, "triangles 3 3"]) -> Float[np.ndarray, " corners"]:
        corners = triangles.reshape(-1, 3) - rim.point
        return np.linalg.norm(corners - np.outer(corners @ rim.axis, rim.axis), axis=1)

    sides, bore = [], away(hub.triangles).min()
    for face in hub.faces:
        plane, corners = face.surface, face.triangles.reshape(-1, 3) - rim.point
        if isinstance(plane, Plane) and abs(plane.normal @ rim.axis) < ACROSS:
            reach, long = away(face.triangles), np.ptp(corners @ rim.axis)
            whole = reach.min() <= AT_BORE * bore and reach.max() >= AT_RIM * rim.radius
            if whole and long >= AT_RIM * 2 * rim.half:
                sides.append((plane.normal, -float(corners[0] @ plane.normal), corners.mean(axis=0)))
    return [
        one + two
        for k, (normal, one, middle) in enumerate(sides)
        for other, two, beside in sides[:k]
        if normal @ other < -np.cos(ACROSS) and min(one, two) > 0 and one + two <= MAX_SLIT * rim.radius
        if np.cross(rim.axis, normal) @ middle * (np.cross(rim.axis, normal) @ beside) > 0
    ]


def seated_on_squares(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Join wheels with teeth with the slim shafts whose square or hexagon they are on with play, where that is no
    longer than the wheel: it leaves no stroke to shift gears, and is a seat, where a press fit keeps the wheel."""
    result = []
    for shaft in known.in_order(fastening):
        pins = [bore for bore in known.bores[shaft] if not bore.hole]
        if not pins:
            continue
        pin = max(pins, key=lambda bore: bore.half)
        for hub in known.measured.beside(known.solids[shaft]):
            touching = frozenset((shaft, hub.name)) in known.touching
            if touching and not known.touches_only_across(shaft, hub.name, pin.axis):
                continue
            on = is_on_polygon(hub, known.solids[shaft], pin.point, pin.axis, MAX_SEAT_TURN)
            if on and outer_teeth(hub, pin.point, pin.axis) is not None:
                long, seat = lengths_beside(hub, known.solids[shaft], pin.axis)
                if seat <= MAX_SEAT * long:
                    text = (
                        f"flat sides of {shaft!r} keep {hub.name!r} from turning on it, and are {seat:.3g} long, for "
                    )
                    text += f"a hub of {long:.3g}"
                    sizes = (("radius", pin.radius), ("length", seat))
                    parts = known.in_order((shaft, hub.name))
                    result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _on_polygon(known: Known, shaft: str, axis: CommonAxis, fastening: Collection[str]) -> Iterator[tuple[str, float]]:
    """Yield the hubs on a polygon of a shaft, between faces of the shaft and of fasteners on it, with their play."""
    on = {part for each in known.axes if shaft in each.parts for part in each.parts if part in fastening}
    for hub in known.measured.beside(known.solids[shaft]):
        if hub.name not in on and is_on_polygon(hub, known.solids[shaft], axis.other.point, axis.other.axis):
            ends = [stop for part in {shaft, *on} for stop in known.measured.stops(known.solids[part], axis.other)]
            room = play(ends, known.measured.stops(hub, axis.other), axis.other.radius)
            if room is not None and room <= MAX_LIFT * axis.other.radius:
                yield hub.name, room


def keyed_hubs(known: Known) -> list[Inference]:
    """Join hubs with their shafts and the keys between them.

    A key keeps a hub from turning on its shaft. What keeps the hub from sliding, a set screw or a press fit, is mostly
    not drawn, and is assumed.
    """
    result = []
    for pair in known.axes:
        if pair.virtual or pair.threaded:
            continue
        shaft, hub = (known.solids[part] for part in pair.parts)
        for key in known.measured.beside(shaft):
            if key is not hub and key.name not in known.fixed and is_key(key, shaft, hub, pair):
                text = f"the key {key.name!r} is in a slot of {shaft.name!r} and in one of {hub.name!r}"
                parts = known.in_order((*pair.parts, key.name))
                sizes = (("radius", pair.one.radius),)
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def is_key(part: Part, shaft: Part, hub: Part, pair: CommonAxis) -> bool:
    """Tell whether a part is between two walls along the axis of a shaft, in the same direction, in both others."""
    corners = part.outermost - pair.one.point
    away = corners - np.outer(corners @ pair.one.axis, pair.one.axis)
    if np.linalg.norm(away, axis=1).max() > 2 * pair.one.radius:
        return False
    walls = []
    for other in (shaft, hub):
        held = [normal for normal, _ in between_faces(part, other) if abs(normal @ pair.one.axis) < ACROSS]
        walls.append([normal for normal in held if np.ptp(away @ normal) <= MAX_WIDTH * pair.one.radius])
    return any(np.linalg.norm(np.cross(one, other)) < ACROSS for one in walls[0] for other in walls[1])
