"""Studs of balls, and rod ends on their rods: a ball turns about every axis through its middle already."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from jaxkin.assembly.inference.axes import MAX_OFFSET, CommonAxis
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sockets import Socket
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.geometry.pose import Vector
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind

MAX_STUD = 8.0
"""Length of the stud of a ball from the middle of that to its far end, over its radius, at most: ball studs of
DIN 71803 and of tie rods have 4 to 7, the rods of struts 15 and more."""
_SPHERES = ("sphere", "sphere")
"""Surfaces of an exact contact of a ball with its socket."""


def held_studs(known: Known, joined: Sequence[StoppedJoint], fastening: Collection[str]) -> list[Inference]:
    """Join the two bodies of a hinge with play about an axis through the middle of a ball, where this hinge and the
    ball are all that ties one of them.

    That body would turn between the two, and move nothing else; a loose ball that rolls in it is no end of it. Studs
    and bolts are screwed or pressed into what they carry the ball for, and rod ends onto their rods. The bolt through
    the ball of a rod end does not slide either: its nut is not drawn.
    """
    body = known.body
    ties = {frozenset(body[part] for part in tie) for tie in (*known.touching, *known.jointed)}
    ties |= {frozenset(body[part] for part in pair.parts) for pair in (*known.axes, *known.tapped)}
    result = []
    for each in joined:
        joint = each.inference.joint
        if joint is None or each.replaces_slide:
            continue
        place = np.asarray(joint.frames_1[0])
        point, axis = place[:3, 3], place[:3, 2]
        owners = {body[part] for part in joint.parts}
        for socket in known.sockets:
            around = {body[part] for part in socket.parts}
            between = owners & around
            if len(owners) != 2 or len(around) != 2 or len(between) != 1 or not _is_on(socket, point, axis):
                continue
            (owner,) = between
            if joint.kind is not JointKind.REVOLUTE and not _is_bolted(known, socket, joint.parts, fastening):
                continue
            tied = {other for tie in ties if owner in tie for other in tie}
            if tied == owners | around and not _is_loose(known, socket) and _rolls(known, around):
                text = f"{joint.parts[0]!r} and {joint.parts[1]!r} have an axis through the middle of the ball of "
                text += f"{socket.ball.part!r}, about which that turns in {socket.hole.part!r} already"
                evidence = Evidence(EvidenceKind.FASTENER, each.inference.evidence.sizes, text)
                result.append(Inference(joint.parts, evidence))
    return result


def is_stud(known: Known, pair: CommonAxis) -> bool:
    """Tell whether a pin ends in a ball on its axis that is in a socket of a third body, no farther from its far end
    than a stud is long: the rods of cylinders and struts, which slide, are longer."""
    body, (part, holder) = known.body, pair.parts
    if pair.virtual:
        return False
    for socket in known.sockets:
        ball = socket.ball
        if ball.part == part and body[socket.hole.part] not in (body[part], body[holder]):
            away = float((ball.centre - pair.one.point) @ pair.one.axis)
            near = _is_on(socket, pair.one.point, pair.one.axis)
            if near and abs(away) + pair.one.half <= MAX_STUD * pair.one.radius:
                return True
    return False


def _is_bolted(known: Known, socket: Socket, parts: Sequence[str], fastening: Collection[str]) -> bool:
    """Tell whether one of two parts is the bolt through the hole of a ball."""
    through = {pair.one.part for pair in known.axes if pair.other.part == socket.ball.part and not pair.virtual}
    return bool(through & {*parts} & {*fastening})


def _is_on(socket: Socket, point: Vector, axis: Vector) -> bool:
    """Tell whether an axis goes through the middle of a ball."""
    return bool(np.linalg.norm(np.cross(socket.ball.centre - point, axis)) <= MAX_OFFSET * socket.ball.radius)


def _is_loose(known: Known, socket: Socket) -> bool:
    """Tell whether a part is a ball and nothing else, without a hole for a bolt, such as one in a caster."""
    away = np.linalg.norm(known.solids[socket.ball.part].outermost - socket.ball.centre, axis=1)
    return not known.bores[socket.ball.part] and bool(away.max() <= (1 + MAX_OFFSET) * socket.ball.radius)


def _rolls(known: Known, owners: set[str]) -> bool:
    """Tell whether two bodies meet at a ball and its socket only."""
    touching = [each for each in known.contacts if {known.body[part] for part in each.parts} == owners]
    return all(each.contact_state.kinds == _SPHERES for each in touching)
