"""Screws across a shaft whose tip stands in a groove that goes round it: the shaft turns, and does not slide."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import NEAR_LENGTH, Bore
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS, MAX_OVERLAP

MAX_WIDTH = 1.5
"""Width of a groove over that of the tip in it, at most: a screw in a wider neck of a shaft presses on that."""


def in_ring_grooves(known: Known) -> dict[tuple[str, str], float]:
    """Find the screws in a hole of a hub that stand in a groove all round the shaft in that hub, each with the shaft,
    and the play that they leave it along its axis.

    The groove lies between two shoulders of the shaft, to which the tip reaches down beside them, and its root is round
    about the axis of the shaft. A flat has no such root, a dimple or a slot no shoulders all round.
    """
    in_hub: dict[str, list[CommonAxis]] = {}
    for pair in known.axes:
        if not pair.virtual:
            in_hub.setdefault(pair.other.part, []).append(pair)
    result = {}
    for pairs in in_hub.values():
        axes = np.array([pair.one.axis for pair in pairs])
        for number, along in np.argwhere(np.abs(axes @ axes.T) < ACROSS).tolist():
            screw, shaft = pairs[number].one.part, pairs[along]
            plays = [_play(known, tip, shaft) for tip in known.bores[screw] if screw != shaft.one.part]
            least = min((play for play in plays if play is not None), default=None)
            if least is not None:
                result[screw, shaft.one.part] = least
    return result


def turning_in_hubs(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the parts of the form of a fastener in whose groove a screw stands, and that are in holes of one body only:
    they turn there, as no fastener does. The pin of a fork, which a screw keeps, is in what turns on it as well."""
    body = known.body
    shafts = {shaft for _, shaft in known.in_ring_grooves}
    around: dict[str, set[str]] = {}
    for pair in known.axes:
        if pair.one.part in shafts and not pair.virtual:
            around.setdefault(pair.one.part, set()).add(body[pair.other.part])
    return {shaft for shaft, hosts in around.items() if shaft in fastening and len(hosts) == 1}


def _play(known: Known, tip: Bore, shaft: CommonAxis) -> float | None:
    """Measure the play of a tip in a groove of a shaft along that; None where it is in none."""
    axis, slack = shaft.one.axis, NEAR_LENGTH * shaft.one.radius
    offset = tip.point - shaft.one.point
    nearest, aside = abs(float(offset @ tip.axis)) - tip.half, abs(float(offset @ np.cross(tip.axis, axis)))
    across = not tip.hole and abs(float(tip.axis @ axis)) < ACROSS
    if not across or aside > slack or not slack < nearest < shaft.one.radius - slack:
        return None
    height = float(tip.point @ axis)
    round_about = [bore for bore in known.bores_on(shaft.one.part, shaft.one) if not bore.hole]
    root = [span for bore in round_about if bore.radius <= nearest + slack for span in bore.spans_along(axis)]
    wider = [span for bore in round_about if bore.radius > nearest + slack for span in bore.spans_along(axis)]
    below, above = ([span for span in wider if way * (sum(span) / 2 - height) > 0] for way in (-1, 1))
    if not below or not above or not any(low < height < high for low, high in root):
        return None
    play = min(low for low, _ in above) - max(high for _, high in below) - 2 * tip.radius
    fits = -MAX_OVERLAP * tip.radius <= play <= (MAX_WIDTH - 1) * 2 * tip.radius
    return max(play, 0.0) if fits else None
