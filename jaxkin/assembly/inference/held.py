"""Pins and fasteners, and the bodies that hold them; bodies that bolts hold to each other."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.covers import covered_by
from jaxkin.assembly.inference.fasteners import MAX_NUT, Stack, away_from, bolted, is_cotter, patterns
from jaxkin.assembly.inference.heads import goes_through, is_exposed, is_headed
from jaxkin.assembly.inference.holders import holder_of, is_trapped
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT, is_round, is_round_about
from jaxkin.assembly.inference.stop_faces import nearest
from jaxkin.joints.evidence import Evidence, EvidenceKind

LONG = 2.5
"""Length of a ring on a pin over the radius of the pin, from which on it is a roller or a spacer: nuts have up to 2."""
LOOSE, MIN_LOOSE = 1.7, 0.05
"""The same of a ring with play, and the least clearance of such, over the radius: nuts have up to 1.6, and no play."""
LIFTED = 0.15
"""Distance from a face, over the radius of a pin, up to which a bolt of a pattern clamps there: plates are drawn with
gaps of a tenth of a millimetre, and guide pins end a millimetre before the floor of their holes."""


def with_hosts(every: Sequence[Stack], known: Known) -> list[Stack]:
    """Find the stacks with the parts that their fasteners are one body with already: these hold them, too; and whether
    they guide something, now that it is known what they are drawn into."""
    body, members = known.body, {}
    for part in known.names:
        members.setdefault(body[part], []).append(part)
    result = []
    for stack in every:
        hosts = {part for each in stack.fasteners for part in members[body[each]]} - {*stack.fasteners}
        held = known.in_order({*stack.held, *hosts})
        guides = stack.guides and is_exposed(known, stack) and not _is_tight(known, stack)
        result.append(replace(stack, held=held, guides=guides))
    return result


def _is_tight(known: Known, stack: Stack) -> bool:
    """Tell whether a stack has an interference in all holes that it is in, as a screw has that cuts its own thread:
    nothing slides on it."""
    pairs = [each for each in known.axes if each.one.part in stack.fasteners and each.other.part in stack.held]
    return bool(pairs) and all(not each.virtual and each.clearance < -SAME_FIT * each.other.radius for each in pairs)


def bolted_bodies(known: Known, every: Sequence[Stack]) -> list[Inference]:
    """Find bodies that have two or more parallel axes in common: what only touches a fastener, as a lever does that
    pushes pins, has no hole on its axis, and what slides on guide pins, or has a linear bearing on them, meets no face
    that would clamp it."""
    body = known.body

    def of_bodies(stack: Stack) -> Stack:
        own = {body[part] for part in stack.fasteners}
        sliding = {body[part] for part in stack.held if part in known.measured.linear_bearings} - own
        held = [p for p in stack.held if body[p] not in sliding]
        held = [p for p in held if known.bores_on(p, stack.axis) or body[p] in own]
        held = [part for part in held if body[part] in own or not _is_guided(known, stack, part, held)]
        return replace(stack, held=tuple(dict.fromkeys(body[part] for part in held)))

    flat = {frozenset(each.parts) for each in known.contacts if each.contact_state.is_flat}
    tapped = [pair for pair in known.tapped if frozenset(pair.parts) in flat]
    shared = patterns([*known.axes, *tapped], list(map(of_bodies, every)), body)
    return [each for each in bolted(shared, known.order) if len({body[part] for part in each.parts}) > 1]


def _is_guided(known: Known, stack: Stack, part: str, held: Sequence[str]) -> bool:
    """Tell whether a part has play on a stack, and neither fasteners nor other parts on it stand near a face of it."""
    pairs = [each for each in known.axes if each.other.part == part and each.one.part in stack.fasteners]
    loose = pairs and not any(each.virtual or each.clearance <= SAME_FIT * each.other.radius for each in pairs)
    return bool(loose) and not _is_met(known, stack, part, [*stack.fasteners, *held])


def _is_met(known: Known, stack: Stack, part: str, others: Sequence[str]) -> bool:
    """Tell whether a face of a part across the axis of a stack is near to one of others."""
    own = known.measured.stops(known.solids[part], stack.axis)
    faces = (known.measured.stops(known.solids[each], stack.axis) for each in others if each != part)
    gaps = (nearest(own, other, stack.axis.radius) for other in faces)
    return any(gap is not None and gap <= LIFTED * stack.axis.radius for gap in gaps)


def attached_fasteners(known: Known, every: Sequence[Stack]) -> list[Inference]:
    """Join fasteners with the body that holds them: the only one, the one without play, or that which holds them
    farthest out, as a fork does.

    A rod that something slides on belongs to the body that holds it on both sides of all others, or more tightly.
    """
    body, result = known.body, []
    fastening = {part for stack in every for part in stack.fasteners}
    for stack in every:
        owners = {body[part] for part in stack.fasteners}
        hosts = [part for part in stack.held if body[part] in owners and part not in known.sleeves | known.closed]
        several = len({body[part] for part in (*stack.held, *stack.fasteners)}) > 2
        slides = stack.guides and several and not is_headed(known, stack)
        met = tuple(part for part in stack.held if _is_met(known, stack, part, stack.fasteners))
        guides = any(_is_guided(known, stack, part, stack.held) for part in stack.held)
        on = replace(stack, held=met) if guides and met else stack
        holder, where = (hosts[0], "already") if hosts else holder_of(known, on, body, slides)
        turning = all(part in fastening or is_round_about(known, part, stack.axis) for part in hosts)
        if turning and (crank := _carried(known, stack, body)):
            holder, where = crank, "alone, as it turns in bushes of others"
        if (clamped := _clamped_on(known, stack, body)) is not None:
            holder, where = clamped, "on which its head lies, as what turns does so on its bushes"
        if (bearing := covered_by(known, stack, body)) is not None:
            holder, where = bearing, "on which it lies, with play on what goes through both"
        if slides and holder is None:
            continue
        parts = (*([holder] if holder else []), *stack.fasteners)
        if len({body[part] for part in parts}) > 1:
            told = f"held by {holder!r} {where}" if holder else "on one axis"
            text = f"{', '.join(map(repr, stack.fasteners))} {told}"
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, (("radius", stack.axis.radius),), text)))
    return result


def _carried(known: Known, stack: Stack, body: Mapping[str, str]) -> str | None:
    """Find the part that a shaft in bushes carries, as its crank: of the only body that is on it without them, and no
    more loosely; of several that which is not round. A body is on it with a bush, too, where that is in a wide hole of
    it, as the nut of a lead screw is in its slide."""
    own, on = {body[part] for part in stack.fasteners}, {}
    for pair in known.axes:
        if pair.one.part in stack.fasteners and pair.other.part in stack.held and not pair.virtual:
            on.setdefault(body[pair.other.part], []).append(pair)
    others = {owner: pairs for owner, pairs in on.items() if owner not in own}
    tightest = {owner: min(pairs, key=lambda pair: pair.clearance) for owner, pairs in others.items()}
    bushed = [owner for owner, pair in tightest.items() if pair.other.part in known.sleeves]
    loosest = max((tightest[owner].clearance for owner in bushed), default=-np.inf)
    rest = [pair for owner, pairs in others.items() if owner not in bushed for pair in pairs]
    rest = [pair.other.part for pair in rest if pair.clearance <= loosest + SAME_FIT * stack.axis.radius]
    carried = [part for part in rest if not is_round_about(known, part, stack.axis)] or rest
    return carried[0] if len({body[part] for part in carried}) == 1 else None


def _clamped_on(known: Known, stack: Stack, body: Mapping[str, str]) -> str | None:
    """Find the part that the head of a screw with its nut lies on, where a bush or a bearing on the screw turns: of the
    only body without one on the screw that lies flat on the stack, with a hole that the screw goes through, by
    however much it is wider."""
    with_hole = [any(bore.hole for bore in known.bores[part]) for part in stack.fasteners]
    bushed = {body[part] for part in stack.held if part in known.sleeves}
    if all(with_hole) or not any(with_hole) or not bushed:
        return None  # no screw with a nut, or nothing that turns on it
    on = [pair.other.part for pair in known.axes if pair.one.part in stack.fasteners]
    pins = [bore for part in stack.fasteners for bore in known.bores[part] if not bore.hole]
    found = [
        part
        for part in stack.held
        if part not in on
        and body[part] not in bushed
        and known.touches_across(part, stack.axis.axis, *stack.fasteners)
        and any(goes_through(pin, hole) for hole in known.bores[part] if hole.hole for pin in pins)
    ]
    return found[0] if len({body[part] for part in found}) == 1 else None


def rollers(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the round parts on a pin that lie flat on nothing, and are long, wide, or have much play: rollers, planets
    and cutting wheels, no nuts or washers. A pin with a cotter across it, which is in nothing else, is none: it
    does not turn about that, as a piston has a pin across that is in its rod, too."""
    lying = {part for each in known.contacts if each.contact_state.is_flat for part in each.parts}
    result = set()
    for pair in known.axes:
        name, radius = pair.other.part, pair.other.radius
        if pair.virtual or name not in fastening or name in lying:
            continue
        if id(pair.other) in known.plugged and is_cotter(pair, known.axes, fastening):
            continue
        own, half = known.bores[name], pair.other.half
        long = half >= LONG * radius / 2 and any(not bore.hole for bore in own) and is_round(known, name, own)
        wide = away_from(known.solids[name], pair.other) > MAX_NUT * radius
        if long or wide or (half >= LOOSE * radius / 2 and pair.clearance > MIN_LOOSE * radius):
            result.add(name)
    return result


def pressed_rings(known: Known) -> list[Inference]:
    """Find round parts that are tight on one pin and that no face keeps there: nuts on rods, collars, wheels."""
    around: dict[str, list[CommonAxis]] = {}
    for pair in known.axes:
        for part in pair.parts:
            around.setdefault(part, []).append(pair)
    result = []
    for name, pairs in around.items():
        tight = all(pair.other.part == name and pair.tight and not pair.virtual for pair in pairs)
        pins = {pair.one.part for pair in pairs}
        own, hole = known.bores[name], max(pairs, key=engaged).other
        if not tight or len(pins) > 1 or name in known.fixed or not all(bore.on_axis_of(hole) for bore in own):
            continue
        if all(bore.hole for bore in own) or not is_round(known, name, own):
            continue
        (pin,) = pins
        if not is_trapped(known, pin, hole):
            sizes = (("radius", hole.radius), ("clearance", min(pair.clearance for pair in pairs)))
            text = f"{name!r} is tight on {pin!r}, with an interference of {-sizes[1][1]:.2g}"
            parts = known.in_order((name, pin))
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result
