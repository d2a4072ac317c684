"""What one screw alone clamps: a part under its head, flat on the part that the screw is tight in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.heads import lies_across
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.assembly.inference.trapped import ACROSS
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.evidence import Evidence, EvidenceKind

THROUGH = 0.08
"""Clearance over the radius of a hole that a screw goes through, at least: M3 to M10 have 0.09 to 0.12 by ISO 273,
hinges on screws less."""


def clamped_by_one_screw(known: Known, every: Sequence[Stack]) -> list[Inference]:
    """Join two parts that one screw holds to each other.

    The head, or a washer, lies on the one, through which the screw goes with the clearance of a screw and not of a
    hinge; the other one, on which that lies flat, has the hole that the screw is tight in. A bar with such screws into
    several bodies is a link, which turns on them.
    """
    body, found = known.body, []
    for stack in every:
        pairs = [pair for pair in known.axes if pair.one.part in stack.fasteners and not pair.virtual]
        tightest: dict[str, CommonAxis] = {}
        for pair in sorted(pairs, key=lambda each: -each.clearance):
            tightest[pair.other.part] = pair
        for inner in (pair for pair in pairs if pair.other.part in stack.held and _is_tight(pair)):
            host = inner.other.part
            for part, pair in tightest.items():
                apart = part in stack.held and body[part] != body[host] and pair.one.part == inner.one.part
                through = pair.clearance >= THROUGH * pair.other.radius
                if apart and through and lies_across(known, part, stack) and _lie_flat(known, part, host, inner):
                    found.append((part, inner, pair))
    partners: dict[str, set[str]] = {}
    for part, inner, _ in found:
        partners.setdefault(body[part], set()).add(body[inner.other.part])
    result = []
    for part, inner, pair in found:
        if len(partners[body[part]]) == 1:
            screw, host = inner.parts
            text = f"{screw!r} is tight in {host!r}, and its head lies on {part!r}, through which it goes with a"
            text += f" clearance of {pair.clearance:.2g}: it clamps them (if they turn on it, give that joint by hand)"
            sizes = (("radius", inner.one.radius), ("clearance", pair.clearance))
            parts = tuple(sorted((part, host), key=known.order.__getitem__))
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _is_tight(pair: CommonAxis) -> bool:
    return pair.clearance <= SAME_FIT * pair.other.radius


def _lie_flat(known: Known, one: str, other: str, axis: CommonAxis) -> bool:
    """Tell whether two parts lie flat on each other across an axis, and nowhere else."""
    planes = [each.surfaces[0] for each in known.contacts if {*each.parts} == {one, other}]
    return bool(planes) and all(
        isinstance(plane, Plane) and np.linalg.norm(np.cross(plane.normal, axis.one.axis)) < ACROSS for plane in planes
    )
