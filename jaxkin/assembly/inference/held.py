"""Pins and fasteners, and the bodies that hold them; bodies that bolts hold to each other."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore
from jaxkin.assembly.inference.covers import covered_by
from jaxkin.assembly.inference.fasteners import MAX_NUT, Stack, away_from, bolted, is_cotter, patterns
from jaxkin.assembly.inference.heads import goes_through, is_exposed, is_headed
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.moving_pins import moves_in_holes
from jaxkin.assembly.inference.sleeves import SAME_FIT, is_round, is_round_about
from jaxkin.assembly.inference.stop_faces import MAX_AXIAL_PLAY, nearest, play
from jaxkin.assembly.inference.ties import first_largest
from jaxkin.joints.evidence import Evidence, EvidenceKind

LONG = 2.5
"""Length of a ring on a pin over the radius of the pin, from which on it is a roller or a spacer: nuts have up to 2."""
LOOSE, MIN_LOOSE = 1.7, 0.05
"""The same of a ring with play, and the least clearance of such, over the radius: nuts have up to 1.6, and no play."""
PRESSED = 0.02
"""Clearance of a ring that is pressed on a pin, over the radius, at most: a spacer has more."""
MIN_PRESSED = 0.55
"""Length of such a ring on the pin, over the radius, at least: a large washer of ISO 7093 has 0.5, and holds no pin."""
LIFTED = 0.15
"""Distance from a face, over the radius of a pin, up to which a bolt of a pattern clamps there: plates are drawn with
gaps of a tenth of a millimetre, and guide pins end a millimetre before the floor of their holes."""

BESIDE = 2.0
"""Gap between two arms on one shaft, over its radius, at most: carriages on a rod start farther from its ends."""


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
        holder, where = (hosts[0], "already") if hosts else _holder(known, on, body, slides)
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


def _holder(known: Known, stack: Stack, body: Mapping[str, str], slides: bool) -> tuple[str | None, str]:
    """Find the part that holds a stack, and how: of the body whose bores reach farthest along the axis.

    A body that is round about the axis, as a roller or a planet is, turns on the stack, and so does one that is on it
    with sleeves only, where there is another one. Of a body that a pin fits exactly, and others with play, it is the
    former: those turn on it. Of a fixed body and one other, which fit alike on two ends, it is the fixed one. Where
    others slide on the stack, that body reaches farther on both sides, or fits more tightly; None if none does.
    """
    along = stack.axis.axis
    reach: dict[str, list[tuple[float, float, str]]] = {}
    fits: dict[str, float] = {}
    bushed: set[str] = set()
    traps: set[str] = set()
    for pair in known.axes:
        for pin, hole in ((pair.one, pair.other), (pair.other, pair.one)):
            if pin.part in stack.fasteners and hole.part in stack.held and hole.part not in known.closed:
                owner = body[hole.part]
                reach.setdefault(owner, []).append((*hole.reach(along), hole.part))
                if (fit := max(pair.clearance, 0.0)) < fits.get(owner, np.inf):
                    fits[owner] = fit
                    (bushed.add if hole.part in known.sleeves else bushed.discard)(owner)
                if slides and _is_trapped(known, pin.part, hole):
                    traps.add(owner)
    if not reach:
        others = [part for part in stack.held if part not in known.closed] or stack.held  # either ring may hold it
        return (others[0] if others else None), "only"
    ends = {
        owner: (min(end[0] for end in some), max(end[1] for end in some), some[0][2]) for owner, some in reach.items()
    }
    keepers = _keepers(known, stack, reach, fits)
    rounding = SAME_LENGTH * stack.axis.radius
    widest = first_largest(keepers, lambda owner: ends[owner][1] - ends[owner][0], rounding)
    low, high, part = ends[widest]
    if len(reach) == 1:
        # as a shaft in bushes, also where its collars touch what these are in; a nut is on a sleeve, and not in it
        in_sleeves = all(end[2] in known.sleeves for some in reach.values() for end in some)
        turns = in_sleeves and any(not bore.hole for part in stack.fasteners for bore in known.bores[part])
        moves = turns or moves_in_holes(known, stack, low, high, fits[widest] > SAME_FIT * stack.axis.radius)
        return (None, "") if moves else (part, "only")
    turns = all(end[2] in known.sleeves for end in reach[widest])  # as a shaft in bearings, not as a rod in holes
    others = [ends[owner] for owner in ends if owner != widest]
    tightest = first_largest(fits, lambda owner: -fits[owner], rounding)
    same = SAME_FIT * stack.axis.radius
    if not slides and tightest in keepers and [owner for owner, fit in fits.items() if fit <= same] == [tightest]:
        return ends[tightest][2], "which it fits exactly, and has play in others"
    inside = all(low + rounding < one and other < high - rounding for one, other, _ in others)
    if not slides or (not turns and inside):
        grounded = {body[name] for name in known.fixed} & reach.keys()
        if len(reach) == 2 and grounded and not inside and max(fits.values()) - min(fits.values()) <= same:
            return ends[min(grounded)][2], "as it is fixed, and fits it as the other one does"
        return part, "farthest out"
    looser = [fit for fit in fits.values() if fit > fits[tightest] + same]  # two cranks fit their shaft alike
    if traps - {tightest} or tightest in bushed:
        return None, ""  # as a screw that turns in a slide goes with the slide, and not with its nut
    if looser and not (_slides_between(ends, tightest) and _has_room(ends, fits, same, stack.axis.radius)):
        return ends[tightest][2], "more tightly than by others"
    return (part, "on one end") if looser else (None, "")


def _slides_between(ends: Mapping[str, tuple[float, float, str]], owner: str) -> bool:
    """Tell whether a body is on a rod between others that are on both ends of it, as a linear bearing is."""
    low, high, _ = ends[owner]
    others = [end for other, end in ends.items() if other != owner]
    return any(end[1] <= low for end in others) and any(end[0] >= high for end in others)


def _has_room(
    ends: Mapping[str, tuple[float, float, str]], fits: Mapping[str, float], same: float, radius: float
) -> bool:
    """Tell whether what fits a rod exactly can slide there: not where several bodies do, and each one with play is
    between them or beside one of them, as the arms of a scissor lift are that turn on a shaft across."""
    exact = [ends[owner] for owner, fit in fits.items() if fit <= same]
    if len(exact) < 2:
        return True
    for owner, fit in fits.items():
        low, high, _ = ends[owner]
        gaps = [max(first - high, low - last) for first, last, _ in exact]
        between = min(last for _, last, _ in exact) <= low and high <= max(first for first, *_ in exact)
        if fit > same and not between and min(gaps) > BESIDE * radius:
            return True
    return False


def _keepers(
    known: Known, stack: Stack, reach: Mapping[str, Sequence[tuple[float, float, str]]], fits: Mapping[str, float]
) -> list[str]:
    """Find the bodies that may hold a stack: not those that are round about it, but for one that fits more tightly than
    all others, nor those that are on it with sleeves only, if there are others."""

    def turns(parts: Sequence[str]) -> bool:
        round_ones = all(is_round_about(known, part, stack.axis) for part in parts)
        return round_ones or all(part in known.sleeves for part in parts)

    keeping = [owner for owner, some in reach.items() if not turns([part for *_, part in some])] or list(reach)
    tightest = first_largest(fits, lambda owner: -fits[owner], SAME_LENGTH * stack.axis.radius)
    looser = min((fits[owner] for owner in keeping if owner != tightest), default=0.0) - fits[tightest]
    pressed = tightest not in keeping and looser > SAME_FIT * stack.axis.radius
    pressed = pressed and fits[tightest] <= PRESSED * stack.axis.radius
    length = sum(high - low for low, high, _ in reach[tightest])
    pressed = pressed and length >= MIN_PRESSED * stack.axis.radius
    return [tightest] if pressed and not all(part in known.sleeves for *_, part in reach[tightest]) else keeping


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


def _is_trapped(known: Known, pin: str, hole: Bore) -> bool:
    """Tell whether faces on both sides keep a pin from sliding in the hole of a part, such as those beside a collar."""
    one, other = (known.measured.stops(known.solids[part], hole) for part in (pin, hole.part))
    room = play(one, other, hole.radius)
    return room is not None and room <= MAX_AXIAL_PLAY * hole.radius


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
        if not _is_trapped(known, pin, hole):
            sizes = (("radius", hole.radius), ("clearance", min(pair.clearance for pair in pairs)))
            text = f"{name!r} is tight on {pin!r}, with an interference of {-sizes[1][1]:.2g}"
            parts = known.in_order((name, pin))
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result
