"""How far coordinates are moved at random starts, from which loops are closed to find other poses of theirs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.geometry.trig import TURN

Ratio = tuple[Sequence[int], Float[np.ndarray, "2"]]
"""The two columns of a linear coupling `a q_1 + b q_2 = d`, and its factors (a, b), in the units of the columns."""


def start_ranges(
    is_length: Bool[np.ndarray, " columns"],
    pitch: Float[np.ndarray, " columns"],
    slide: float,
    couplings: Sequence[Ratio],
    carried: Bool[np.ndarray, " columns"],
) -> Float[np.ndarray, " columns"]:
    """Say how far each column is moved at a start at most, radians and lengths in the unit of `slide`.

    Slides by `slide`, angles by half a turn, and screws, which have a `pitch` (0 for all others), by as many turns as
    advance by what slides do. Columns that are `carried` by couplings, such as the pinion of a rack, move as far as
    these ask for: else they would hold the loops near their assembled pose, since few turns of a pinion are a short way
    of its rack.
    """
    turns = np.maximum(np.pi, TURN * slide / np.where(pitch == 0.0, np.inf, np.abs(pitch)))
    farthest = np.where(is_length, slide, turns)
    for _ in couplings:  # each may wait for another one, as in a train of gears
        for columns, factors in couplings:
            for one, other in ((0, 1), (1, 0)):
                if carried[columns[one]]:
                    asked = farthest[columns[other]] * abs(factors[other] / factors[one])
                    farthest[columns[one]] = max(farthest[columns[one]], asked)
    return farthest
