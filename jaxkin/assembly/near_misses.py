"""Near misses of a detection beside a mechanism: which of them tell something that it does not."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from jaxkin.contacts.contact import NearMiss
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def not_accounted_for(every: Iterable[NearMiss], mechanism: Mechanism) -> tuple[NearMiss, ...]:
    """Keep the near misses of two bodies that no joint ties, or joints of contacts alone.

    Within one body, and of two bodies with a joint that does not rest on contacts, such as a pin with play or a screw
    in its hole, what faces are nearly is known otherwise: their advice, such as to hold both parts together, is done.
    """
    body = body_of_parts(mechanism.bodies)
    tied = {
        frozenset(body[part] for part in joint.parts)
        for joint in mechanism.all_joints
        if joint.evidence is not None and joint.evidence.kind is not EvidenceKind.CONTACT
    }
    owners = ((miss, frozenset(body.get(part, part) for part in miss.parts)) for miss in every)
    return tuple(miss for miss, of_two in owners if len(of_two) == 2 and of_two not in tied)
