"""Find other assembly modes: closed poses near the given pose that freedoms do not lead to each other (host code).

Loops that are open may close in several ways: an elbow up or down, a rod crossed over another. Damped Newton steps from
starts around the given pose find closed poses nearby. Each is then led, within its freedoms, as near as it goes to the
closed pose that was found first. Where it arrives, the two are one assembly mode (one circuit of the mechanism).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Pose
from jaxkin.joints.screws import Screws
from jaxkin.linkage.first_order import null_space
from jaxkin.mobility.host_closure import ClosedLoops, Row, Travel

STARTS = 8
"""Other starts from which each structure element is closed."""
NEAREST = 0.1
"""Radians, or characteristic lengths: other starts are at least so far away, however little the loops had to move."""
APART = 1e-6
"""Radians, or characteristic lengths, between poses that are not the same: far above what closure leaves."""
_STRIDE = 0.3
"""The same, of the first steps on the way back."""
_LEAST_STRIDE = 1e-3
"""The same: where no longer step leads nearer, the way back is at its end."""
_STEPS = 100
"""Steps on the way back at most: ten radians at a tenth of one."""


def closed_from_elsewhere(
    loops: ClosedLoops, q: Row, enough: float, held: Sequence[int] = ()
) -> list[tuple[Row, Travel]]:
    """Coordinates with a gap of at most `enough` that other starts lead to, about as far from the given pose as `q`.

    The given pose is where the coordinates are zero: columns that are `held` stay there. The starts are the same each
    time.
    """
    rng, found, free = np.random.default_rng(0), [], np.ones(len(q))
    free[list(held)] = 0.0
    reach = max(NEAREST, float(np.abs(q).max(initial=0.0)))
    for _ in range(STARTS):
        there, travel = loops.closed(reach * rng.uniform(-1.0, 1.0, len(q)) * free, held)
        if travel.gap <= enough:
            found.append((there, travel))
    return found


def other_modes(loops: ClosedLoops, q: Row, held: Sequence[int] = ()) -> list[float]:
    """How far from the closed coordinates `q` other assembly modes stay that starts around the given pose lead to.

    Columns that are `held` are as they are given where the loops are closed; then they may move as all others.
    Distances are the largest entries of the differences of the displacements of parts, in radians and characteristic
    lengths.
    """
    home = loops.travel(q).places
    distances = [
        _led_back(loops, *found, home) for found in closed_from_elsewhere(loops, q, loops.thresholds.residual, held)
    ]
    return [left for left in distances if left > APART]


def _led_back(loops: ClosedLoops, q: Row, found: Travel, home: Mapping[str, Pose]) -> float:
    """How far from the places `home` the parts stay that go there from closed coordinates, the loops kept closed.

    Gauss-Newton steps on the differences of the displacements, within the freedoms; each is closed anew.
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
        # what has jumped to another mode on the way would tell nothing
        stayed = np.linalg.norm(trial - q) <= 2.0 * np.linalg.norm(step) + APART
        if stayed and there.gap <= loops.thresholds.residual and np.linalg.norm(nearer) < np.linalg.norm(apart):
            q, found, apart, stride = trial, there, nearer, min(2.0 * stride, _STRIDE)
        else:
            stride /= 4.0
    return float(np.abs(apart).max())


def _differences(places: Mapping[str, Pose], home: Mapping[str, Pose]) -> Float[np.ndarray, " entries"]:
    """Twelve entries a row of parts: columns of the rotation, then the translation."""
    return np.concatenate([(places[part] - place)[:3].T.ravel() for part, place in home.items()])


def _rates_of_places(
    loops: ClosedLoops, places: Mapping[str, Pose], screws: Screws
) -> Float[np.ndarray, "entries columns"]:
    """Derivatives of these entries with respect to the coordinates, along the loops by which `travel` found them."""
    twists: dict[str, Screws] = {}
    for loop in loops.loop_group.loops:
        first, sign = loop[0]
        twist = twists.setdefault(loops.ends[first][0 if sign > 0 else 1], np.zeros_like(screws))
        for joint, sign in loop:
            twist = twist.copy()
            twist[:, loops.slices[joint]] += sign * screws[:, loops.slices[joint]]
            twists.setdefault(loops.ends[joint][1 if sign > 0 else 0], twist)
    rows = []
    for part, place in places.items():
        turn, shift = twists[part][:3], twists[part][3:]
        entries = [np.cross(turn, column, axisa=0, axisb=0, axisc=0) for column in place[:3].T]
        entries[3] = entries[3] + shift
        rows += entries
    return np.concatenate(rows)
