"""What a user may fix and drive: choices are tried, and ranked by what the mechanism then does."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from jaxkin.assembly.dropped_inference import DROPPED
from jaxkin.assembly.taken_back import taken_back
from jaxkin.assembly.wheels import wheels_last, wheels_of
from jaxkin.geometry.part import Part, heaviest
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.mobility.open_loops import opening
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.mechanism.mechanism import Mechanism

TRIED = 3
"""Parts that are tried alone as the fixed one: a mechanism of 175 parts takes four seconds, and what is fixed in an
assembly that a person drew is among its largest or best connected bodies."""
MIN_MOVING = 0.5
"""Joints that move with several fixed parts over those that move with one, at least: brackets on a wall close loops and
leave most joints moving (lift table: all of 7), the fixed ends of a machine with tools and wheels leave one of 8."""
UNLOCKED = 5
"""Proposals at most that take back an inference."""
_TOLD = 5
"""Coordinates that a proposal tells: without a fixed frame an assembly of 175 parts has 18 of them, a screen full."""


@dataclass(frozen=True)
class Proposal:
    """Parts to fix and coordinates to drive, with what that achieves."""

    fixed: tuple[str, ...]
    drive: tuple[str, ...]
    """Coordinates "joint.coordinate" that determine the motion together; none where nothing can be driven."""
    freedoms: int
    """Freedoms that are of use."""
    bodies: int
    """Bodies that the parts make, the fixed one among them."""
    moving: int
    """Joints that the drive moves."""
    problem: str = ""
    """Why nothing can be driven; empty where something can."""
    wheels: tuple[str, ...] = ()
    """Those of `drive` that only turn a wheel or a roller, which moves nothing else; they come last in it."""
    ignore: tuple[tuple[str, str], ...] = ()
    """Pairs of parts of which something was inferred that is to be taken back, as in `mechanism(ignore=...)`."""

    def __str__(self) -> str:
        return self.told(())

    def told(self, others: Sequence[Proposal]) -> str:
        """Tell the proposal in one line, with the parts of `others` that have the same effect."""
        if self.ignore:
            told = " or ".join(repr([list(pair) for pair in each.ignore]) for each in (self, *others))
            lines = f"fixed = {list(self.fixed)!r} and ignore = {told}"
        else:
            lines = f"fixed = {list(self.fixed)!r}" + "".join(f" or {list(each.fixed)!r}" for each in others)
        if self.problem:
            return f"with {lines}: {self.problem}"
        count = "one freedom" if self.freedoms == 1 else f"{self.freedoms} freedoms"
        told = [repr(name) for name in self.drive]
        more = len(told) - _TOLD
        names = " and ".join(told) if more <= 0 else f"{', '.join(told[:_TOLD])} and {more} more"
        moves = "one joint moves" if self.moving == 1 else f"{self.moving} joints move"
        only = "one of which only turns a wheel or a roller"
        only = only if len(self.wheels) == 1 else f"{len(self.wheels)} of which only turn wheels or rollers"
        spin = f", {only}" if self.wheels else ""
        return f"with {lines} it has {count} in {self.bodies} bodies{spin}, and {names} can be driven; {moves}"


def grouped(found: Sequence[Proposal]) -> list[str]:
    """Tell proposals, those of the same effect in one line, each where the first of them comes."""
    alike: dict[tuple, list[Proposal]] = {}
    for each in found:
        effect = (each.drive, each.freedoms, each.bodies, each.moving, each.problem, each.ignore and each.fixed)
        alike.setdefault(effect, []).append(each)
    return [first.told(others) for first, *others in alike.values()]


def proposals(
    assembly: Assembly,
    fixed: Sequence[str] | None = None,
    drive: Sequence[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Proposal, ...]:
    """Try what to fix and what to drive; the proposals that achieve most come first.

    `fixed` are the parts to fix, by default each of a few that may be meant: those of the bodies that are large and
    joined to many others. `drive` are coordinates that are driven, by default those which leave nothing but idle
    motions. One freedom comes before several, those of wheels not counted, more joints that move before fewer, and what
    cannot move comes last.
    Of choices that are alike otherwise the heaviest body is fixed: frames weigh more than what they carry.
    Several fixed parts come after single ones unless they leave one freedom, and most of what moves with one: others
    are no brackets on a wall, but what the machine moves, as the hook and the wheels of a crane.
    Where nothing can move, inferences are taken back in turn: see `unlocked`.
    `progress(done, total)` is called after each choice that was tried, where `fixed` leaves several.

    Raises ValueError for names that do not exist, and for an assembly without parts.
    """

    def ignoring(fixed: Sequence[str]) -> Callable[[tuple[str, str]], Mechanism]:
        return lambda pair: assembly.mechanism(fixed=fixed, ignore=[pair])

    if fixed is not None:
        mechanism = assembly.mechanism(fixed=fixed)
        return (_tried(mechanism, fixed, drive), *unlocked(mechanism, ignoring(fixed), fixed, drive))
    solids = {part.name: part for part in assembly.parts}
    if not solids:
        raise ValueError(f"{assembly.source}: there are no parts, and nothing to fix")
    base = max(solids, key=lambda name: _size(solids[name]))
    mechanism = assembly.mechanism(fixed=[base])
    if (tied := _tied(mechanism)) and base not in tied:
        base = max(tied, key=lambda name: _size(solids[name]))
        mechanism = assembly.mechanism(fixed=[base])
    others = [part for part in _likely(mechanism, solids) if part not in mechanism.fixed]
    choices = [[part] for part in others[: TRIED - 1]] + _with_ends(mechanism, solids)
    found = []
    for done, choice in enumerate(([base], *choices), start=1):
        made = assembly.mechanism(fixed=choice)
        if len(choice) == 1 or not any(note.startswith(DROPPED) for note in made.history):
            found.append(_tried(made, choice, drive))  # else the ends are none: fixed, they lock what moves
        if progress:
            progress(done, 1 + len(choices))
    if found[0].problem:
        found += unlocked(mechanism, ignoring([base]), [base], drive)
    most = max(each.moving for each in found if len(each.fixed) == 1)

    owner = body_of_parts(mechanism.bodies)

    def rank(each: Proposal) -> tuple[bool, bool, bool, int, int, int, float]:
        # wheels alone are as good as one freedom, and no better than one beside them
        several, useful = len(each.fixed) > 1, max(1, each.freedoms - len(each.wheels))
        stills = several and (useful > 1 or each.moving < MIN_MOVING * most)
        weight = sum(abs(solids[part].volume) for part in mechanism.bodies[owner[each.fixed[0]]])
        still = bool(each.problem) or not each.moving
        return still, bool(each.ignore), stills, useful, len(each.fixed), -each.moving, -weight

    return tuple(sorted(found, key=rank))


def _tied(mechanism: Mechanism) -> list[str]:
    """Name the parts that something ties to others: a cover that is drawn away from all else is only near to them."""
    ties = [each.parts for some in mechanism.contacts.values() for each in some]
    ties += [each.parts for each in mechanism.all_joints if not _is_guess(each.evidence)]
    ties += [each.parts for each in mechanism.bonds if not _is_guess(each.evidence)]
    tied = {part for parts in ties for part in parts}
    return [part for part in mechanism.parts if part in tied]


def _is_guess(evidence: Evidence | None) -> bool:
    """Tell whether parts are tied only since they are near to each other, or left at rest."""
    return evidence is not None and evidence.kind is EvidenceKind.NEAREST


def _with_ends(mechanism: Mechanism, solids: Mapping[str, Part]) -> list[list[str]]:
    """Find the fixed part with the bodies that only one other one holds, and these alone: brackets on a wall not
    drawn."""
    if not mechanism.fixed:
        return []
    owner = body_of_parts(mechanism.bodies)
    around: dict[str, set[str]] = {}
    for one, other in ([owner[part] for part in joint.parts] for joint in mechanism.all_joints if joint.freedoms):
        around.setdefault(one, set()).add(other)
        around.setdefault(other, set()).add(one)
    turning = {owner[part] for part in wheels_of(mechanism).values()}
    ends = [body for body, others in around.items() if len(others) == 1 and body != owner[mechanism.fixed[0]]]
    ends = [body for body in ends if body not in turning]
    parts = [heaviest(mechanism.bodies[body], solids) for body in ends]
    base = heaviest(mechanism.fixed, solids)
    alone = [parts] if len(parts) > 1 else []
    return [[base, *parts], *alone] if parts and len(around) > 2 else []


def _likely(mechanism: Mechanism, solids: Mapping[str, Part]) -> list[str]:
    """Find the heaviest part of each body, those of large and well connected bodies first."""
    owner = body_of_parts(mechanism.bodies)
    joined = Counter(owner[part] for joint in mechanism.all_joints if joint.freedoms for part in joint.parts)
    size = {body: max(solids[part].extent for part in parts) for body, parts in mechanism.bodies.items()}
    order = sorted(size, key=lambda body: joined[body] * size[body], reverse=True)
    return [heaviest(mechanism.bodies[body], solids) for body in order]


def _size(part: Part) -> tuple[float, float]:
    """Measure how large a part is: long, and not thin as a rod or a long screw, which fastens nothing while it is
    fixed; shells without a volume come by their length."""
    extent = part.extent
    return extent * abs(part.volume) ** (1 / 3), extent


def _tried(mechanism: Mechanism, choice: Sequence[str], drive: Sequence[str] | None) -> Proposal:
    """Tell what a mechanism does, driven by some coordinates or by those that its mobility names."""
    fixed, bodies = tuple(choice), len(mechanism.bodies)
    if opening(mechanism.linkage, mechanism.unit) is not None:
        return Proposal(fixed, (), 0, bodies, 0, "its loops are open as it is drawn; see mechanism.close()")
    mobility = mechanism.mobility()
    if not mobility.useful:
        structure = ": all parts are one body" if bodies == 1 < len(mechanism.parts) else ""
        return Proposal(fixed, (), 0, bodies, 0, f"nothing can move{structure}")
    turning = wheels_of(mechanism)
    driven = tuple(drive if drive is not None else wheels_last(mechanism))
    plan = mechanism.plan(driven)
    if drive is not None and plan.notes:
        return Proposal(fixed, (), mobility.useful, bodies, 0, "; ".join(plan.notes))
    wheels = tuple(name for name in driven if name in turning)
    return Proposal(fixed, driven, mobility.useful, bodies, _moved(mechanism), wheels=wheels)


def unlocked(
    mechanism: Mechanism,
    without: Callable[[tuple[str, str]], Mechanism],
    fixed: Sequence[str],
    drive: Sequence[str] | None = None,
) -> list[Proposal]:
    """Find what takes back an inference of a mechanism in which nothing can move, so that something can: at most
    `UNLOCKED`, one freedom before several.

    `without` makes the mechanism that ignores what is between two parts.
    """
    if opening(mechanism.linkage, mechanism.unit) is not None or mechanism.mobility().useful:
        return []
    found = [replace(_tried(other, fixed, drive), ignore=(pair,)) for pair, other in taken_back(mechanism, without)]
    moving = [each for each in found if not each.problem]
    return sorted(moving, key=lambda each: (each.freedoms, -each.moving))[:UNLOCKED]


def _moved(mechanism: Mechanism) -> int:
    """Count the joints with freedoms that are not idle."""
    idle = {*mechanism.mobility().idle}
    return sum(not idle.issuperset(joint.full_names) for joint in mechanism.all_joints)
