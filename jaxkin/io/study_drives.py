"""Drives that a study begins with: what can drive, through ranges so small that nothing is at its limit at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.wheels import wheels_of
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.part import size
from jaxkin.linkage.coordinates import coordinates
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.mobility.mobility import names
from jaxkin.mobility.open_loops import left_open

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_TURN, _SLIDE = 10.0, 0.01
"""Degrees, and lengths over the size of the assembly, that a joint moves by until the user says how far."""
_COUNT = 21
"""Poses of a range: enough to see a motion, few enough to be solved at once."""
_POOR = 0.2
"""Share of its own range below which a coordinate drives badly: others move by five times as much, in their ranges."""
_STILL = 1e-9
"""Rates, over that of the driven coordinate, that are rounding."""


def can_drive(mechanism: Mechanism, driven: Sequence[str]) -> bool:
    """Tell whether the loops can follow a drive of these coordinates."""
    if left_open(mechanism.linkage) is not None:
        return False
    try:
        return plan_drive(mechanism.linkage, tuple(driven)).infeasible is None
    except ValueError:  # angles of a ball that can be driven together only
        return False


def useful_coordinates(mechanism: Mechanism) -> list[str]:
    """Name the coordinates in which more shows than idle motions, and parts that only spin."""
    found = mechanism.mobility()
    joints = [joint for joint in mechanism.all_joints if not {*joint.parts} & {*found.spinning}]
    names = (name for joint in joints for name in joint.full_names)
    return [name for name in names if name not in found.idle]


def small_drive(mechanism: Mechanism) -> dict[str, str]:
    """Return small ranges for coordinates that determine the motion of solids; none where nothing can be driven.

    These are the motors, where they do so; else those that the mobility names, but where one of them moves the others
    by far more than itself: then the one that does so least. Wheels, which move nothing else, come last and stay as
    they are, and so does what is locked.
    """
    if left_open(mechanism.linkage) is not None:
        return {}
    found = mechanism.mobility()
    driven = _motors(mechanism, len(found.drivable)) or found.drivable
    if len(driven) == 1 and _shares(mechanism, driven)[0] < _POOR:
        others = [name for name in useful_coordinates(mechanism) if can_drive(mechanism, [name])]
        driven = (max(others, key=lambda name: _shares(mechanism, [name])[0], default=driven[0]),)
    turning = wheels_of(mechanism)
    resting = {*turning} if len(turning) < len(driven) else set()
    still = {name: f"0:0:{_COUNT}" for name in driven if name in resting | _locked(mechanism)}
    return small_ranges(mechanism, [name for name in driven if name not in still]) | still


def _motors(mechanism: Mechanism, count: int) -> tuple[str, ...]:
    """Name the coordinates of the motors, if they are as many as `count` and can be driven together."""
    driven = tuple(coordinates(mechanism.linkage, mechanism.motors)) if mechanism.motors else ()
    return driven if len(driven) == count and can_drive(mechanism, driven) else ()


def _locked(mechanism: Mechanism) -> set[str]:
    """Name the coordinates whose two limits are equal."""
    return {
        name
        for joint in mechanism.all_joints
        for name, (low, high) in zip(joint.full_names, joint.limits, strict=bool(joint.limits))
        if low == high
    }


def small_ranges(mechanism: Mechanism, driven: Sequence[str]) -> dict[str, str]:
    """Return ranges to either side of the assembled pose in which no joint moves far, at the rates of that pose."""
    ranges = {}
    for name, share in zip(driven, _shares(mechanism, driven), strict=True):
        whole = _SLIDE * size(mechanism.solids) if is_length(name.rpartition(".")[2]) else _TURN
        end = f"{float(f'{share * whole:.1g}'):g}"
        ranges[name] = f"-{end}:{end}:{_COUNT}"
    return ranges


def _shares(mechanism: Mechanism, driven: Sequence[str]) -> list[float]:
    """For each driven coordinate the share of its own range at which, with all others at rest, some joint is at the end
    of its range: 1 where none moves faster than it does; outside of loops, too."""
    length, shares = _SLIDE * size(mechanism.solids), dict.fromkeys(driven, 1.0)
    for found in loop_freedoms(mechanism.linkage):
        columns = names(mechanism.linkage, found, range(len(found.columns)))
        places = [columns.index(name) for name in driven if name in columns]
        if not places:
            continue
        slides = [is_length(name.rpartition(".")[2]) for name in columns]
        ends = np.where(slides, length / found.length, np.deg2rad(_TURN))
        rates = np.linalg.pinv(found.assembled_motions[:, places]) @ found.assembled_motions
        for place, row in zip(places, np.abs(rates), strict=True):
            moving = row > _STILL * row[place]
            shares[columns[place]] = float(np.min(ends[moving] / row[moving], initial=ends[place]) / ends[place])
    return [*shares.values()]
