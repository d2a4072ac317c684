"""Joints of bodies that have balls and their sockets, with clearance or interference, in common."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.assembly.inference.axes import MAX_OFFSET
from jaxkin.assembly.inference.inference import Inference, offset_told
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.sockets import Socket
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind


def ball_joints(known: Known) -> list[Inference]:
    """Infer joints of bodies that touch nowhere, with balls of one in sockets of the other, or of either in the other.

    One ball makes a ball joint, several on one line a hinge, as dimples of a printed hinge do, others hold the bodies.
    """
    body, common = known.body, dict[BodyPair, list[Socket]]()
    tied = {*known.jointed, *(frozenset(body[part] for part in pair) for pair in known.touching)}
    for each in known.sockets:
        owners = frozenset(body[part] for part in each.parts)
        if len(owners) == 2 and owners not in tied:
            common.setdefault(owners, []).append(each)
    return [_joined(known, some) for some in common.values()]


def _joined(known: Known, found: Sequence[Socket]) -> Inference:
    """Make the joint of two bodies by their balls, the first of which is told."""
    first = found[0]
    farthest = max(found, key=lambda each: float(np.linalg.norm(each.ball.centre - first.ball.centre)))
    offset = farthest.ball.centre - first.ball.centre
    away, slack = float(np.linalg.norm(offset)), MAX_OFFSET * first.ball.radius
    parts = known.in_order(first.parts)
    how = "a clearance" if first.clearance >= 0 else "an interference"
    text = f"the ball of radius {first.ball.radius:.4g} has {how} of {abs(first.clearance):.2g} in its socket"
    text += offset_told(first.offset, first.ball.radius)
    sizes = (("radius", first.hole.radius), ("clearance", first.clearance), ("offset", first.offset))
    name, evidence = "-".join(parts), Evidence(EvidenceKind.CLEARANCE, sizes, text)
    if away <= slack:
        return Inference.of(pairs.spherical(name, *parts, point=first.ball.centre), evidence)
    axis = offset / away
    beside = (np.linalg.norm(np.cross(each.ball.centre - first.ball.centre, axis)) for each in found)
    on_line = all(each <= slack for each in beside)
    where = "are on its line" if on_line else "are beside it, and no line goes through all"
    text += f"; {len(found) - 1} more {where}"
    evidence = Evidence(EvidenceKind.CLEARANCE, sizes, text)
    if not on_line:
        return Inference(parts, evidence)
    return Inference.of(pairs.revolute(name, *parts, point=first.ball.centre, axis=axis), evidence)
