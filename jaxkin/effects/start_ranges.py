"""How far coordinates are moved at random starts, from which loops are closed to find their assembly modes."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.linkage.host_closure import ClosedLoops
from jaxkin.mechanism.drive_plan import DrivenLoopGroup

FARTHEST_SLIDE = 2.0
"""Largest displacement of a slide at a start, characteristic lengths: a mechanism is some two of them wide to either
side of its middle."""


def start_ranges(loop_group: DrivenLoopGroup, loops: ClosedLoops) -> Float[np.ndarray, " columns"]:
    """Say how far each column is moved at a start at most, radians and characteristic lengths.

    Slides by `FARTHEST_SLIDE`, angles by half a turn, and screws by as many turns as advance by what slides do. What
    only couplings tie to a loop, such as the pinion of a rack, moves as far as they ask for: else it would hold the
    loop near its assembled pose, since few turns of it are a short way of the rack.
    """
    farthest = np.where(np.array(loop_group.system.is_length), FARTHEST_SLIDE, np.pi)
    for column, (joint, _) in enumerate(loop_group.columns):
        chain = loops.chains[joint]
        if chain.pitch and any(MOVEMENTS[movement].has_pitch for movement in chain.movements):
            farthest[column] = max(np.pi, 2 * np.pi * FARTHEST_SLIDE / abs(chain.pitch))
    in_loops = {joint for loop in loop_group.members.loops for joint, _ in loop}
    number_of = {place: number for number, place in enumerate(loop_group.columns)}
    for _ in loops.couplings:  # each may wait for another one, as in a train of gears
        for columns, factors, _ in loops.couplings:
            places = [loops.columns[column] for column in columns]
            if len(places) != 2 or np.any(factors[:, 1:]) or not all(place in number_of for place in places):
                continue
            for one, other in ((0, 1), (1, 0)):
                if places[one][0] not in in_loops:
                    asked = farthest[number_of[places[other]]] * abs(factors[other, 0] / factors[one, 0])
                    farthest[number_of[places[one]]] = max(farthest[number_of[places[one]]], asked)
    return farthest
