"""Feathers: keys that are longer than the hub that they keep from turning, so that it slides along them."""

from __future__ import annotations

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.keyed import is_key
from jaxkin.assembly.inference.known import Known
from jaxkin.geometry.part import Part
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind

STROKE = 1.0
"""Length by which a feather is out of its hub on one side, over the radius of the shaft, at least: keys that hold their
hub have up to 0.17 in 22 drawings, feathers the stroke of what slides on them, 2 and 4 in two more."""


def feathers(known: Known) -> list[Inference]:
    """Find feathers: bodies of shafts and the feathers in their slots, and the slides of the hubs on them.

    A key that holds its hub is no longer than the hub, since the rest would carry nothing. One that is longer guides a
    hub that slides, unless the hub lies on a shoulder of the shaft.
    """
    result = []
    for pair in known.axes:
        if pair.virtual or pair.threaded or frozenset(pair.parts) in known.by_hand:
            continue
        shaft, hub = (known.solids[part] for part in pair.parts)
        for key in known.measured.beside(shaft):
            out = _out_of(key, pair)
            if key is hub or out < STROKE * pair.one.radius or not is_key(key, shaft, hub, pair):
                continue
            if _is_shouldered(known, pair):
                continue
            sizes = (("radius", pair.one.radius), ("stroke", out))
            text = f"the feather {key.name!r} is set in a slot of {shaft.name!r}"
            result.append(Inference((shaft.name, key.name), Evidence(EvidenceKind.FASTENER, sizes, text)))
            parts = known.in_order(pair.parts)
            text = f"the feather {key.name!r} guides {hub.name!r} along {shaft.name!r}, and is out of it by {out:.3g}"
            evidence = Evidence(EvidenceKind.CLEARANCE, sizes, text)
            joint = pairs.prismatic("-".join(parts), *parts, point=pair.other.point, axis=pair.one.axis)
            result.append(Inference.of(joint, evidence))
    return result


def _out_of(key: Part, pair: CommonAxis) -> float:
    """Measure the length of a key beyond the hole of the hub, on the side where more of it is."""
    along = key.outermost @ pair.one.axis
    low, high = pair.other.reach(pair.one.axis)
    return float(max(low - along.min(), along.max() - high))


def _is_shouldered(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a hub lies on a face of its shaft across the axis."""
    shaft, hub = pair.parts
    return hub in known.parts_flat_on(shaft, pair.one.axis)
