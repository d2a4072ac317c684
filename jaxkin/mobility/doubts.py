"""Joints that may be others than they are taken for."""

from __future__ import annotations

from collections.abc import Set as AbstractSet

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.evidence import Doubt
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.first_order import without
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.mobility.mobility import moving_columns, moving_coordinates, names
from jaxkin.mobility.open_loops import left_open

_COORDINATES = {row.subgroup_joint: row.coordinates for row in MOVEMENTS.values() if row.subgroup_joint}


def doubts(linkage: Linkage) -> list[tuple[Joint, Doubt]]:
    """Find the joints in doubt, with what they may be, the least certain first; but for those whose other reading only
    takes motions that are idle, or that loops stop, or locks a loop that moves, as that of a piston would."""
    found = [(joint, joint.evidence.doubt) for joint in linkage.joints if joint.evidence and joint.evidence.doubt]
    if found and left_open(linkage) is None:
        useful = moving_coordinates(linkage)
        found = [(joint, doubt) for joint, doubt in found if _is_open(linkage, joint, doubt.kind, useful)]
    return sorted(found, key=lambda each: each[1].seen.share)


def _is_open(linkage: Linkage, joint: Joint, kind: JointKind, useful: AbstractSet[str]) -> bool:
    """Tell whether a joint may be of another kind: it lacks no coordinates then, or some that are `useful`, without
    which its loops still have useful motions."""
    lost = {f"{joint.name}.{name}" for name in joint.coordinates if name not in _COORDINATES[kind]}
    if not lost:
        return True
    for loops in loop_freedoms(linkage):
        columns = [column for column in range(len(loops.columns)) if {*names(linkage, loops, [column])} & lost]
        if columns:
            left = without(loops.motions, columns, loops.thresholds)
            return not lost.isdisjoint(useful) and not useful.isdisjoint(
                names(linkage, loops, moving_columns(loops, left))
            )
    return not lost.isdisjoint(useful)
