"""Joints of parts that nothing else ties: equal bores far from each other, and pins that are far too thin."""

from __future__ import annotations

from itertools import combinations

from jaxkin.assembly.inference.fasteners import bolted, patterns
from jaxkin.assembly.inference.hinges import hinges
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
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
    held = bolted(patterns(axes, [], body), known.order)
    apart = {frozenset(body[part] for part in each.parts) for each in held}
    single = [pair for pair in axes if frozenset(body[part] for part in pair.parts) not in apart]
    return [*held, *(each.inference for each in hinges(known, axes=single))]
