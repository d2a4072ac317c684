"""Ball joints of bodies that have a ball and its socket, with clearance or interference, in common."""

from __future__ import annotations

from jaxkin.assembly.inference.inference import Inference, offset_told
from jaxkin.assembly.inference.known import Known
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind


def ball_joints(known: Known) -> list[Inference]:
    """Infer ball joints of bodies that touch nowhere, with a ball of one in a socket of the other."""
    body, result = known.body, []
    tied = {*known.jointed, *(frozenset(body[part] for part in pair) for pair in known.touching)}
    for each in known.sockets:
        owners = frozenset(body[part] for part in each.parts)
        if len(owners) < 2 or owners in tied:
            continue
        tied.add(owners)
        parts = known.in_order(each.parts)
        how = "a clearance" if each.clearance >= 0 else "an interference"
        text = f"the ball of radius {each.ball.radius:.4g} has {how} of {abs(each.clearance):.2g} in its socket"
        sizes = (("radius", each.hole.radius), ("clearance", each.clearance), ("offset", each.offset))
        evidence = Evidence(EvidenceKind.CLEARANCE, sizes, text + offset_told(each.offset, each.ball.radius))
        joint = pairs.spherical("-".join(parts), *parts, point=each.ball.centre)
        result.append(Inference.of(joint, evidence))
    return result
