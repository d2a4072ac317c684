"""Why a mechanism cannot move: the contacts, or joints by hand, without which it could.

Faces that touch in the modelled pose only (end stops, covers) break assumption 4 of the paper, and one of them is
enough to block a whole mechanism. Which of several is the wrong one cannot be known: those come first that look like
it. Each is left out and the mechanism found anew before it is named.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin.assembly.to_mechanism import all_contacts, without_contacts
from jaxkin.contacts.contact import Contact
from jaxkin.joints.from_contacts import UNCLEAR_MARGIN, joints_from_contacts
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.twists import Twists, middle, twists
from jaxkin.topology.bodies import bodies

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

MAX_LISTED = 8
"""Ways out that are looked for at most: more are not read."""
MAX_LISTED_OF_LARGE = 3
"""The same of mechanisms of more than `LARGE_MECHANISM` joints: to find each of these anew takes seconds."""
LARGE_MECHANISM = 40
_TRIALS_PER_LISTED = 3
"""Ways that are tried at most for each that is looked for."""
_MOVING_RATIO = 1e-6
"""Twist of a part over the largest of all, above which it moves."""
_EXACT_MISFIT = 1e-5
"""Misfit of a contact over the extent of the joints; those of exact models are smaller."""
_FIT_STATES = ("e", "k", "o")
"""States in which one surface is all around the other: what hinges, seats and balls are drawn for."""


@dataclass(frozen=True)
class BlockingContacts:
    """Something to leave out, and what can move then."""

    what: tuple[Contact | str, ...]
    """A contact, or several of two parts; the names of joints by hand."""
    freedoms: int
    """How many the mechanism has then, but for idle ones and those of parts that only spin."""
    parts: tuple[str, ...]
    """The parts that move then."""
    between: tuple[str, str]
    """The two parts that it is between."""

    def __str__(self) -> str:
        said = [str(entry) if isinstance(entry, Contact) else f"joint {entry!r}" for entry in self.what]
        freedoms = f"{self.freedoms} freedom{'' if self.freedoms == 1 else 's'}"
        return f"{' and '.join(said)}: then {freedoms}, moving {', '.join(self.parts)}"


class _Way(NamedTuple):
    """A `BlockingContacts` that was not tried yet."""

    rank: tuple
    found: BlockingContacts


def blocking_contacts(mechanism: Mechanism) -> tuple[BlockingContacts, ...]:
    """Single contacts or joints by hand without which parts of the mechanism could move; if there is none, the fewest
    contacts of two parts. Those first that are more likely to be wrong, some `MAX_LISTED` at most, all of them tried.

    Contacts are taken one by one here, however they were combined. Those of a joint by hand come last; before them
    those that are exact, and those of fits: faces that touch by chance are plane, and alone between their parts.
    """
    judged = _ContactJudgement.of(mechanism)
    ways = [way for k in range(len(judged.joints)) if (way := judged.way([k]))]
    if not ways:
        ways = [way for some in judged.fewest() if (way := judged.way(some))]
    ways.sort(key=lambda way: way.rank)
    listed = MAX_LISTED if len(mechanism.all_joints) <= LARGE_MECHANISM else MAX_LISTED_OF_LARGE
    before = mechanism.mobility().useful
    found: list[BlockingContacts] = []
    for _, way in ways[: _TRIALS_PER_LISTED * listed]:
        if (tried := _tried(mechanism, way, before)) is not None:
            found.append(tried)
        if len(found) == listed:
            break
    return tuple(found)


def _tried(mechanism: Mechanism, way: BlockingContacts, before: int) -> BlockingContacts | None:
    """The freedoms of the mechanism that is found without some contacts; None where they are no more than before."""
    try:
        freedoms = without_contacts(mechanism, way.what).mobility().useful
    except ValueError:  # a part hangs on nothing then
        return None
    return replace(way, freedoms=freedoms) if freedoms > before else None


class _ContactJudgement(NamedTuple):
    """The contacts and joints by hand of a mechanism at first order, at its assembled pose."""

    joints: Sequence[Joint]
    """One a contact."""
    what: Sequence[Contact | str]
    body_of: Mapping[str, str]
    system: Twists
    resting: frozenset[str]
    """Parts that only spin."""
    size: float

    @staticmethod
    def of(mechanism: Mechanism) -> _ContactJudgement:
        """Those of a mechanism, and those that its parts that only spin would have."""
        contacts = all_contacts(mechanism)
        by_hand = [joint for joint in mechanism.all_joints if joint.name not in mechanism.contacts]
        found = joints_from_contacts(contacts, mechanism.parts, combine=False)
        ties = [joint.parts for joint in by_hand if joint.kind == JointKind.FIXED]
        body_of = bodies(mechanism.parts, mechanism.fixed, ties)
        joints: list[Joint] = [*found.joints, *(joint for joint in by_hand if joint.kind != JointKind.FIXED)]
        source = {name: some[0] for name, some in found.contacts.items()}
        what = [source.get(joint.name, joint.name) for joint in joints]
        system = twists(joints, body_of, body_of[mechanism.fixed[0]])
        return _ContactJudgement(
            joints,
            what,
            body_of,
            system,
            frozenset(part.name for part in mechanism.linkage.spinning),
            middle(joints)[1],
        )

    def way(self, removed: Sequence[int]) -> _Way | None:
        """What is gained without some joints, unless it is nothing but parts that only spin."""
        rows = self.system.rows(removed)
        gained = self.system.freed(rows)
        if not len(gained):
            return None
        strength = np.abs(gained).max(axis=(0, 2))
        moving = {
            b for b, moves in zip(self.system.bodies, strength > _MOVING_RATIO * strength.max(), strict=True) if moves
        }
        parts = tuple(part for part in self.body_of if self.body_of[part] in moving)
        if self.resting.issuperset(parts):
            return None
        what = tuple(self.what[k] for k in removed)
        found = BlockingContacts(what, len(gained), parts, self.joints[removed[0]].parts)
        margin = self.system.strength(rows, gained)
        return _Way((*self._likely_right(removed, margin), len(gained), -len(parts)), found)

    def _likely_right(self, removed: Sequence[int], margin: float) -> tuple[int, ...]:
        """What speaks for some joints being meant as they are, the weightiest first."""
        contacts = [self.what[k] for k in removed]
        first = contacts[0]
        if not isinstance(first, Contact):
            return (1,) * 5
        others = sum(set(joint.parts) == set(first.parts) for joint in self.joints) - len(contacts)
        exact = all(isinstance(each, Contact) and each.misfit < _EXACT_MISFIT * self.size for each in contacts)
        fits = first.state in _FIT_STATES or first.region == "circle"
        return 0, int(margin >= UNCLEAR_MARGIN), int(fits), int(others > 0), int(exact)

    def fewest(self) -> Iterator[list[int]]:
        """For pairs of parts, the fewest of their joints without which something moves: each that is among such."""
        pairs: dict[frozenset[str], list[int]] = defaultdict(list)
        for k, joint in enumerate(self.joints):
            pairs[frozenset(joint.parts)].append(k)
        for some in pairs.values():
            found: list[list[int]] = []
            for first in range(len(some)) if len(some) > 1 and self._frees(some) else ():
                removed = [*some[first:], *some[:first]]
                for k in removed[::-1]:
                    fewer = [each for each in removed if each != k]
                    if self._frees(fewer):
                        removed = fewer
                if sorted(removed) not in found:
                    found.append(sorted(removed))
            yield from found

    def _frees(self, removed: Sequence[int]) -> bool:
        return bool(len(self.system.freed(self.system.rows(removed))))
