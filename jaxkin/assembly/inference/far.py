"""Joints of parts that nothing else ties: equal bores far from each other, and pins that are far too thin."""

from __future__ import annotations

from itertools import combinations

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.fasteners import bolted, patterns
from jaxkin.assembly.inference.hinges import hinges
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.topology.components import connected


def far_joints(known: Known) -> list[Inference]:
    """Infer joints of bodies that nothing ties to the fixed ones, about axes that are doubtful otherwise.

    Bodies with two or more such axes in common are one body. These are better guesses than the nearest part.
    """
    ties = (*known.touching, *(each.parts for each in known.found), *known.rigid, *known.by_hand, known.fixed)
    groups = connected(known.names, [pair for tie in ties for pair in combinations(tie, 2)])
    group_of = {name: number for number, group in enumerate(groups) for name in group}
    axes = [pair for pair in known.far if group_of[pair.one.part] != group_of[pair.other.part]]
    if not axes:
        return []
    body = known.body
    set_in = [_set_in(known, pair) for pair in axes if not pair.virtual and _ends_in(pair)]
    axes = [pair for pair in axes if pair.virtual or not _ends_in(pair)]
    held = bolted(patterns(axes, [], body), known.order)
    apart = {frozenset(body[part] for part in each.parts) for each in (*set_in, *held)}
    single = [pair for pair in axes if frozenset(body[part] for part in pair.parts) not in apart]
    return [*set_in, *held, *(each.inference for each in hinges(known, axes=single) if not each.replaces_slide)]


def _ends_in(pair: CommonAxis) -> bool:
    """Tell whether a pin ends in its hole and is mostly outside; what slides in a hole that is much wider goes through
    it."""
    (low, high), (first, last) = (bore.reach(pair.one.axis) for bore in (pair.one, pair.other))
    return (first < low < last) != (first < high < last) and engaged(pair) < pair.one.half


def _set_in(known: Known, pair: CommonAxis) -> Inference:
    parts = known.in_order(pair.parts)
    text = (
        f"{pair.one.part!r} ends in a hole of {pair.other.part!r}, {pair.clearance:.2g} wider, and is tied to nothing"
    )
    sizes = (("radius", pair.other.radius), ("clearance", pair.clearance))
    return Inference(parts, Evidence(EvidenceKind.ENCLOSED, sizes, text))
