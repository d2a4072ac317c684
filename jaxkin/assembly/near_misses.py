"""Near misses of a detection beside a mechanism: which of them tell something that it does not, and what is not to
be done of what they advise."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from jaxkin.contacts.contact import NearMiss
from jaxkin.contacts.reason import of_moving_parts
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_SLIDING = (JointKind.CYLINDRICAL, JointKind.PRISMATIC)
"""Joints by which a body carries a seal along what it slides in."""
_CARRYING = (*_SLIDING, JointKind.REVOLUTE)
"""Joints by which a seal is on what carries it."""


def not_accounted_for(every: Iterable[NearMiss], mechanism: Mechanism) -> tuple[NearMiss, ...]:
    """Keep the near misses of two bodies that no joint ties, or joints of contacts alone.

    Within one body, and of two bodies with a joint that does not rest on contacts, such as a pin with play or a screw
    in its hole, what faces are nearly is known otherwise: their advice, such as to hold both parts together, is done.
    What a joint lets move is not advised to be joined: see `of_moving`.
    """
    body = body_of_parts(mechanism.bodies)
    tied = {
        frozenset(body[part] for part in joint.parts)
        for joint in mechanism.all_joints
        if joint.evidence is not None and joint.evidence.kind is not EvidenceKind.CONTACT
    }
    owners = ((miss, frozenset(body.get(part, part) for part in miss.parts)) for miss in every)
    return of_moving((miss for miss, of_two in owners if len(of_two) == 2 and of_two not in tied), mechanism)


def of_moving(every: Iterable[NearMiss], mechanism: Mechanism) -> tuple[NearMiss, ...]:
    """Say of near misses of parts that a joint lets move on each other that joining the parts would lock it."""
    body = body_of_parts(mechanism.bodies)
    between: dict[frozenset[str], Joint] = {}
    for joint in mechanism.all_joints:
        pair = frozenset(body[part] for part in joint.parts)
        if joint.freedoms and len(pair) == 2:
            between.setdefault(pair, joint)
    result = []
    for miss in every:
        owners = frozenset(body.get(part, part) for part in miss.parts)
        joint = between.get(owners) or _carried(owners, between)
        result.append(replace(miss, reason=of_moving_parts(miss.reason, joint.name)) if joint else miss)
    return tuple(result)


def _carried(owners: frozenset[str], between: dict[frozenset[str], Joint]) -> Joint | None:
    """Find the joint by which a third body slides in one of two bodies and carries the other one, as a piston does its
    seal; None if there is none."""
    if len(owners) != 2:
        return None
    for pair, joint in between.items():
        inside, third = pair & owners, pair - owners
        if joint.kind in _SLIDING and len(inside) == len(third) == 1:
            carrying = between.get(owners - inside | third)
            if carrying is not None and carrying.kind in _CARRYING:
                return joint
    return None
