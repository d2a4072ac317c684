"""The joints of two bodies that all joints and mates between them amount to, as an export or a robot's file says them.

What they allow together is one subgroup joint, a universal joint, or several joints side by side: then mates that are
one subgroup joint, two by two, become it, and mates that allow all that another one does are left out, so that as few
joints as can be are closed against each other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations, permutations
from typing import NamedTuple

from jaxkin.assembly.exported import Constraint
from jaxkin.joints.combine import Chain, includes, subgroup_joint
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import universal
from jaxkin.joints.regularise import Noise


class _Together(NamedTuple):
    """Constraints that one of them, or a subgroup joint, stands for."""

    stands: Constraint
    """The constraint, or the subgroup joint, with its name."""
    members: tuple[Constraint, ...]
    """All that it stands for."""


def joints_of_two(
    several: Sequence[Constraint], body: Mapping[str, str], noise: Noise, notes: list[str], whole: bool
) -> list[Joint]:
    """Make the joints of two bodies, with names that others may have too: with `whole` as few as can be.

    `body` maps parts to their bodies. What does not meet is added to the notes.
    """
    found = [_Together(each, (each,)) for each in several]
    if whole:
        if (single := _single(several, noise)) is not None:
            found = [single]
        elif (cross := _cross(several, noise)) is not None:
            return [replace(cross, evidence=evidence_of(several, notes, noise))]
        else:
            found = _fewest(found, body, noise)
    return [_joint(stands, evidence_of(members, notes, noise)) for stands, members in found]


def _joint(each: Constraint, evidence: Evidence) -> Joint:
    movements, frames = tuple(each.chain.movements), each.chain.frames
    return joint(each.name, each.parts, each.kind, movements, frames, each.pitch, evidence, each.limits)


def _single(several: Sequence[Constraint], noise: Noise) -> _Together | None:
    """Find the subgroup joint that constraints amount to; None if there is none."""
    found = subgroup_joint([each.chain for each in several], noise)
    if found is None:
        return None
    parts, chain = several[0].parts, Chain((found.movement,), found.frame[None])
    return _Together(Constraint("-".join(parts), parts, "", chain, found.kind), tuple(several))


def _fewest(found: list[_Together], body: Mapping[str, str], noise: Noise) -> list[_Together]:
    """Replace two by the subgroup joint that they amount to, or by the one that allows nothing else, as long as there
    are such two. What they allow together stays exactly the same."""
    for one, other in combinations(found, 2):
        both = _single((one.stands, other.stands), noise) or _stricter(one, other, body, noise)
        if both is not None:
            both = both._replace(members=(*one.members, *other.members))
            return _fewest([both if each is one else each for each in found if each is not other], body, noise)
    return found


def _stricter(one: _Together, other: _Together, body: Mapping[str, str], noise: Noise) -> _Together | None:
    """Find which of two allows only what the other one allows, too; None where neither does."""
    for strict, loose in permutations((one, other)):
        back = body[strict.stands.parts[0]] != body[loose.stands.parts[0]]
        if includes(loose.stands.chain, strict.stands.chain, noise, back):
            return strict
    return None


def _cross(several: Sequence[Constraint], noise: Noise) -> Joint | None:
    """Make the universal joint that a ball and two lines amount to that stay perpendicular; None if there is none."""
    for each in several:
        rest = [other.chain for other in several if other is not each]
        if not rest or each.kind is not JointKind.CONSTANT_ANGLE:
            continue
        axis1, axis2 = each.chain.frames[0, :3, 2], each.chain.frames[-1, :3, 2]
        ball = subgroup_joint(rest, noise)
        if ball is None or ball.kind is not JointKind.SPHERICAL or abs(float(axis1 @ axis2)) > noise.angle:
            continue
        axis2 = axis2 - (axis1 @ axis2) * axis1
        return universal("-".join(each.parts), *each.parts, point=ball.frame[:3, 3], axis1=axis1, axis2=axis2)
    return None


def evidence_of(several: Sequence[Constraint], notes: list[str], noise: Noise) -> Evidence:
    """Tell what a joint is known from."""
    return Evidence(EvidenceKind.EXPORT, apart(several, notes, noise), told(several))


def apart(several: Sequence[Constraint], notes: list[str], noise: Noise) -> tuple[tuple[str, float], ...]:
    """Measure how far axes and features of the two sides do not meet; where they do not, a note has the sizes."""
    offset, tilt = max(each.offset for each in several), max(each.tilt for each in several)
    if offset <= noise.length and tilt <= noise.angle:
        return ()
    parts = " and ".join(map(repr, several[0].parts))
    welds = all(each.kind is JointKind.FIXED for each in several)
    taken = "the two stay where they are" if welds else f"taken as it stands on {several[0].parts[0]!r}"
    notes.append(
        f"{told(several)} between {parts}: its two sides are {offset:.2g} and {tilt:.2g} rad apart as exported; {taken}"
    )
    return (("offset", offset), ("tilt", tilt))


def told(several: Sequence[Constraint]) -> str:
    """List what the file calls constraints, each once."""
    return " and ".join(dict.fromkeys(each.text for each in several))
