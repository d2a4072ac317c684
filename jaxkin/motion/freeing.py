"""Why a mechanism cannot move: the contacts, or joints by hand, without which it could.

Faces that touch in the modelled pose only (end stops, covers) break assumption 4 of the paper, and one of them is
enough to block a whole mechanism.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.joints.from_contacts import joints_from_contacts
from jaxkin.joints.joint import Joint
from jaxkin.motion.twists import Twists, twists
from jaxkin.topology.bodies import bodies

if TYPE_CHECKING:
    from jaxkin.motion.mechanism import Mechanism

LISTED = 8
"""Ways out that a report lists at most."""
_MOVES = 1e-6
"""Twist of a part over the largest of all, above which it moves."""


@dataclass(frozen=True)
class Freeing:
    """Something to leave out, and what can move then."""

    what: tuple[Contact | str, ...]
    """A contact, or all contacts of two parts; the name of a joint by hand."""
    freedoms: int
    """How many the mechanism has then."""
    parts: tuple[str, ...]
    """The parts that move then."""
    between: tuple[str, str]
    """The two parts that it is between."""

    def __str__(self) -> str:
        said = [entry if isinstance(entry, Contact) else f"joint {entry!r}" for entry in self.what]
        kind = "contacts" if isinstance(self.what[0], Contact) else "joints"
        what = str(said[0]) if len(said) == 1 else f"all {len(said)} {kind} of {' - '.join(self.between)}"
        freedoms = f"{self.freedoms} freedom{'' if self.freedoms == 1 else 's'}"
        return f"{what}: then {freedoms}, moving {', '.join(self.parts)}"


def freeing(mechanism: Mechanism) -> tuple[Freeing, ...]:
    """Single contacts or joints by hand without which parts of the mechanism could move; if there is none, pairs of
    parts all of whose contacts are to go. The fewest freedoms first, among them what moves the most parts.

    Contacts are taken one by one here, however they were combined. Judged at the assembled pose.
    """
    contacts = tuple(contact for some in mechanism.contacts.values() for contact in some)
    by_hand = [joint for joint in mechanism.all_joints if joint.name not in mechanism.contacts]
    found = joints_from_contacts(contacts, mechanism.parts, combine=False)
    ties = [joint.parts for joint in by_hand if joint.kind == "fixed"]
    body_of = bodies(mechanism.parts, mechanism.fixed, ties)
    joints: list[Joint] = [*found.joints, *(joint for joint in by_hand if joint.kind != "fixed")]
    system = twists(joints, body_of, body_of[mechanism.fixed[0]])
    source = {name: some[0] for name, some in found.contacts.items()}
    what: list[Contact | str] = [source.get(joint.name, joint.name) for joint in joints]
    ways = [_way(body_of, system, joints, [k], what) for k in range(len(joints))]
    if not any(ways):
        pairs: dict[frozenset[str], list[int]] = defaultdict(list)
        for k, joint in enumerate(joints):
            pairs[frozenset(joint.parts)].append(k)
        ways = [_way(body_of, system, joints, some, what) for some in pairs.values() if len(some) > 1]
    return tuple(sorted(filter(None, ways), key=lambda way: (way.freedoms, -len(way.parts))))


def _way(
    body_of: Mapping[str, str],
    system: Twists,
    joints: Sequence[Joint],
    removed: Sequence[int],
    what: Sequence[Contact | str],
) -> Freeing | None:
    gained = system.freed(system.rows(removed))
    if not len(gained):
        return None
    strength = np.abs(gained).max(axis=(0, 2))
    moving = {body for body, moves in zip(system.bodies, strength > _MOVES * strength.max(), strict=True) if moves}
    parts = tuple(part for part in body_of if body_of[part] in moving)
    return Freeing(tuple(what[k] for k in removed), len(gained), parts, joints[removed[0]].parts)
