"""Mechanisms of one assembly that are tried, each with some bodies held to each other beside what its solids imply."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from jaxkin.assembly.ignored_contacts import check_ignored, without
from jaxkin.assembly.inference.infer import infer
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.springs import DrawnSpring
from jaxkin.assembly.resting import lifted_off
from jaxkin.assembly.seats import not_idle, useful_freedoms
from jaxkin.assembly.to_mechanism import MechanismOptions, detection_of, make_mechanism
from jaxkin.contacts.contact import Contact
from jaxkin.topology.bodies import bodies

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.mechanism.mechanism import Mechanism


class Trial(NamedTuple):
    """A mechanism that is tried."""

    mechanism: Mechanism
    inferences: list[Inference]
    before_stops: int
    """Number of its freedoms that are not idle before slides are stopped: see `not_idle`."""
    lifts: bool = False
    """Whether all that may lock it is a follower on the dwell of its cam: see `lifted_off`."""


class Trials:
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
        self.heeded = set[BodyPair]()
        """Those of `ignored` for which some inference was left out."""
        self.measured = assembly._measured
        self.bearings = {name for each in self.measured.bearings for name in (each.outer, each.inner)}
        self.bearings |= {each.part.name for each in self.measured.closed_bearings}
        """The rings of bearings, and bearings that are one part each."""
        self.driven = set[BodyPair]()
        """Motors that are one part with their shaft, each with a hub on that."""
        self.fasteners = set[str]()
        """Parts that were taken for fasteners in some trial."""

    def make(self, seats: Sequence[Inference], apart: Sequence[BodyPair] = ()) -> Trial:
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
        self.driven.update(implied.driven)
        found = [*seats, *implied.found]
        plain = make_mechanism(self.assembly, self.contacts, options, found)
        return Trial(*self._stopped(plain, found, implied.stops), not_idle(plain))

    def with_more(self, trial: Trial, held: Sequence[Inference]) -> Trial:
        """Make the mechanism with all that is inferred already, and some parts held beside it: nothing else is inferred
        anew, as it would be of parts that `make` takes for one body from the beginning."""
        found = _without_inner(self.assembly, self.options, [*trial.inferences, *held])
        made = make_mechanism(self.assembly, self.contacts, self.options, found)
        return Trial(made, found, trial.before_stops)

    def lifted(self, trial: Trial) -> Mechanism:
        """Make the mechanism of a trial with what only touches lifted off."""
        options = self.options._replace(joints=(*self.options.joints, *lifted_off(trial.mechanism)))
        return make_mechanism(self.assembly, self.contacts, options, trial.inferences)

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


def _without_inner(assembly: Assembly, options: MechanismOptions, found: Sequence[Inference]) -> list[Inference]:
    """Leave out joints of parts that are one body by other inferences."""
    groups = [each.parts for each in found if each.joint is None]
    body = bodies(assembly.names, options.fixed, [*options.rigid, *groups])
    return [each for each in found if each.joint is None or len({body[part] for part in each.parts}) > 1]
