"""The mechanism with what solids imply beside their exact contacts: conflicts are resolved by trying, and told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from jaxkin.assembly.caps import told_caps
from jaxkin.assembly.dropped_inference import with_count, with_note_of_dropped, without_weakest
from jaxkin.assembly.exact_fits import with_doubts
from jaxkin.assembly.guides import has_free_slide
from jaxkin.assembly.ignored_contacts import check_ignored, without
from jaxkin.assembly.inference.infer import infer
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known, Pair
from jaxkin.assembly.inference.springs import DrawnSpring, springs
from jaxkin.assembly.lids import under_lids
from jaxkin.assembly.lifting_seats import lifting_seats
from jaxkin.assembly.meant_to_turn import with_turning
from jaxkin.assembly.resting import leaves_all_moving, resting
from jaxkin.assembly.seats import is_on_one_plane, seats_of, useful_freedoms
from jaxkin.assembly.tight_fits import tight_fits
from jaxkin.assembly.to_mechanism import MechanismOptions, detection_of, make_mechanism
from jaxkin.assembly.undrawn_shafts import told_shafts
from jaxkin.contacts.contact import Contact
from jaxkin.joints.joint import Joint
from jaxkin.topology.bodies import bodies, body_of_parts

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.mechanism.mechanism import Mechanism

_ROUNDS = 3
"""Times that seats are looked for: what is one body by some may be seated on others."""
_ONE_BY_ONE = 6
"""Bodies that are held to others one by one, where not all can be held together."""


def with_inferences(assembly: Assembly, contacts: Sequence[Contact], options: MechanismOptions) -> Mechanism:
    """Make the mechanism with what solids imply beside their exact contacts.

    Tubes that may be springs are taken for such where the parts at their ends move on each other then; otherwise a
    screw clamps these, and the tube is a spacer.
    """
    words = [*options.rigid, *options.ignored, *(each.parts for each in options.joints)]
    by_hand = {*options.fixed, *(part for group in words for part in group)}
    tubes = springs(assembly._measured, contacts, options.fixed, by_hand)
    made = _with_springs(assembly, contacts, options, tubes)
    body = body_of_parts(made.bodies)
    pushing = [each for each in tubes if body.get(each.seat, each.seat) != body.get(each.pushed, each.pushed)]
    return made if pushing == tubes else _with_springs(assembly, contacts, options, pushing)


def _with_springs(
    assembly: Assembly, contacts: Sequence[Contact], options: MechanismOptions, tubes: Sequence[DrawnSpring]
) -> Mechanism:
    """Make the mechanism with what solids imply, and some tubes as springs.

    What would stop slides that exact contacts allow is taken only where these slides are of use otherwise, so that the
    mechanism has fewer freedoms but still some; where all of it leaves none, without the least sure of it. Bodies that
    seats of faces leave a slide of no use are one body, and so are those that only lie on each other, where all that
    moves still does then. Where the inferences lock it, the weakest one without which it moves is dropped, and that is
    said. Valves leave their seats before, where nothing moves else.
    """
    trials = _Trials(assembly, contacts, options, tubes)
    seats = [each.inference for each in tubes]
    trial = trials.make(seats)
    if not _moves(trial.mechanism) and (left := lifting_seats(trial.mechanism, trials.fasteners)):
        fewer = replace(detection_of(assembly, contacts), contacts=tuple(each for each in contacts if each not in left))
        if useful_freedoms(_Trials(assembly, fewer, options, tubes).make(seats).mechanism):
            lifted = _with_springs(assembly, fewer, options, tubes)
            return replace(lifted, history=(*left.values(), *lifted.history))
    seats, trial = _hold_all_but_lids(trials, seats, trial)
    seats, trial = _hold_seated(trials, seats, trial)
    seats, trial = _hold_lying(trials, seats, trial)
    trial = _hold_tight(trials, trial)
    check_ignored(contacts, options.ignore, trials.heeded)
    found = with_doubts(_movable(trials, seats, trial), trials.bearings)
    found = with_turning(found, trials.measured, trials.bearings)
    taken_back = [
        f"nothing is inferred between {one!r} and {other!r}, as was asked for"
        for one, other in options.ignored
        if frozenset((one, other)) in trials.heeded
    ]

    def with_joint(joint: Joint) -> Mechanism:
        return _with_springs(assembly, contacts, options._replace(joints=(*options.joints, joint)), tubes)

    shafts = told_shafts(found, assembly._measured.bores, with_joint)
    return replace(found, history=(*told_caps(found), *shafts, *taken_back, *found.history))


class _Trial(NamedTuple):
    """A mechanism that is tried."""

    mechanism: Mechanism
    inferences: list[Inference]
    before_stops: int
    """Number of its freedoms that are not idle before slides are stopped: see `_not_idle`."""


class _Trials:
    """Makes mechanisms of one assembly, each with some bodies held to each other beside what its solids imply."""

    def __init__(
        self, assembly: Assembly, contacts: Sequence[Contact], options: MechanismOptions, tubes: Sequence[DrawnSpring]
    ) -> None:
        self.assembly, self.options = assembly, options
        source = detection_of(assembly, contacts)
        used = replace(source, contacts=without(contacts, options.ignored))
        asked = {frozenset(pair) for pair in options.ignored if {*pair} <= {*assembly.names}}
        ignored = asked | {frozenset(contact.parts) for contact in contacts if contact not in used.contacts}
        check_ignored(contacts, options.ignore, asked)
        self.springs = {each.part for each in tubes}
        if tubes:  # nothing is inferred of a spring but its seat
            names = assembly.names
            ignored |= {frozenset((each.part, other)) for each in tubes for other in names if other != each.seat}
            used, contacts = (
                replace(source, contacts=tuple(each for each in some if not self.springs & {*each.parts}))
                for some in (used, contacts)
            )
        self.contacts = contacts
        """All but those of springs."""
        self.used = used
        """Those of `contacts` that the user does not ignore, from which is inferred."""
        self.ignored = ignored
        """Pairs of parts between which nothing is inferred."""
        self.heeded = set[Pair]()
        """Those of `ignored` for which some inference was left out."""
        self.measured = assembly._measured
        self.bearings = {name for each in self.measured.bearings for name in (each.outer, each.inner)}
        self.bearings |= {each.part.name for each in self.measured.closed_bearings}
        """The rings of bearings, and bearings that are one part each."""
        self.fasteners = set[str]()
        """Parts that were taken for fasteners in some trial."""

    def make(self, seats: Sequence[Inference], apart: Sequence[Pair] = ()) -> _Trial:
        """Make the mechanism with its inferences and `seats`; no pair of parts in `apart` is one body."""
        options = self.options
        rigid = [*options.rigid, *(each.parts for each in seats)]
        known = Known(
            self.measured,
            self.used,
            options.fixed,
            rigid,
            options.joints,
            ignored=self.ignored,
            clearance=options.clearance,
            apart=apart,
            springs=self.springs,
        )
        implied = infer(known)
        self.fasteners.update(implied.fasteners)
        self.heeded.update(implied.taken_back)
        found = [*seats, *implied.found]
        plain = make_mechanism(self.assembly, self.contacts, options, found)
        return _Trial(*self._stopped(plain, found, implied.stops), _not_idle(plain))

    def with_more(self, trial: _Trial, held: Sequence[Inference]) -> _Trial:
        """Make the mechanism with all that is inferred already, and some parts held beside it: nothing else is inferred
        anew, as it would be of parts that `make` takes for one body from the beginning."""
        found = _without_inner(self.assembly, self.options, [*trial.inferences, *held])
        made = make_mechanism(self.assembly, self.contacts, self.options, found)
        return _Trial(made, found, trial.before_stops)

    def _stopped(
        self, mechanism: Mechanism, found: list[Inference], levels: Sequence[Sequence[Inference]]
    ) -> tuple[Mechanism, list[Inference]]:
        """Find the mechanism that stops slides, and its inferences, from the `mechanism` without stops: with as many
        levels of what would stop them as leave it freedoms, if these are fewer then, or those of parts that only spin
        are."""
        useful, turning = (useful_freedoms(mechanism), mechanism.mobility().spins) if any(levels) else (0, 0)
        for count in range(len(levels), 0, -1) if useful + turning else ():
            if not levels[count - 1]:
                continue
            stops = [each for level in levels[:count] for each in level]
            names = {each.joint.name for each in stops if each.joint}  # they take the places of joints that slide
            rest = [each for each in found if not (each.joint and each.joint.name in names)]
            more = _without_inner(self.assembly, self.options, [*rest, *stops])
            other = make_mechanism(self.assembly, self.contacts, self.options, more)
            fewer, spins = useful_freedoms(other), other.mobility().spins
            if 0 < fewer < useful or (fewer == useful and fewer + spins > 0 and spins < turning):
                return other, more
        return mechanism, found


_Held = tuple[list[Inference], _Trial]
"""What is held beside what solids imply, and the mechanism that is the best so far."""


def _hold_all_but_lids(trials: _Trials, seats: list[Inference], trial: _Trial) -> _Held:
    """Hold bodies that lie on others, but for lids, where all else moves as before."""
    for held, rests in under_lids(trial.mechanism) if useful_freedoms(trial.mechanism) else ():
        other = trials.make([*seats, *held])
        if useful_freedoms(other.mechanism) and leaves_all_moving(trial.mechanism, other.mechanism, [*held, *rests]):
            # else all that lie may be held, with other seats
            return ([*seats, *held], other) if rests else (seats, trial)
    return seats, trial


def _hold_seated(trials: _Trials, seats: list[Inference], trial: _Trial) -> _Held:
    """Hold bodies that faces seat in or on others but for motions of no use, as long as that changes nothing else."""
    inexact = len(trial.inferences) > len(seats)
    bearings = {each.part.name for each in trials.assembly._measured.closed_bearings}
    for _ in range(_ROUNDS):
        new = seats_of(trial.mechanism, inexact, bearings)
        firm = [each for each in new if not is_on_one_plane(trial.mechanism, each)]
        # what lies on one plane only is the first to be no seat, as a knife that slides on its guards
        for some in [new, firm] if firm != new else [new]:
            if some and (other := _seated(trials, seats, trial, some)) is not None:
                break
        else:
            break
        seats, trial = [*seats, *some], other
    return seats, trial


def _seated(trials: _Trials, seats: list[Inference], trial: _Trial, new: list[Inference]) -> _Trial | None:
    """Try some more seats; None where these change anything else."""
    other = trials.make([*seats, *new])
    # seats may take nothing of use; that slides can be stopped then which were not before is no objection; where
    # more is free with them, they changed which parts others hold, and stops would hide that
    fewer = other.before_stops <= trial.before_stops
    same = _not_idle(other.mechanism) == _not_idle(trial.mechanism) and fewer
    kept = (
        same
        or other.before_stops == trial.before_stops
        or leaves_all_moving(trial.mechanism, other.mechanism, new, but_slides=True)
    )
    return other if same or (kept and useful_freedoms(other.mechanism)) else None


def _hold_lying(trials: _Trials, seats: list[Inference], trial: _Trial) -> _Held:
    """Hold bodies that only lie on others, where all else moves as before."""
    for held in _choices(resting(trial.mechanism)) if useful_freedoms(trial.mechanism) else ():
        if held[0] in seats:
            break  # all are held together
        other = trials.make([*seats, *held])
        if _moves_as_before(trial, other, held):
            seats, trial = [*seats, *held], other
    return seats, trial


def _hold_tight(trials: _Trials, trial: _Trial) -> _Trial:
    """Hold parts that fit a pin exactly, and that no face keeps there, where all else moves as before."""
    before = trial.mechanism
    for held in _choices(tight_fits(before, trials.measured, trials.bearings)) if useful_freedoms(before) else ():
        if held[0] in trial.inferences:
            break  # all are held together
        other = trials.with_more(trial, held)
        if _moves_as_before(trial, other, held):
            trial = other
    return trial


def _moves_as_before(trial: _Trial, other: _Trial, held: Sequence[Inference]) -> bool:
    """Tell whether all that moved still does in another mechanism, but for what is held there, and something does."""
    return bool(useful_freedoms(other.mechanism)) and leaves_all_moving(trial.mechanism, other.mechanism, held)


def _movable(trials: _Trials, seats: Sequence[Inference], trial: _Trial) -> Mechanism:
    """Find the mechanism with all its inferences counted; where these lock it, without the weakest that does."""
    mechanism, found = trial.mechanism, trial.inferences
    counted = with_count(mechanism, found)
    if _moves(mechanism) or not found:
        return counted
    unlocked, dropped = without_weakest(
        trials.assembly, trials.contacts, trials.options, found, mechanism, trials.fasteners
    )
    counted = unlocked or counted
    if dropped is not None and dropped.joint is None:
        # what is a body no longer may be a joint: a lever on a pin with play
        kept = [each for each in seats if each is not dropped]
        other = trials.make(kept, [frozenset((dropped.parts[0], part)) for part in dropped.parts[1:]])
        if 0 < useful_freedoms(other.mechanism) < useful_freedoms(counted):
            counted = with_note_of_dropped(dropped, with_count(other.mechanism, other.inferences))
    return counted


def _moves(mechanism: Mechanism) -> bool:
    """Tell whether a mechanism has a freedom of use, or a slide whose drive alone is missing."""
    return bool(useful_freedoms(mechanism)) or has_free_slide(mechanism)


def _choices(found: Sequence[Inference]) -> list[Sequence[Inference]]:
    """List what is tried of bodies that may be held: all together, then one after another, of a few."""
    return [found, *([each] for each in found[:_ONE_BY_ONE])] if len(found) > 1 else [found] if found else []


def _not_idle(mechanism: Mechanism) -> int:
    """Count the freedoms that are not idle, those of parts that only spin included; 0 where none is of use."""
    return useful_freedoms(mechanism) and mechanism.mobility().useful + mechanism.mobility().spins


def _without_inner(assembly: Assembly, options: MechanismOptions, found: Sequence[Inference]) -> list[Inference]:
    """Leave out joints of parts that are one body by other inferences."""
    groups = [each.parts for each in found if each.joint is None]
    body = bodies(assembly.names, options.fixed, [*options.rigid, *groups])
    return [each for each in found if each.joint is None or len({body[part] for part in each.parts}) > 1]
