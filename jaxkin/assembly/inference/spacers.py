"""Spacers and stand-offs: tubes between faces of two parts, with holes on their axis for screws that are not drawn."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.surfaces import Plane


def spacers(known: Known, fastening: Collection[str]) -> list[Stack]:
    """Find the tubes without a screw in them that stand between flat faces of two parts, with holes for their screws.

    Both parts are held by such a spacer as by a screw: two parallel ones make them one body.
    """
    filled = {id(pair.other) for pair in known.axes if not pair.virtual}
    empty = [pair for pair in (*known.axes, *known.tapped) if pair.virtual]
    result = []
    for name in (name for name in known.names if name in fastening):
        own = known.bores[name]
        holes = [bore for bore in own if bore.hole]
        if len(holes) != 1 or len(holes) == len(own) or id(holes[0]) in filled:
            continue
        pairs = [pair for pair in empty if holes[0] is pair.one or holes[0] is pair.other]
        beyond = {part for pair in pairs for part in pair.parts} - {name}
        ends = {ahead: _touching(known, name, holes[0], ahead) & beyond for ahead in (True, False)}
        if all(ends.values()):
            held = known.in_order(ends[True] | ends[False])
            result.append(Stack((name,), held, holes[0], guides=False))
    return result


def _touching(known: Known, name: str, axis: Bore, ahead: bool) -> set[str]:
    """Find the parts that lie flat on one end of a part, ahead along an axis or behind."""
    found = set()
    for contact in known.contacts:
        if name not in contact.parts or not contact.contact_state.is_flat:
            continue
        plane = contact.surfaces[contact.parts.index(name)]
        along = float(plane.normal @ axis.axis) if isinstance(plane, Plane) else 0.0
        if (along if ahead else -along) > np.cos(ACROSS):
            found |= {*contact.parts} - {name}
    return found
