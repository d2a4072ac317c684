"""Follow a drive from its home pose until the mechanism locks, a joint range ends, or the motion repeats."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from jaxkin._names import listed
from jaxkin.effects.mode_search import SAME_POSE, PoseFeatures
from jaxkin.effects.motion_curve import FIRST_STEP, LONGEST_STEP, CurvePose, MotionCurve
from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.trig import TURN
from jaxkin.joints.joint import Joint, JointCoordinate
from jaxkin.linkage.host_closure import LoopCoordinates
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.infeasible_drive import infeasible_drive, undriven_freedoms

MAX_CURVE_STEPS = 20_000
"""Steps along the motion in one direction, at most: some 4000 radians and characteristic lengths of all coordinates
together."""
MAX_TURNS = 64
"""Full turns of a driven angle after which no limit is expected."""
FARTHEST = 100.0
"""Displacement of a driven slide after which no limit is expected, characteristic lengths; the same of others while the
drive hardly moves."""
CREEPS = 1e-4
"""Absolute entry of the drive in the unit tangent below which it hardly moves: at a slide of 100 sizes it is some 1e-5
where the slide grows without end, as the root of what is left to the drive."""
BESIDE = 0.01
"""Displacement to a pose beside the limit of a drive that is proposed, radians and characteristic lengths. The drive is
then 1e-5 to 1e-4 from its limit: far above the 1e-10 to which limits are found."""
_AT_REST = 1e-6
"""Part of the fastest coordinate, at a lock, below which a coordinate is at rest: rounding over the length of a step is
some 1e-10."""


class LimitKind(StrEnum):
    """What ends the range of a drive on one side."""

    LOCKS = "locks"
    """The drive can go no farther: its rate is zero while other joints still move (a dead point of the drive)."""
    RANGE = "range"
    """A coordinate is at an end of its range."""
    NONE = "none"
    """There is no limit: the motion repeats after full turns, or the drive goes on for as far as it was followed."""
    FAR = "far"
    """Other coordinates went as far as they are followed, and the drive no farther: slides that grow without end, as
    where the axes of a chain of cylindrical pairs come to lie in one plane."""
    LOST = "lost"
    """The motion could not be followed farther: a singular pose that is neither a lock nor passed."""


class CoordinateRange(NamedTuple):
    """The range of a column of the loops, scaled coordinates from the assembled pose."""

    column: int
    low: float
    high: float


class FoundLimit(NamedTuple):
    """Where the range of a drive ends on one side."""

    kind: LimitKind
    here: CurvePose
    """The pose there; for `LimitKind.NONE` the last one that was reached."""
    column: int | None
    """The column whose range ends; None for other kinds."""
    repeats: bool
    """Whether the motion repeats: after full turns of the drive the mechanism is in its assembled pose again, and no
    coordinate with a range has turned on."""


def find_limit(
    curve: MotionCurve,
    begun: CurvePose,
    direction: float,
    ranges: Sequence[CoordinateRange],
    turns: bool,
    features: PoseFeatures,
) -> FoundLimit:
    """Follow the drive in a direction, 1 or -1, from the pose where it has `begun` to its first limit.

    `turns` says whether the drive is an angle, so that the motion may repeat after full turns. Where it does but for
    coordinates that have turned on, the periods that surely stay within the ranges are passed over.
    """
    here, length, number, ahead = begun, FIRST_STEP, 1, None
    lowest = highest = begun.q
    for _ in range(MAX_CURVE_STEPS):
        taken = curve.step(here, length)
        if taken is None:
            return FoundLimit(LimitKind.LOST, here, None, False)
        there, length = taken
        located = []
        for event in _events(curve, begun, direction, ranges, number if turns else None):
            if (end := _crossed(curve, here, there, length, event)) is not None:
                located.append((*curve.locate(here, end, event.value), event))
        for _, at, event in sorted(located, key=lambda each: each[0]):  # a range may end just behind a full turn
            if event.kind is not LimitKind.NONE:
                return FoundLimit(event.kind, at, event.column, False)
            if ahead is None and _is_home(curve, begun, at, features):
                advance = at.q - begun.q
                ahead = _periods_within(curve, ranges, advance, lowest, highest)
                if ahead is None:
                    return FoundLimit(LimitKind.NONE, at, None, True)
                there = there._replace(q=there.q + ahead * advance)
                number += number * ahead
            elif number == MAX_TURNS:
                return FoundLimit(LimitKind.NONE, at, None, False)
            number += 1
        lowest, highest = np.minimum(lowest, there.q), np.maximum(highest, there.q)
        if not turns and abs(there.q[curve.drive]) > FARTHEST:
            return FoundLimit(LimitKind.NONE, there, None, False)
        if abs(there.tangent[curve.drive]) < CREEPS and np.abs(there.q).max() > FARTHEST:
            return FoundLimit(LimitKind.FAR, there, None, False)
        here, length = there, curve.next_length(here, there, length)
    return FoundLimit(LimitKind.NONE, here, None, False)


class _Event(NamedTuple):
    """A function of the pose whose change from positive to negative ends the motion, or completes a full turn."""

    kind: LimitKind
    value: Callable[[CurvePose], float]
    column: int | None = None
    rate: Callable[[CurvePose], float] | None = None
    """Derivative of the value by the arc length; None where the value is not looked at between the ends of a step."""


def _events(
    curve: MotionCurve,
    begun: CurvePose,
    direction: float,
    ranges: Sequence[CoordinateRange],
    number: int | None,
) -> list[_Event]:
    """List what ends the motion that has `begun`; `number` is that of the next full turn of the drive, None for a
    slide."""
    drive, first = curve.drive, begun.q[curve.drive]
    events = [_Event(LimitKind.LOCKS, lambda here: direction * float(here.tangent[drive]))]
    for column, low, high in ranges:
        for sign, end in ((1.0, low), (-1.0, high)):
            if np.isfinite(end):
                events.append(
                    _Event(
                        LimitKind.RANGE,
                        lambda here, c=column, sign=sign, end=end: sign * (float(here.q[c]) - end),
                        column,
                        lambda here, c=column, sign=sign: sign * float(here.tangent[c]),
                    )
                )
    if number is not None:
        events.append(_Event(LimitKind.NONE, lambda here: number * TURN - direction * float(here.q[drive] - first)))
    return events


def _crossed(curve: MotionCurve, here: CurvePose, there: CurvePose, length: float, event: _Event) -> float | None:
    """Find an arc length within a step at which the value of an event is negative; None where it is nowhere.

    A coordinate that turns back within the step may be beyond its range only between the ends of the step: its extremum
    is looked at, too.
    """
    if event.value(there) < 0:
        return length
    if event.rate is None or not event.rate(here) < 0 < event.rate(there):
        return None
    s, extremum = curve.locate(here, length, event.rate)
    return s if event.value(extremum) < 0 else None


def _periods_within(
    curve: MotionCurve,
    ranges: Sequence[CoordinateRange],
    advance: LoopCoordinates,
    lowest: LoopCoordinates,
    highest: LoopCoordinates,
) -> int | None:
    """Count the periods after the first one that surely stay within all ranges; None where all periods do.

    `advance` is by how much the coordinates have turned on in the first period, in which they were between `lowest`
    and `highest` at the ends of steps.
    """
    most, between = np.inf, LONGEST_STEP * max(curve.reach(lowest), curve.reach(highest))
    for (column, low, high), turned in zip(ranges, (advance[each.column] for each in ranges), strict=True):
        if abs(turned) > SAME_POSE:
            left = high - highest[column] if turned > 0 else lowest[column] - low
            most = min(most, (left - between) / abs(turned))
    return None if np.isinf(most) else max(0, int(most))


def _is_home(curve: MotionCurve, begun: CurvePose, at: CurvePose, features: PoseFeatures) -> bool:
    """Tell whether all parts are again where they were when the motion has `begun`, but for idle freedoms."""
    # with the drive at rest: of its own motion and the idle ones together no combination is an idle one alone
    free = [column for column in curve.free if column != curve.drive]
    home, there = features.of(np.stack([begun.q, at.q]), free)
    return bool(np.abs(home - there).max(initial=0.0) <= SAME_POSE)


def moving_column(curve: MotionCurve, here: CurvePose, joints: Sequence[Joint]) -> int:
    """Find the column that moves fastest where the drive locks, those of joints with one coordinate first.

    `joints` are those of the mechanism.
    """
    rates = np.abs(here.tangent)
    moving = [k for k in curve.free if k != curve.drive and rates[k] > _AT_REST * rates.max()]
    return min(moving, key=lambda k: (joints[curve.loops.columns[k][0]].freedoms > 1, -rates[k]))


def why_locked(joints: Mapping[int, Joint], curve: MotionCurve, here: CurvePose) -> tuple[tuple[str, ...], str]:
    """Name the joints that still move where the drive locks, and say how they stand.

    `joints` are those of the loops, by their numbers.
    """
    rates = np.abs(here.tangent)
    moving = [k for k, rate in enumerate(rates) if rate > _AT_REST * rates.max() and k != curve.drive]
    names = tuple(dict.fromkeys(joints[curve.loops.columns[k][0]].name for k in moving))
    screws = curve.loops.travel(here.q).screws[:, moving]
    kinds = [_kind(joints[joint], k) for joint, k in (curve.loops.columns[column] for column in moving)]
    if len(names) == len(moving) == 3 and kinds.count("rotate") == 3:
        return names, f"the axes of {_and(names)} lie in one plane"
    if len(names) == len(moving) == 3 and sorted(kinds) == ["rotate", "rotate", "translate"]:
        slide = names[kinds.index("translate")]
        one, other = (screws[:3, k] for k, kind in enumerate(kinds) if kind == "rotate")
        if np.linalg.norm(np.cross(one, other)) < _AT_REST:
            turning = [name for name in names if name != slide]
            return names, f"the plane of the axes of {_and(turning)} is square to the slide {slide}"
    return names, f"{_and(names)} can move while it is at rest"


def _kind(joint: Joint, coordinate: int) -> str:
    """Look up the kind of a coordinate of a joint: "rotate", "translate" or "screw"."""
    for name, own in zip(joint.movements, coordinate_ranges(joint.movements), strict=True):
        for element in MOVEMENTS[name].elements:
            if own[element.coordinate] == coordinate:
                return element.kind
    raise ValueError(f"joint {joint.name!r} has no coordinate {coordinate}")


def _and(names: Sequence[str]) -> str:
    """Join names for a sentence: "A, B and C"."""
    return listed(names) if len(names) > 8 else " and ".join([", ".join(names[:-1]), names[-1]] if names[1:] else names)


def why_singular(
    mechanism: Mechanism, curve: MotionCurve, home: LoopCoordinates, driven: Sequence[JointCoordinate]
) -> str:
    """Say why no motion of the drive, the first of `driven`, begins at the pose `home`, and what to do.

    At a limit of the drive another coordinate still moves: the fastest one that can be driven in its place, those of
    joints with one coordinate first. None does where branches cross.
    """
    loops, linkage = curve.loops, mechanism.linkage
    name, *held = [_full_name(mechanism, place) for place in driven]
    choices = []
    for column, place in enumerate(loops.columns):
        drives = [place, *driven[1:]]
        begun = None if place in driven else MotionCurve(loops, column, curve.held, curve.idle).begin(1.0, home)
        if begun is None or infeasible_drive(linkage, drives) is not None or undriven_freedoms(linkage, drives):
            continue
        choices.append((mechanism.all_joints[place[0]].freedoms > 1, -abs(begun.tangent[column]), column))
    if not choices:
        why, column = "branches cross there, or nothing moves", loops.columns.index(driven[0])
    else:
        column = min(choices)[-1]
        why = f"{name} is at a limit there, and {_full_name(mechanism, loops.columns[column])} still moves"
    first = float(home[column] * loops.units[column])
    step = [first, first + float(f"{BESIDE * loops.units[column]:.2g}")]
    drive = {_full_name(mechanism, loops.columns[column]): step, **{each: [0.0, 0.0] for each in held}}
    return (
        f"the assembled pose is singular: {why}; assemble the mechanism beside it: "
        f"mechanism.at(mechanism.sweep({drive}), 1)"
    )


def _full_name(mechanism: Mechanism, place: JointCoordinate) -> str:
    """Return the name "joint.coordinate" of a coordinate."""
    joint, k = place
    return mechanism.all_joints[joint].full_names[k]
