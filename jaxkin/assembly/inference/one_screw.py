"""What one screw alone clamps: a part under its head, on the part that the screw is tight in, or on that of its nut."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import SAME_LENGTH, Bore
from jaxkin.assembly.inference.fasteners import Stack, beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.link_ends import link_ends
from jaxkin.assembly.inference.on_motors import bracket_of
from jaxkin.assembly.inference.sleeves import SAME_FIT, is_round_about
from jaxkin.joints.evidence import Evidence, EvidenceKind

THROUGH = 0.047
"""Clearance over the radius of a hole that a screw goes through, at least: M3 to M10 have 0.09 to 0.12 in the medium
series of ISO 273, and 0.048 to 0.07 in the fine one; hinges on screws have less."""

CORE = 16.0
"""Length of the hole of a profile, from end to end of it, over its radius, at least: no eye of a lever is as long."""


class _Clamped(NamedTuple):
    """A part that the head of a screw lies on, and the part that it is clamped to."""

    part: str
    host: str
    through: CommonAxis
    """The screw and the hole of the part."""
    inner: CommonAxis
    """The screw and the hole of the host."""
    turning: tuple[str, ...]
    """Which of the two turn on the screw if they are links: the one with the wider hole, or both; none with a flag."""
    why: str


def clamped_by_one_screw(known: Known, every: Sequence[Stack]) -> list[Inference]:
    """Join two parts that one screw holds to each other.

    The head, or a washer, lies on the one, through which the screw goes with the clearance of a screw and not of a
    hinge. The other one, on which that lies flat, has the hole that the screw is tight in, or lies on the nut, with a
    hole as wide. Where the screw is in a hole drilled for its thread, a second pin beside it serves as well as the flat
    faces, as that of an adjusting screw: the part cannot turn, and the head keeps it from sliding off. A round part,
    as the washer at the end of a shaft, may lie on a hub that is one body with the shaft, and no washer of the screw.
    A bar with such screws into several bodies is a link, which turns on them; so are levers, and leaves on two screws.
    A pin with a flag under a screw, itself in a hole of what the screw is tight in, turns on neither, nor does a bar on
    end, with the screw in the hole along its middle, as in the core of a profile.
    Where nothing of that is drawn, either may be meant: the text says how to have the hinge.
    """
    body = known.body
    found = [each for stack in every for each in (*_under_head(known, stack, body), *_on_bolt(known, stack, body))]
    ground, partners = {body[part] for part in known.fixed}, {}
    for each in found:
        owners = {body[each.part], body[each.host]}
        for owner in {body[part] for part in each.turning} - ground:
            partners.setdefault(owner, set()).update(owners - {owner})
    ends, mounted = (link_ends(known), _with_motors(known, body)) if found else ([], body)
    links, result = {owner for owner, others in partners.items() if len(others) > 1}, []
    for each in found:
        turning = {body[part] for part in each.turning}
        if not links & turning and not _is_lever(known, each, mounted, ends) and not _is_leaf(each, found, body):
            text = f"{each.why} with a clearance of {each.through.clearance:.2g}: it clamps them"
            text += f" (if they turn on it, give joints=[{_hinge(each)}])"
            sizes = (("radius", each.inner.one.radius), ("clearance", each.through.clearance))
            parts = known.in_order((each.part, each.host))
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _with_motors(known: Known, body: Mapping[str, str]) -> dict[str, str]:
    """Count each motor that is one solid with its shaft as one body with the only one that it touches beside its hubs:
    it is screwed on there."""
    result = dict(body)
    for motor in dict.fromkeys(each.part for each in known.measured.motors):
        if (bracket := bracket_of(known, motor, result)) is not None:
            result = {part: bracket if other == result[motor] else other for part, other in result.items()}
    return result


def _is_lever(known: Known, clamped: _Clamped, body: Mapping[str, str], ends: Sequence[tuple[str, CommonAxis]]) -> bool:
    """Tell whether one of two parts is in a ring of four: a pin beside the screw, or the end of a link without its
    screw, joins it with a third body, which a fourth one joins with the other part.

    Four hinges with parallel axes, or three and a slide, have one freedom; with the screw clamped they have none. A
    bracket that carries a lever is in a ring of five, and braced by one bar in one of three, which moves in no case.
    """
    axis = clamped.inner.one
    ties = {frozenset(body[part] for part in pair) for pair in (*known.touching, *(each.parts for each in known.axes))}
    for part in clamped.turning:
        own, other = body[part], body[clamped.host if part == clamped.part else clamped.part]
        pinned = (each for each in known.axes if not each.virtual and beside(each.one, axis))
        pinned = [*pinned, *(end for _, end in ends if beside(end.one, axis))]
        thirds = {owner for each in pinned for owner in _beyond(each.parts, own, body)} - {other}
        for third in thirds:
            fourth = {owner for tie in ties for owner in _beyond(tie, third, body)} - {own}
            if other not in fourth and any(frozenset((each, other)) in ties for each in fourth):
                return True
    return False


def _beyond(parts: Iterable[str], own: str, body: Mapping[str, str]) -> set[str]:
    """Find the body that a pair of parts joins with a given one; none where the pair does not join that."""
    owners = {body[part] for part in parts}
    return owners - {own} if own in owners else set()


def _is_leaf(clamped: _Clamped, found: Sequence[_Clamped], body: Mapping[str, str]) -> bool:
    """Tell whether two bodies are on another such screw with the same axis, as a leaf between the eyes of a door."""
    owners, axis = {body[clamped.part], body[clamped.host]}, clamped.inner.one
    return any(
        {body[each.part], body[each.host]} == owners
        and each.inner.one.part != axis.part
        and each.inner.one.on_axis_of(axis)
        for each in found
    )


def _hinge(clamped: _Clamped) -> str:
    """Write the hinge about a screw as a user would."""
    parts, screw = f"{clamped.part!r}, {clamped.host!r}", clamped.inner.one
    point, axis = (np.round(each, 6).tolist() for each in (screw.point, screw.axis))
    return f"jk.revolute('{clamped.part}-{clamped.host}', {parts}, point={point}, axis={axis})"


def _under_head(known: Known, stack: Stack, body: Mapping[str, str]) -> list[_Clamped]:
    """Find what lies on the head of a screw, and the part that the screw is tight in."""
    holes, result = _holes(known, stack), []
    tight = [pair for pair in _pairs(known, stack) if pair.clearance <= SAME_FIT * pair.other.radius]
    # a shaft has the form of a fastener, too, and a screw in its end clamps what lies on the shaft, or on its hub
    shafts = {part for part in stack.fasteners if not all(bore.hole for bore in known.bores[part])}
    for inner in (pair for pair in tight if pair.other.part in {*stack.held, *shafts}):
        screw, host = inner.parts
        for part, pair in holes.items():
            apart = body[part] != body[host] and pair.one.part == screw
            if apart and known.touches_across(part, stack.axis.axis, *stack.fasteners):
                flag = _is_flag(known, part, host, inner)
                washer = is_round_about(known, part, inner.one)
                if host in shafts and not washer:
                    continue
                hub = (name for name in known.names if body[name] == body[host] and name not in stack.fasteners)
                flat = _is_wide(pair) and any(
                    known.touches_only_across(part, each, inner.one.axis, pins=not flag)
                    for each in (host, *(hub if washer else ()))
                )
                if flat or _beside(known, part, host, inner, body):
                    why = f"{screw!r} is tight in {host!r}, and its head lies on {part!r}, through which it goes"
                    turning = () if flag or _is_core(known, inner.other) else (part,)
                    result.append(_Clamped(part, host, pair, inner, turning, why))
    return result


def _on_bolt(known: Known, stack: Stack, body: Mapping[str, str]) -> list[_Clamped]:
    """Find two parts, flat on each other, between the head of a bolt and its nut."""
    with_hole = [all(bore.hole for bore in known.bores[part]) for part in stack.fasteners]
    axis, own = stack.axis.axis, stack.fasteners
    holes = {part: pair for part, pair in _holes(known, stack).items() if known.touches_across(part, axis, *own)}
    if not any(with_hole) or all(with_hole) or len(holes) != 2 or not all(map(_is_wide, holes.values())):
        return []
    (part, through), (host, inner) = holes.items()
    if (
        body[part] == body[host]
        or through.one is not inner.one
        or not known.touches_only_across(part, host, inner.one.axis)
    ):
        return []
    why = f"{inner.one.part!r} and its nut hold {part!r} on {host!r}, through both of which it goes"
    return [_Clamped(part, host, through, inner, (part, host), why)]


def _pairs(known: Known, stack: Stack) -> list[CommonAxis]:
    return [pair for pair in known.axes if pair.one.part in stack.fasteners and not pair.virtual]


def _holes(known: Known, stack: Stack) -> dict[str, CommonAxis]:
    """Map each part that is held to the tightest of its holes that a screw is in."""
    pairs = sorted(_pairs(known, stack), key=lambda each: -each.clearance)
    tightest = {pair.other.part: pair for pair in pairs if pair.other.part in stack.held}
    return dict(sorted(tightest.items(), key=lambda item: known.order[item[0]]))


def _is_wide(pair: CommonAxis) -> bool:
    return pair.clearance >= THROUGH * pair.other.radius


def _is_flag(known: Known, part: str, host: str, inner: CommonAxis) -> bool:
    """Tell whether a part is a pin in a hole of the host of a screw, beside the screw."""
    pins = (pair for pair in known.axes if pair.parts == (part, host) and not pair.virtual)
    return any(beside(pair.one, inner.one) for pair in pins)


def _is_core(known: Known, hole: Bore) -> bool:
    """Tell whether a hole goes through a bar from end to end, many times as long as wide."""
    low, high = np.sort(hole.reach(hole.axis))
    ends = known.solids[hole.part].outermost @ hole.axis
    slack = SAME_LENGTH * hole.radius
    return bool(high - low >= CORE * hole.radius and low <= ends.min() + slack and high >= ends.max() - slack)


def _beside(known: Known, one: str, other: str, inner: CommonAxis, body: Mapping[str, str]) -> bool:
    """Tell whether the bodies of two parts have a second pin in a hole, beside a screw in a hole drilled for its
    thread."""
    owners = {body[one], body[other]}
    pins = (pair for pair in known.axes if not pair.virtual and {body[part] for part in pair.parts} == owners)
    return inner.threaded and any(beside(pair.one, inner.one) for pair in pins)
