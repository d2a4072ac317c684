"""Tell in words which drives the loops of a mechanism cannot follow, which are at a dead point in the assembled pose,
and which freedoms a drive leaves undriven."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from jaxkin._names import counted, listed
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.first_order import independent
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.loop_freedoms import LoopFreedoms, loop_freedoms
from jaxkin.mobility.mobility import drivable, independent_subset, names, outside_loops

AT_REST = 1e-6
"""Rate of a driven coordinate, in a motion of unit norm, below which the assembled pose is its dead point. The pose of
a limit that was found to rounding, 1e-15, has the root of that."""


@dataclass(frozen=True)
class InfeasibleDrive:
    """A drive that the loops cannot follow."""

    why: str
    """The reason in words, with what can be driven instead."""
    immobile: tuple[str, ...]
    """The rows of parts of loops that have no freedom at all; empty where another drive is feasible."""


def infeasible_drive(linkage: Linkage, driven: Sequence[JointCoordinate]) -> InfeasibleDrive | None:
    """Tell why the loops cannot follow a drive of these coordinates; None where they can, and where this is uncertain.

    A drive is infeasible only if its rates cannot be chosen independently, neither at the assembled pose nor at a pose
    beside it. At a singular pose, where the motion may branch, the solver decides. The coordinates that are proposed
    instead can be driven at both poses, if there are such coordinates. Of a target, all that it prescribes is proposed
    or nothing, since no part of it can be given alone.
    """
    for found, columns in _driven_groups(linkage, driven):
        if not _follows(found, columns):
            return _why_not(linkage, found, columns)
    return None


def _why_not(linkage: Linkage, found: LoopFreedoms, columns: Sequence[int]) -> InfeasibleDrive:
    """Say why loops cannot follow a drive of these columns.

    They have no freedom at all, or none that moves one of the columns, or fewer than the drive asks for.
    """
    if not len(found.motions):
        given = listed(names(linkage, found, columns))
        immobile = tuple(dict.fromkeys(row for pair in found.ends.values() for row in pair))
        if set(immobile) <= {found.fixed}:
            return InfeasibleDrive(f"{given} cannot be driven: what it joins is fixed on both sides", ())
        return InfeasibleDrive(f"{given} cannot be driven: {_loops_of(found)} has no freedom", immobile)
    every, targets = _choices(found), _targets(linkage, found, columns)
    choices = [group for group in every if not _is_target(linkage, found, group[0])]
    met = f"; jk.inverse meets the target {' and '.join(targets)} as nearly as the loops let it" if targets else ""
    movable = {column for group in every for column in group}
    if stuck := [column for column in columns if column not in movable]:
        return InfeasibleDrive(_why_stuck(linkage, found, stuck, targets, choices) + met, ())
    return InfeasibleDrive(_why_too_many(linkage, found, columns, targets, choices) + met, ())


def _why_stuck(
    linkage: Linkage,
    found: LoopFreedoms,
    stuck: Sequence[int],
    targets: Mapping[str, list[int]],
    choices: Sequence[tuple[int, ...]],
) -> str:
    """Say that no freedom of the loops moves the columns `stuck`, and which `choices` can be driven."""
    whose = {column: name for name, group in targets.items() for column in group}
    said = [f"a direction of {whose[c]}" if c in whose else names(linkage, found, [c])[0] for c in stuck]
    said = list(dict.fromkeys(said))
    what = "has no freedom left to it" if len(said) == 1 else "have no freedom left to them"
    others = _or(linkage, found, _surest(found, choices))
    return f"{listed(said)} {what} by the loops" + (f"; what can be driven is {others}" if others else "")


def _why_too_many(
    linkage: Linkage,
    found: LoopFreedoms,
    columns: Sequence[int],
    targets: Mapping[str, list[int]],
    choices: Sequence[tuple[int, ...]],
) -> str:
    """Say how many freedoms the loops have for a drive of these columns, and what to drive instead."""
    whole = _independent_targets(found, targets)
    of_targets = [column for name in whole for column in targets[name]]
    order = [column for group in choices for column in group]
    joints = sorted((column for column in columns if column in order), key=order.index)
    kept = independent_subset(found, joints, of_targets)
    freedoms = counted(len(found.motions), "freedom")
    if (followed := independent(found.motions, columns, found.thresholds)) < len(found.motions):
        freedoms += f", {followed} of them for these"
    others = [group for group in _surest(found, choices) if not set(group) & set(kept)]
    if kept or whole:
        instead = f"drive only {listed([*whole, *names(linkage, found, sorted(kept))])}"
        if len(kept) == 1 and not whole and others:
            instead += f", or one of {_or(linkage, found, others)}"
    elif len(found.motions) == 1:
        instead = f"drive one of {_or(linkage, found, others)}"
    else:
        instead = f"drive {listed(names(linkage, found, independent_subset(found, order)))}"
    given = listed(names(linkage, found, columns))
    return f"driven {given}, but {_loops_of(found)} has {freedoms}: {instead}"


def _follows(found: LoopFreedoms, columns: Sequence[int]) -> bool:
    """Tell whether the rates of these columns can be chosen independently, at the assembled pose or beside it."""
    return any(
        independent(motions, columns, found.thresholds) == len(columns)
        for motions in (found.assembled_motions, found.motions)
    )


def _is_target(linkage: Linkage, found: LoopFreedoms, column: int) -> bool:
    """Tell whether a column is a coordinate of the joint that stands for a target."""
    evidence = linkage.joints[found.columns[column][0]].evidence
    return evidence is not None and evidence.kind is EvidenceKind.TARGET


def _targets(linkage: Linkage, found: LoopFreedoms, columns: Sequence[int]) -> dict[str, list[int]]:
    """List the driven columns of each target by the name of its joint."""
    targets: dict[str, list[int]] = {}
    for column in columns:
        if _is_target(linkage, found, column):
            targets.setdefault(linkage.joints[found.columns[column][0]].name, []).append(column)
    return targets


def _independent_targets(found: LoopFreedoms, targets: Mapping[str, list[int]]) -> list[str]:
    """Greedily select targets all of whose rates can be chosen independently."""
    taken: list[int] = []
    chosen: list[str] = []
    for name, group in targets.items():
        if independent(found.motions, [*taken, *group], found.thresholds) == len(taken) + len(group):
            taken += group
            chosen.append(name)
    return chosen


def _choices(found: LoopFreedoms) -> list[tuple[int, ...]]:
    """List the groups of columns that can be driven, a single column or the angles of a ball.

    Groups that can be driven at the assembled pose too come first.
    """
    groups = dict.fromkeys(found.driven_together.values())
    movable = [group for group in groups if independent(found.motions, group, found.thresholds) == len(group)]
    surest = _surest(found, movable)
    return [*surest, *(group for group in movable if group not in surest)]


def _surest(found: LoopFreedoms, choices: Sequence[tuple[int, ...]]) -> Sequence[tuple[int, ...]]:
    """Select the groups that can be driven at the assembled pose too (not a slide at its dead point); all if none
    can."""
    motions = found.assembled_motions
    return [group for group in choices if independent(motions, group, found.thresholds) == len(group)] or choices


def _or(linkage: Linkage, found: LoopFreedoms, groups: Sequence[Sequence[int]]) -> str:
    """List the names of columns to choose from, the angles of a ball together."""
    return listed([" with ".join(names(linkage, found, group)) for group in groups])


def dead_point(linkage: Linkage, driven: Sequence[JointCoordinate]) -> str | None:
    """Tell that driven coordinates are at a dead point in the assembled pose, and what to do; None where none is.

    There the loops move while the drive is at rest to first order, and for each input beside it there are two poses or
    none: which of two the motion goes to, and whether there is one, the drive does not say.
    """
    for found, columns in _driven_groups(linkage, driven):
        motions = found.assembled_motions
        moving = np.linalg.svd(motions[:, list(columns)], compute_uv=False) > AT_REST
        if moving.sum() == len(columns) or not _follows(found, columns):
            continue
        told = (
            f"the assembled pose is a dead point of {listed(names(linkage, found, columns))}, where two branches meet"
        )
        for group in _choices(found):
            if len(group) == 1 and group[0] not in columns and np.abs(motions[:, group[0]]).max() > AT_REST:
                (name,) = names(linkage, found, group)
                beside = f"mechanism.at(mechanism.sweep({{{name!r}: [0, 0.01]}}), 1)"
                return f"{told}: drive {name}, or assemble the mechanism beside it, as {beside} does"
        return f"{told}: assemble the mechanism beside it, as mechanism.at(motion, index) does"
    return None


def undriven_freedoms(linkage: Linkage, driven: Sequence[JointCoordinate]) -> tuple[str, ...]:
    """Name the coordinates that a drive leaves free in the loops that it moves, without those of idle freedoms."""
    spinning = [part.name for part in linkage.spinning]
    return tuple(
        name
        for found, columns in _driven_groups(linkage, driven)
        for name in names(linkage, found, drivable(linkage, found, columns, spinning))
    )


def resting_freedoms(linkage: Linkage, driven: Collection[str]) -> tuple[str, ...]:
    """Name the coordinates that a drive ("joint.coordinate") leaves free: in loops, without those of idle freedoms, and
    outside of loops, without those of parts that only spin."""
    free = undriven_freedoms(linkage, [coordinate(linkage, name) for name in driven])
    return (*free, *(name for name in outside_loops(linkage) if name not in driven))


def _loops_of(found: LoopFreedoms) -> str:
    """Name the loops of a loop group by its parts."""
    parts = dict.fromkeys(part for pair in found.ends.values() for part in pair)
    return f"the mechanism of {listed([part for part in parts if part != found.fixed])}"


def _driven_groups(linkage: Linkage, driven: Sequence[JointCoordinate]) -> Iterator[tuple[LoopFreedoms, list[int]]]:
    """Yield the loop groups that hold driven coordinates, with the columns of these, if their loops can be closed."""
    for found in loop_freedoms(linkage):
        columns = [column for column, owner in enumerate(found.columns) if owner in driven]
        if columns and found.closes:
            yield found, columns
