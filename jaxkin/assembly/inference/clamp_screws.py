"""Screws with a knob on one end and a swivelling pad on the other one: they move in their thread."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import WIDER


def swivel_screws(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the screws that go through a part, with a knob on one side, and on the other one a ball with play in the
    socket of a third part: a pad swivels on it, which the screw moves to and fro.

    The studs of ball joints have no knob on the side of their thread.
    """
    result = set()
    for socket in known.sockets:
        name = socket.ball.part
        if name not in fastening:
            continue
        for pair in known.axes:
            if pair.virtual or pair.one.part != name or pair.other.part == socket.hole.part:
                continue
            axis, (low, high) = pair.other.axis, pair.other.reach(pair.other.axis)
            side = 1.0 if socket.ball.centre @ axis > (low + high) / 2 else -1.0
            corners = known.solids[name].outermost
            beyond = corners[side * (corners @ axis) < min(side * low, side * high)]
            away = np.linalg.norm(np.cross(beyond - pair.other.point, axis), axis=1)
            if len(beyond) and away.max() > WIDER * pair.one.radius:
                result.add(name)
    return result
