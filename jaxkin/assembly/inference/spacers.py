"""Spacers and stand-offs: tubes between faces of two parts, with holes on their axis for screws that are not drawn, and
tubes that a screw clamps."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.one_screw import THROUGH
from jaxkin.assembly.inference.sleeves import SAME_FIT, Sleeve
from jaxkin.assembly.inference.stop_faces import ACROSS, stands_across
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


def clamped_standoffs(known: Known, found: Sequence[Sleeve]) -> dict[str, Inference]:
    """Find the sleeves that a screw clamps to a part beside what they are in, and the parts that are one body so.

    The screw is tight in the sleeve. Its head lies on the part, through which it goes with the clearance of a screw,
    and on the other side of which the sleeve ends: a stand-off, which what is round it turns on.
    """
    screws = [pair for pair in known.axes if not pair.virtual and pair.clearance <= SAME_FIT * pair.other.radius]
    result = {}
    for sleeve in found:
        axis = sleeve.housing.one
        for inner in (each for each in screws if each.other.part == sleeve.part and each.other.on_axis_of(axis)):
            through = [each for each in known.axes if each.one.part == inner.one.part and not each.virtual]
            for pair in (each for each in through if each.clearance >= THROUGH * each.other.radius):
                screw, part = pair.parts
                ends = [_ways_flat(known, part, each, axis) for each in (screw, sleeve.part)]
                if part != sleeve.housing.other.part and any(-one in ends[1] for one in ends[0]):
                    text = (
                        f"{screw!r} is tight in {sleeve.part!r}, and its head lies on {part!r}, through which it goes "
                    )
                    text += f"with a clearance of {pair.clearance:.2g}: it clamps them"
                    result.setdefault(sleeve.part, known.fastened(pair, text, screw, part, sleeve.part))
    return result


def _ways_flat(known: Known, part: str, other: str, axis: Bore) -> set[int]:
    """Find which way along an axis faces of a part look that lie flat on another one: 1 or -1."""
    some = [each for each in known.between.get(frozenset((part, other)), ()) if each.contact_state.is_flat]
    planes = [each.surfaces[each.parts.index(part)] for each in some]
    normals = [each.normal for each in planes if isinstance(each, Plane) and stands_across(each, axis.axis)]
    return {1 if normal @ axis.axis > 0 else -1 for normal in normals}
