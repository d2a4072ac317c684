"""Nuts in pockets: hexagonal nuts that a hexagonal pocket keeps from turning, with play, as parts are printed for."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.undrawn import is_hexagonal
from jaxkin.assembly.inference.walls import between_faces
from jaxkin.geometry.pose import Vector
from jaxkin.joints.evidence import Evidence, EvidenceKind

MIN_PAIRS = 3
"""Directions in which a nut is between two walls of a pocket: two are those of a slot, in which it slides."""


def nuts_in_pockets(known: Known) -> list[Inference]:
    """Join hexagonal nuts that are on a thread with the part in whose pocket they are.

    A pocket is made for nothing else: what is screwed into the nut is held in that part, or moves it as a lead screw
    does.
    """
    result = []
    for pair in known.axes:
        nut, hole = pair.other.part, pair.other
        only = all(bore.hole and bore.on_axis_of(hole) for bore in known.bores[nut])
        if pair.virtual or nut in known.fixed or not only or not is_hexagonal(known, hole):
            continue
        for host in known.measured.beside(known.solids[nut]):
            if host.name == pair.one.part:
                continue
            plays: list[tuple[Vector, float]] = []
            for normal, play in between_faces(known.solids[nut], host):
                apart = (np.linalg.norm(np.cross(normal, other)) > ACROSS for other, _ in plays)
                if abs(normal @ hole.axis) < ACROSS and all(apart):
                    plays.append((normal, play))
            if len(plays) >= MIN_PAIRS:
                play = max(play for _, play in plays)
                text = f"the nut {nut!r} is in a hexagonal pocket of {host.name!r}, with a play of {play:.2g}"
                sizes = (("radius", hole.radius), ("play", play))
                parts = known.in_order((host.name, nut))
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result
