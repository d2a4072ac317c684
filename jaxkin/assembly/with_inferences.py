"""The mechanism with what solids imply beside their exact contacts: conflicts are resolved by trying, and told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from jaxkin.assembly.caps import told_caps
from jaxkin.assembly.dropped_inference import with_count, with_note_of_dropped, without_weakest
from jaxkin.assembly.exact_fits import with_doubts
from jaxkin.assembly.guides import has_free_slide
from jaxkin.assembly.ignored_contacts import check_ignored
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.springs import DrawnSpring, springs
from jaxkin.assembly.lids import under_lids
from jaxkin.assembly.lifting_seats import lifting_seats
from jaxkin.assembly.meant_to_turn import with_turning
from jaxkin.assembly.resting import leaves_all_moving, leaves_bodies_moving, lifted_off, resting
from jaxkin.assembly.seats import is_on_one_plane, not_idle, seats_of, useful_freedoms
from jaxkin.assembly.tight_fits import tight_fits
from jaxkin.assembly.to_mechanism import MechanismOptions, detection_of
from jaxkin.assembly.trials import Trial, Trials
from jaxkin.assembly.undrawn_shafts import told_shafts
from jaxkin.contacts.contact import Contact
from jaxkin.joints.joint import Joint
from jaxkin.topology.bodies import body_of_parts

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
    trials = Trials(assembly, contacts, options, tubes)
    seats = [each.inference for each in tubes]
    trial = trials.make(seats)
    if not _moves(trial.mechanism) and (left := lifting_seats(trial.mechanism, trials.fasteners)):
        fewer = replace(detection_of(assembly, contacts), contacts=tuple(each for each in contacts if each not in left))
        if useful_freedoms(Trials(assembly, fewer, options, tubes).make(seats).mechanism):
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


_Held = tuple[list[Inference], Trial]
"""What is held beside what solids imply, and the mechanism that is the best so far."""


def _hold_all_but_lids(trials: Trials, seats: list[Inference], trial: Trial) -> _Held:
    """Hold bodies that lie on others, but for lids, where all else moves as before."""
    for held, rests in under_lids(trial.mechanism) if useful_freedoms(trial.mechanism) else ():
        other = trials.make([*seats, *held])
        if useful_freedoms(other.mechanism) and leaves_all_moving(trial.mechanism, other.mechanism, [*held, *rests]):
            # else all that lie may be held, with other seats
            return ([*seats, *held], other) if rests else (seats, trial)
    return seats, trial


def _hold_seated(trials: Trials, seats: list[Inference], trial: Trial) -> _Held:
    """Hold bodies that faces seat in or on others but for motions of no use, as long as that changes nothing else."""
    inexact = len(trial.inferences) > len(seats)
    bearings = {each.part.name for each in trials.measured.closed_bearings}
    for _ in range(_ROUNDS):
        new = seats_of(trial.mechanism, inexact, bearings, trials.driven)
        firm = [each for each in new if not is_on_one_plane(trial.mechanism, each)]
        # what lies on one plane only is the first to be no seat, as a knife that slides on its guards
        for some in [new, firm] if firm != new else [new]:
            if some and (other := _seated(trials, seats, trial, some)) is not None:
                break
        else:
            break
        seats, trial = [*seats, *some], other
    return seats, trial


def _seated(trials: Trials, seats: list[Inference], trial: Trial, new: list[Inference]) -> Trial | None:
    """Try some more seats; None where these change anything else."""
    other = trials.make([*seats, *new])
    # seats may take nothing of use; that slides can be stopped then which were not before is no objection; where
    # more is free with them, they changed which parts others hold, and stops would hide that
    fewer = other.before_stops <= trial.before_stops
    same = not_idle(other.mechanism) == not_idle(trial.mechanism) and fewer
    kept = (
        same
        or other.before_stops == trial.before_stops
        or leaves_all_moving(trial.mechanism, other.mechanism, new, but_slides=True)
    )
    return other if same or (kept and useful_freedoms(other.mechanism)) else None


def _hold_lying(trials: Trials, seats: list[Inference], trial: Trial) -> _Held:
    """Hold bodies that only lie on others, where all else moves as before; then those on one plane, where all other
    bodies still move."""
    lying = resting(trial.mechanism) if useful_freedoms(trial.mechanism) else []
    flat = [each for each in lying if is_on_one_plane(trial.mechanism, each)]
    all_together, one_by_one = _choices(lying)[:1], _choices(lying)[1:]
    for held in [*all_together, *([flat] if 0 < len(flat) < len(lying) else []), *one_by_one]:
        if held[0] in seats:
            continue  # with others
        other = trials.make([*seats, *held])
        if _moves_as_before(trial.mechanism, other.mechanism, held):
            seats, trial = [*seats, *held], other
        elif lifted_off(other.mechanism) and _moves_as_before(trials.lifted(trial), trials.lifted(other), held):
            return [*seats, *held], other._replace(lifts=True)
    for held in _choices([each for each in flat if each not in seats]):
        if held[0] in seats:
            break  # all are held together
        other = trials.make([*seats, *held])
        if useful_freedoms(other.mechanism) and leaves_bodies_moving(trial.mechanism, other.mechanism, held):
            seats, trial = [*seats, *held], other
    return seats, trial


def _hold_tight(trials: Trials, trial: Trial) -> Trial:
    """Hold parts that fit a pin exactly, and that no face keeps there, where all else moves as before."""
    before = trial.mechanism
    for held in _choices(tight_fits(before, trials.measured, trials.bearings)) if useful_freedoms(before) else ():
        if held[0] in trial.inferences:
            break  # all are held together
        other = trials.with_more(trial, held)
        if _moves_as_before(trial.mechanism, other.mechanism, held):
            trial = other
    return trial


def _moves_as_before(before: Mechanism, other: Mechanism, held: Sequence[Inference]) -> bool:
    """Tell whether all that moved still does in another mechanism, but for what is held there, and something does."""
    return bool(useful_freedoms(other)) and leaves_all_moving(before, other, held)


def _movable(trials: Trials, seats: Sequence[Inference], trial: Trial) -> Mechanism:
    """Find the mechanism with all its inferences counted; where these lock it, without the weakest that does."""
    mechanism, found = trial.mechanism, trial.inferences
    counted = with_count(mechanism, found)
    if trial.lifts or _moves(mechanism) or not found:
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
