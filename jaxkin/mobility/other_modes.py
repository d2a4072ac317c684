"""Find other assembly modes near the given pose: closed poses that no motion of the mechanism connects (host code).

Open loops may close in several ways: an elbow up or down, a rod crossed over another. Damped Newton steps from starts
around the given pose find closed poses nearby. From each of these the loops are then moved, within their freedoms, as
near as possible to the closed pose that was found first. If the motion arrives there, the two poses are one assembly
mode (one circuit of the mechanism).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Transform
from jaxkin.joints.screws import Screws
from jaxkin.linkage.first_order import null_space
from jaxkin.linkage.host_closure import ClosedLoops, LoopCoordinates, Travel

STARTS = 8
"""Number of other starts from which each loop group is closed."""
NEAREST = 0.1
"""Least distance of other starts from the given pose, radians or characteristic lengths, however little the loops had
to move to close."""
APART = 1e-6
"""Distance between two poses, radians or characteristic lengths, above which they differ: far above the residual of
closed loops."""
_STRIDE = 0.3
"""Length of the first steps back to the first closed pose, radians or characteristic lengths."""
_LEAST_STRIDE = 1e-3
"""Shortest length of steps back, radians or characteristic lengths: if it leads no nearer, no motion does."""
_STEPS = 100
"""Largest number of steps back: enough for ten radians in steps of a tenth."""


def closed_from_elsewhere(
    loops: ClosedLoops, q: LoopCoordinates, enough: float, held: Sequence[int] = ()
) -> list[tuple[LoopCoordinates, Travel]]:
    """Close the loops from other starts, as far from the given pose as the closed coordinates `q`.

    Returns the coordinates whose `Travel.residual_norm` is at most `enough`, with what is met on the way around the
    loops there. In the given pose all coordinates are zero; the columns `held` stay zero. The starts are the same in
    each call.
    """
    rng, found, free = np.random.default_rng(0), [], np.ones(len(q))
    free[list(held)] = 0.0
    reach = max(NEAREST, float(np.abs(q).max(initial=0.0)))
    for _ in range(STARTS):
        there, travel = loops.closed(reach * rng.uniform(-1.0, 1.0, len(q)) * free, held)
        if travel.residual_norm <= enough:
            found.append((there, travel))
    return found


def other_modes(loops: ClosedLoops, q: LoopCoordinates, held: Sequence[int] = ()) -> list[float]:
    """Measure the distances from the closed coordinates `q` to other assembly modes, one entry a start that found one.

    The columns `held` stay zero while loops are closed from other starts, and may move afterwards, within the freedoms.
    A distance is the largest entry of the differences between displacements of parts, rotation matrices and
    translations over the characteristic length, when the loops have been moved as near to `q` as possible.
    """
    home = loops.travel(q).places
    distances = [
        _led_back(loops, *found, home) for found in closed_from_elsewhere(loops, q, loops.thresholds.residual, held)
    ]
    return [left for left in distances if left > APART]


def _led_back(loops: ClosedLoops, q: LoopCoordinates, found: Travel, home: Mapping[str, Transform]) -> float:
    """Move the parts from closed coordinates `q` towards the displacements `home`, and measure what distance is left.

    Gauss-Newton steps reduce the differences of the displacements within the freedoms; the loops are closed after each.
    """
    stride = _STRIDE
    apart = _differences(found.places, home)
    for _ in range(_STEPS):
        if np.abs(apart).max() <= APART or stride < _LEAST_STRIDE:
            break
        free = null_space(found.jacobian, loops.thresholds.rank)[1]
        rates = _rates_of_places(loops, found.places, found.screws)
        step = free.T @ np.linalg.lstsq(rates @ free.T, -apart, rcond=loops.thresholds.rate)[0]
        step *= min(1.0, stride / max(float(np.linalg.norm(step)), 1e-300))
        trial, there = loops.closed(q + step)
        nearer = _differences(there.places, home)
        # a step that jumped to another assembly mode would prove nothing
        stayed = np.linalg.norm(trial - q) <= 2.0 * np.linalg.norm(step) + APART
        closed = there.residual_norm <= loops.thresholds.residual
        if stayed and closed and np.linalg.norm(nearer) < np.linalg.norm(apart):
            q, found, apart, stride = trial, there, nearer, min(2.0 * stride, _STRIDE)
        else:
            stride /= 4.0
    return float(np.abs(apart).max())


def _differences(places: Mapping[str, Transform], home: Mapping[str, Transform]) -> Float[np.ndarray, " entries"]:
    """Subtract displacements, twelve entries a part: columns of the rotation, then the translation."""
    return np.concatenate([(places[part] - place)[:3].T.ravel() for part, place in home.items()])


def _rates_of_places(
    loops: ClosedLoops, places: Mapping[str, Transform], screws: Screws
) -> Float[np.ndarray, "entries columns"]:
    """Differentiate the entries of `_differences` with respect to the coordinates, along the loops as `travel` does."""
    twists: dict[str, Screws] = {}

    def twist_of(row: str) -> Screws:
        if row not in twists:
            twists[row] = np.zeros_like(screws)
            if row in loops.hanging:
                parent, joint, sign = loops.hanging[row]
                twists[row] = twist_of(parent).copy()
                twists[row][:, loops.slices[joint]] += sign * screws[:, loops.slices[joint]]
        return twists[row]

    for loop in loops.loop_group.loops:
        first, sign = loop[0]
        twist = twist_of(loops.ends[first][0 if sign > 0 else 1])
        for joint, sign in loop:
            twist = twist.copy()
            twist[:, loops.slices[joint]] += sign * screws[:, loops.slices[joint]]
            twists.setdefault(loops.ends[joint][1 if sign > 0 else 0], twist)
    rows = []
    for part, place in places.items():
        turn, shift = np.split(twist_of(part), 2)
        entries = [np.cross(turn, column, axisa=0, axisb=0, axisc=0) for column in place[:3].T]
        entries[3] = entries[3] + shift
        rows += entries
    return np.concatenate(rows)
