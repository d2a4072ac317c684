"""Close the loops of an export whose own pose is open, so that its parts and joints stand in an assembled pose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from jaxkin._names import listed
from jaxkin.assembly.exported import Constraint, Exported
from jaxkin.geometry.part import Part, moved
from jaxkin.joints.combine import Chain
from jaxkin.joints.evidence import BY_HAND
from jaxkin.joints.joint import Joint
from jaxkin.linkage.coupled import counted_from, coupled
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.reassembly import Reassembly, close
from jaxkin.topology.structure import structure

ROUNDING = 1e-12
"""Radians, and lengths over the largest coordinate of a joint, up to which parts of a closed pose are not moved: the
places of a file are sums of its numbers along two chains, which differ by roundings."""


def closed_export(
    parts: Sequence[Part], exported: Exported, frames_2: Sequence[np.ndarray], unit: str
) -> tuple[tuple[Part, ...], Exported]:
    """Move the parts of an export to a pose in which the two frames of each joint coincide as its movement allows.

    `frames_2` are the frames (frames, 4, 4) of each constraint on the side of its second part; those of the first part
    are in its chain. Motors, locked coordinates and those that others follow with an offset are held where the file has
    them, if the loops close so. Limits and values of joints are counted on. Notes tell how far parts were moved; where
    the loops do not close, nothing is moved, each joint is taken as it stands on its first part, and a note tells how
    far they are open.
    """
    joints = [_joint(each, frames) for each, frames in zip(exported.constraints, frames_2, strict=True)]
    couplings = counted_from(exported.couplings, joints, exported.joint_values)
    obeyed = not any(float(coupling.offset) for coupling in couplings)
    if obeyed and all(np.array_equal(each.frames_1, each.frames_2) for each in joints):
        return tuple(parts), exported
    described = [(each.name, *each.parts) for each in joints]
    linkage = Linkage.of(joints, structure([part.name for part in parts], described, exported.fixed))
    linkage = coupled(linkage, couplings)
    names = [(each, number, name) for each in joints for number, name in enumerate(each.full_names)]
    motors = [name for each, _, name in names if {each.name, name} & {*exported.motors}]
    locked = [name for each, number, name in names if each.limits and each.limits[number] == (0.0, 0.0)]
    leaders = _leaders(exported)
    leading = [name for each, _, name in names if {each.name, name} & leaders]
    held = [*dict.fromkeys([*motors, *locked])]
    found = _closed(Mechanism(linkage, unit), [*dict.fromkeys([*held, *leading])], held, motors, [])
    if not found.closed:
        note = f"the loops of the file do not close, and each joint is taken as it stands on its first part: {found}"
        return tuple(parts), replace(exported, notes=(*exported.notes, note))
    size = max((float(np.abs(each.frames_1[:, :3, 3]).max()) for each in joints), default=0.0)
    if all(move.length <= ROUNDING * size and move.angle <= ROUNDING for move in found.moves.values()):
        return tuple(parts), exported
    made = found.mechanism.joints
    constraints = tuple(_placed(each, made[each.name], found) for each in exported.constraints)
    moving = [
        name
        for each in joints
        for name in motors
        if name.startswith(f"{each.name}.") and found.coordinates[each.name].any()
    ]
    notes = [f"the pose of the file is open; {found}", *found.mechanism.alignment]
    if moving:
        notes.append(f"to close the loops, motors were moved from the zero of the file: {listed(moving)}")
    beyond = [each.name for each in constraints if any(low > 0 or high < 0 for low, high in each.limits)]
    if beyond:
        notes.append(f"the assembled pose is beyond the limits of {listed(beyond)}")
    there = tuple(moved(part, found.places[part.name]) for part in parts)
    return there, replace(exported, constraints=constraints, notes=(*exported.notes, *notes))


def _leaders(exported: Exported) -> set[str]:
    """Name the coordinates that others follow with an offset, and that follow none: a coupling gives its first one."""
    following = {coupling.coordinates[0] for coupling in exported.couplings}
    shifted = [coupling for coupling in exported.couplings if float(coupling.offset)]
    return {name for coupling in shifted for name in coupling.coordinates[1:]} - following


def _closed(mechanism: Mechanism, *ways: list[str]) -> Reassembly:
    """Close the loops in the first way that closes them, each a list of coordinates that are held; else as in the first
    of all."""
    failed: list[Reassembly] = []
    for number, held in enumerate(ways):
        if held not in ways[:number]:
            found = close(mechanism, held, look_around=False)
            if found.closed:
                return found
            failed.append(found)
    return failed[0]


def _joint(each: Constraint, frames_2: np.ndarray) -> Joint:
    """Make the joint of a constraint, its two frames where they are."""
    movements, pitch = tuple(each.chain.movements), np.asarray(each.pitch, float)
    return Joint(each.name, each.parts, each.kind, movements, each.chain.frames, frames_2, pitch, BY_HAND, each.limits)


def _placed(each: Constraint, made: Joint, found: Reassembly) -> Constraint:
    """Place the constraint in the closed pose."""
    q = found.coordinates[each.name]
    values = each.values or (0.0,) * len(q)
    return replace(
        each,
        chain=Chain(each.chain.movements, np.asarray(made.frames_1)),
        limits=made.limits,
        values=tuple(value + float(by) for value, by in zip(values, q, strict=True)) if np.any(q) else each.values,
    )
