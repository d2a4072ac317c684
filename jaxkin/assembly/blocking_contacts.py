"""Find the contacts, or joints by hand, that block a mechanism: without one of them it could move.

Faces that touch only in the modelled pose (end stops, covers) violate assumption 4 of the paper, and one such contact
can block a whole mechanism. Which of several candidates is wrong cannot be known, so they are ranked by likelihood.
A candidate is reported only if the mechanism, rebuilt without it, has more freedoms.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin._names import counted
from jaxkin.assembly.joined import all_contacts, without_contacts
from jaxkin.contacts.contact import Contact
from jaxkin.joints.from_contacts import UNCLEAR_MARGIN, joints_from_contacts
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.twists import TwistConstraints, middle, twists
from jaxkin.topology.bodies import bodies

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

MAX_LISTED = 8
"""Number of results at most: users do not read more."""
MAX_LISTED_OF_LARGE = 3
"""The same for mechanisms of more than `LARGE_MECHANISM` joints: to rebuild one of them takes seconds."""
LARGE_MECHANISM = 40
"""Number of joints above which fewer results are looked for."""
_TRIALS_PER_LISTED = 3
"""Number of candidates that are tried at most for each result that is wanted."""
_MOVING_RATIO = 1e-6
"""A part moves if its twist, relative to the largest twist of all parts, is above this."""
_EXACT_MISFIT = 1e-5
"""Misfit of a contact, relative to the extent of the joints, below which it is exact."""


@dataclass(frozen=True)
class BlockingContacts:
    """Contacts or joints to leave out, and what can move then."""

    what: tuple[Contact | str, ...]
    """One contact, or several between two parts, or the name of a joint by hand."""
    freedoms: int
    """Number of freedoms of the mechanism then, without idle ones and those of parts that only spin."""
    parts: tuple[str, ...]
    """The parts that move then."""
    between: tuple[str, str]
    """The two parts that `what` is between."""

    def __str__(self) -> str:
        said = [str(entry) if isinstance(entry, Contact) else f"joint {entry!r}" for entry in self.what]
        freedoms = counted(self.freedoms, "freedom")
        return f"{' and '.join(said)}: then {freedoms}, moving {', '.join(self.parts)}"


class _Candidate(NamedTuple):
    """A `BlockingContacts` found at first order, for which the mechanism was not rebuilt yet."""

    rank: tuple
    """Low for contacts that are likely to be wrong."""
    found: BlockingContacts


def blocking_contacts(mechanism: Mechanism) -> tuple[BlockingContacts, ...]:
    """Find single contacts or joints by hand without which parts of the mechanism could move, the likeliest first.

    If there is no single one, the smallest sets of contacts between two parts are looked for. Each result (at most
    `MAX_LISTED`) is verified: the mechanism rebuilt without it has more freedoms. Contacts are considered one by one,
    even those that were combined to one joint. Faces that touch by chance are plane, and the only contact of their
    parts: contacts of fits, and exact ones, come later, and joints by hand last.
    """
    judged = _ContactJudgement.of(mechanism)
    candidates = [each for k in range(len(judged.joints)) if (each := judged.candidate([k]))]
    if not candidates:
        candidates = [each for some in judged.fewest() if (each := judged.candidate(some))]
    candidates.sort(key=lambda each: each.rank)
    listed = MAX_LISTED if len(mechanism.all_joints) <= LARGE_MECHANISM else MAX_LISTED_OF_LARGE
    before = mechanism.mobility().useful
    found: list[BlockingContacts] = []
    for _, candidate in candidates[: _TRIALS_PER_LISTED * listed]:
        if (tried := _tried(mechanism, candidate, before)) is not None:
            found.append(tried)
        if len(found) == listed:
            break
    return tuple(found)


def _tried(mechanism: Mechanism, candidate: BlockingContacts, before: int) -> BlockingContacts | None:
    """Rebuild the mechanism without some contacts and count its freedoms; None where they are no more than before."""
    try:
        freedoms = without_contacts(mechanism, candidate.what).mobility().useful
    except ValueError:  # a part hangs on nothing then
        return None
    return replace(candidate, freedoms=freedoms) if freedoms > before else None


class _ContactJudgement(NamedTuple):
    """The contacts and joints by hand of a mechanism, at first order in its assembled pose."""

    joints: Sequence[Joint]
    """One joint for each contact, and the joints by hand."""
    what: Sequence[Contact | str]
    """For each joint its contact, or the name of a joint by hand."""
    body_of: Mapping[str, str]
    """For each part the first part of its body."""
    system: TwistConstraints
    resting: frozenset[str]
    """Parts that only spin."""
    size: float
    """Extent of the joints."""

    @staticmethod
    def of(mechanism: Mechanism) -> _ContactJudgement:
        """Collect the contacts of a mechanism, with those that were left out for parts that only spin."""
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

    def candidate(self, removed: Sequence[int]) -> _Candidate | None:
        """Find what can move without some joints; None where that is nothing, or only parts that spin."""
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
        return _Candidate((*self._likely_right(removed, margin), len(gained), -len(parts)), found)

    def _likely_right(self, removed: Sequence[int], margin: float) -> tuple[int, ...]:
        """Rank joints by the reasons for which they are probably meant, 0 or 1 each, the strongest reason first."""
        contacts = [self.what[k] for k in removed]
        first = contacts[0]
        if not isinstance(first, Contact):
            return (1,) * 5
        others = sum(set(joint.parts) == set(first.parts) for joint in self.joints) - len(contacts)
        exact = all(isinstance(each, Contact) and each.misfit < _EXACT_MISFIT * self.size for each in contacts)
        # one surface encloses the other, as in hinges, seats and ball joints: that is meant
        fits = first.contact_state.is_fit or first.region == "circle"
        return 0, int(margin >= UNCLEAR_MARGIN), int(fits), int(others > 0), int(exact)

    def fewest(self) -> Iterator[list[int]]:
        """Find, for each pair of parts, the smallest sets of its joints without which something moves.

        Starting from all joints of the pair, joints are put back one by one as long as something still moves; each
        joint comes last once, so that the sets cover all joints that are in such a set.
        """
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
        """Tell whether something moves without some joints."""
        return self.system.count_freed(self.system.rows(removed)) > 0
