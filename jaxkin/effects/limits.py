"""The reachable range of a drive about the assembled pose: where the mechanism locks, or a joint range ends.

`limits` checks what is asked. `limit_search.find_limit` follows the drive to either side, along a `MotionCurve` of
closed poses, until a function of the pose changes its sign: the rate of the drive, or the distance of a coordinate from
an end of its range. The rest puts into words what was found.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxkin._arguments import by_name, check_known, check_mechanism, several
from jaxkin.effects.determined_drive import check_determined, home_of_drive
from jaxkin.effects.limit_of_design import limit_equation
from jaxkin.effects.limit_search import (
    CoordinateRange,
    FoundLimit,
    LimitKind,
    find_limit,
    moving_column,
    why_locked,
    why_singular,
)
from jaxkin.effects.limits_result import Limit, Limits
from jaxkin.effects.mode_search import PoseFeatures
from jaxkin.effects.motion_curve import MotionCurve
from jaxkin.geometry.movements import is_length
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.coordinates import coordinate, coordinates
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.joint_limits import rounding
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mobility.home_pose import HomeRows
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.topology.structure import LoopGroup

Ranges = Mapping[JointCoordinate, tuple[float, float]]
"""The lowest and the highest displacement of coordinates, from the assembled pose."""


def limits(
    mechanism: Mechanism,
    drive: str,
    *,
    ranges: Mapping[str, Sequence[float]] | None = None,
    hold: Iterable[str] = (),
) -> Limits:
    """Find the range of a drive that a motion from the assembled pose can reach.

    `drive` is a "joint" or "joint.coordinate". Its range ends where the mechanism locks: where the rate of the drive
    is zero while other joints still move; or where a coordinate is at the end of its range: that of `ranges`, a pair of
    displacements from the assembled pose a coordinate, in radians or lengths (-inf and inf for none), or of the
    `limits` of its joint. Where slides grow without end while it hardly moves, it ends at a slide of a hundred sizes.
    Of a mechanism with several freedoms, the coordinates in `hold` stay as assembled.

    The motion is followed by its arc length, and limits are found to rounding: some 1e-13 radians, or lengths over the
    size; 1e-10 beside poses in which branches nearly cross, and 1e-6 where they cross in the limit itself, as where a
    rhombus folds up. Other poses in which branches cross, or come nearer than 1e-3, are passed straight on.

    With new lengths the motion is followed from where the loops close with the drive at 0, or as near to that as they
    do; all displacements and ranges count from the assembled pose, as those of a sweep.

    Raises ValueError for unknown names, for ranges that do not hold the assembled pose, where freedoms are left, where
    the loops cannot be closed or are singular there, and inside `jit`, `vmap` and `grad`.
    """
    check_mechanism(mechanism, "limits")
    check_known("limits", "jk.limits", mechanism)
    linkage = mechanism.linkage
    if not isinstance(drive, str):
        raise ValueError(f"limits are those of one coordinate, such as {mechanism.all_joints[0].name!r}, got {drive!r}")
    hold = [drive, *several(hold, "hold", "coordinates")]
    driven = coordinates(linkage, hold)
    name, place = next(iter(driven.items()))
    check_determined(mechanism, driven, "limits", f"jk.limits({{}}, {drive!r})", "hold")
    home = home_of_drive(mechanism, driven, nearest=place)
    given = _ranges(mechanism, home, ranges or {})
    group = next((each for each in linkage.structure.loop_groups if place[0] in each.joints), None)
    if group is None:
        return _limits_of_joint(mechanism, name, place, home, given)
    curve = _curve(linkage, group, list(driven.values()))
    lower, upper = _ends(mechanism, curve, home, list(driven.values()), given)
    ends = [_limit(mechanism, list(driven), curve, home, *end) for end in ((lower, -1.0), (upper, 1.0))]
    return _limits(mechanism, name, place, home, ends[0], ends[1], upper.repeats and lower.repeats)


def _curve(linkage: Linkage, group: LoopGroup, driven: Sequence[JointCoordinate]) -> MotionCurve:
    """Make the curve along which the first of `driven` moves the loops of a group, with the others at rest."""
    loops = closed_loops(linkage, group)
    freedoms = loop_freedoms(linkage)[linkage.structure.loop_groups.index(group)]
    drive, *held = (loops.columns.index(each) for each in driven if each in loops.columns)
    return MotionCurve(loops, drive, held, idle=len(freedoms.motions) - 1 - len(held))


def _ends(
    mechanism: Mechanism, curve: MotionCurve, home: HomeRows, driven: Sequence[JointCoordinate], ranges: Ranges
) -> tuple[FoundLimit, FoundLimit]:
    """Follow the drive, the first of `driven`, to its lower and its upper limit.

    They are one where the motion repeats. ValueError where the home pose is singular.
    """
    loops = curve.loops
    start = np.array([home[joint][k] for joint, k in loops.columns]) / loops.units
    inside = {loops.columns.index(each): ends for each, ends in ranges.items() if each in loops.columns}
    scaled = [CoordinateRange(k, low / loops.units[k], high / loops.units[k]) for k, (low, high) in inside.items()]
    turns, features = not _is_length(mechanism, driven[0]), PoseFeatures(loops, curve.idle)
    found: list[FoundLimit] = []
    for direction in (1.0, -1.0):
        begun = curve.begin(direction, start)
        if begun is None:
            raise ValueError(why_singular(mechanism, curve, start, driven))
        found.append(find_limit(curve, begun, direction, scaled, turns, features))
        if found[-1].repeats:
            break
    return found[-1], found[0]


def _ranges(mechanism: Mechanism, home: HomeRows, given: Mapping[str, Sequence[float]]) -> Ranges:
    """List the ranges of coordinates: those of joints, replaced by those given.

    Raises ValueError where they exclude the home pose.
    """
    found = {
        (number, k): (float(low), float(high))
        for number, joint in enumerate(mechanism.all_joints)
        for k, (low, high) in enumerate(joint.limits)
    }
    for key, ends in by_name(given, "ranges", "{'A': (-1.0, 1.0)}").items():
        place = coordinate(mechanism.linkage, key)
        try:
            low, high = (float(end) for end in ends)
        except (TypeError, ValueError):
            raise ValueError(f"the range of {key!r} must be two numbers, as in (-1.0, 1.0), got {ends!r}") from None
        if not low <= high:
            raise ValueError(f"the range of {key!r} must rise, as in (-1.0, 1.0), got {ends!r}")
        found[place] = low, high
    for (number, k), (low, high) in found.items():
        joint = mechanism.all_joints[number]
        slack, at = rounding(mechanism.all_joints, is_length(joint.coordinates[k])), float(home[number][k])
        if not low - slack <= at <= high + slack:
            pose = "the assembled pose, 0," if not at else f"the pose in which the loops close, {at:.6g},"
            raise ValueError(
                f"{pose} is not in the range {low:g} to {high:g} of {joint.full_names[k]}: ranges count from the "
                "assembled pose; assemble the mechanism within, as mechanism.at(motion, index) does, or give another "
                "range with ranges="
            )
        found[number, k] = min(low, at), max(high, at)
    return found


def _is_length(mechanism: Mechanism, place: JointCoordinate) -> bool:
    joint, k = place
    return is_length(mechanism.all_joints[joint].coordinates[k])


def _limits_of_joint(mechanism: Mechanism, name: str, place: JointCoordinate, home: HomeRows, given: Ranges) -> Limits:
    """Make the limits of a drive that is in no loop: the range of its joint."""
    joint, k = place
    ends = []
    for value in given.get(place, (-np.inf, np.inf)):
        rows = [row.copy() for row in home]
        if not np.isfinite(value):
            ends.append(Limit(value, LimitKind.NONE, (), "no limit: it is in no loop", {}))
            continue
        rows[joint][k] = value
        shown = dict(zip(mechanism.joints, rows, strict=True))
        ends.append(
            Limit(value, LimitKind.RANGE, (mechanism.all_joints[joint].name,), f"the range of {name} ends", shown)
        )
    length = _is_length(mechanism, place)
    full_turn = not length and not any(end.coordinates for end in ends)
    return _limits(mechanism, name, place, home, ends[0], ends[1], full_turn)


def _limit(
    mechanism: Mechanism, driven: Sequence[str], curve: MotionCurve, home: HomeRows, end: FoundLimit, side: float
) -> Limit:
    """Say in words what ends the range of the first of `driven` on one side, -1 or 1, and where all joints are."""
    loops, joints, name = curve.loops, mechanism.all_joints, driven[0]
    q = end.here.q * loops.units
    at = float(q[curve.drive])
    if end.kind is LimitKind.NONE:
        reason = "the motion repeats" if end.repeats else f"no limit up to {at:.4g}, where the search ended"
        return Limit(side * np.inf, end.kind, (), reason, {})
    shown = {joint.name: row.copy() for joint, row in zip(joints, home, strict=True)}
    for (joint, k), value in zip(loops.columns, q, strict=True):
        shown[joints[joint].name][k] = value
    if end.kind is LimitKind.LOST:
        return Limit(at, end.kind, (), "the motion was lost at a singular pose", shown)
    if end.kind is LimitKind.FAR:
        farthest = int(np.abs(end.here.q).argmax())
        joint, k = loops.columns[farthest]
        reason = f"{joints[joint].full_names[k]} goes on beyond {abs(q[farthest]):.4g}, and {name} hardly any farther"
        return Limit(at, end.kind, (joints[joint].name,), reason, shown)
    if end.kind is LimitKind.RANGE and end.column is not None:
        joint, k = loops.columns[end.column]
        owner = joints[joint]
        of = owner.full_names[k]
        reason = f"the range of {of} ends, at {q[end.column]:.6g}"
        equation = None if of == name else limit_equation(mechanism, driven, of, shown, None)
        return Limit(at, end.kind, (owner.name,), reason, shown, equation)
    moving, why = why_locked({index: joints[index] for index in loops.loop_group.joints}, curve, end.here)
    column = moving_column(curve, end.here, joints)
    joint, k = loops.columns[column]
    equation = limit_equation(mechanism, driven, joints[joint].full_names[k], shown, side)
    return Limit(at, end.kind, moving, f"{name} locks: {why}", shown, equation)


def _limits(
    mechanism: Mechanism, name: str, place: JointCoordinate, home: HomeRows, lower: Limit, upper: Limit, full_turn: bool
) -> Limits:
    """Make the result, with the motion of the limits that there are and the home pose between them."""
    at_home = {joint.name: row for joint, row in zip(mechanism.all_joints, home, strict=True)}
    poses = [*([lower.coordinates] if lower.coordinates else []), at_home]
    poses += [upper.coordinates] if upper.coordinates else []
    joint, k = place
    rows = tuple(jnp.asarray(np.stack([pose[each] for pose in poses]), float) for each in mechanism.joints)
    residual = jnp.asarray([_residual(mechanism, pose) for pose in poses], float)
    inputs = {name: rows[joint][:, k]}
    motion = Motion(mechanism, inputs, rows, jnp.zeros(len(poses), jnp.int32), residual, swept=False)
    unit = mechanism.unit if _is_length(mechanism, place) else "rad"
    return Limits(name, lower, upper, full_turn, motion, unit)


def _residual(mechanism: Mechanism, pose: Mapping[str, Float[np.ndarray, " _"]]) -> float:
    """Compute the square root of Eq. 12 over all loops in a pose."""
    linkage, squares = mechanism.linkage, 0.0
    for group in linkage.structure.loop_groups:
        loops = closed_loops(linkage, group)
        q = np.array([pose[mechanism.all_joints[joint].name][k] for joint, k in loops.columns])
        squares += loops.travel(q / loops.units).residual_norm ** 2
    return squares**0.5
