"""Bolts through the balls of rod ends, and what they hold to these."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.set_screws import FITTED
from jaxkin.assembly.inference.sockets import Socket
from jaxkin.joints.evidence import Evidence, EvidenceKind


def bolted_balls(known: Known) -> list[Inference]:
    """Join the balls of rod ends with the bolts through them, and with what these bolts hold flat against the balls.

    What turns does so about the middle of the ball, in the race of the rod end.
    """
    result = []
    for socket in known.sockets:
        ball, race = socket.parts
        for pair in known.axes:
            if ball not in pair.parts or race in pair.parts or not _through(socket, pair):
                continue
            bolt = pair.one if pair.one.part != ball else pair.other
            on = [each for each in known.axes if bolt.part in each.parts and each.one.on_axis_of(bolt)]
            parts = {part for each in on for part in each.parts} - {race}
            if len(held := _stacked(known, ball, parts, bolt)) > 1:
                text = f"{bolt.part!r} holds the ball {ball!r} of the rod end {race!r}"
                names = known.in_order({*held, bolt.part})
                sizes = (("radius", bolt.radius),)
                result.append(Inference(names, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _through(socket: Socket, pair: CommonAxis) -> bool:
    """Tell whether an axis that a ball with a hole has in common with another part goes through its middle."""
    bore = pair.one if pair.one.part == socket.ball.part else pair.other
    offset = socket.ball.centre - bore.point
    apart = np.linalg.norm(offset - (offset @ bore.axis) * bore.axis)
    return bore.hole and bool(apart <= FITTED * socket.ball.radius)


def _stacked(known: Known, ball: str, parts: Collection[str], axis: Bore) -> Sequence[str]:
    """Find the parts that lie flat on a ball, and on those that do, across an axis."""
    found = [ball]
    for part in found:  # grows while it is read
        found += [other for other in known.parts_flat_on(part, axis.axis) if other in parts and other not in found]
    return found
