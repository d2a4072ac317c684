"""Joints that may be others than they are taken for."""

from __future__ import annotations

from collections.abc import Collection

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.evidence import Doubt
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.mobility import moving_coordinates
from jaxkin.mobility.open_loops import opening

_COORDINATES = {row.pair: row.coordinates for row in MOVEMENTS.values() if row.pair}


def doubts(linkage: Linkage) -> list[tuple[Joint, Doubt]]:
    """Find the joints in doubt, with what they may be, the least certain first; but for those whose other reading only
    takes motions that are idle, or that loops stop."""
    found = [(joint, joint.evidence.doubt) for joint in linkage.joints if joint.evidence and joint.evidence.doubt]
    if found and opening(linkage) is None:
        useful = moving_coordinates(linkage)
        found = [(joint, doubt) for joint, doubt in found if not _takes_useless_ones(joint, doubt.kind, useful)]
    return sorted(found, key=lambda each: each[1].seen.share)


def _takes_useless_ones(joint: Joint, kind: JointKind, useful: Collection[str]) -> bool:
    """Tell whether a joint of another kind lacks coordinates of this one, and none of use."""
    lost = {f"{joint.name}.{name}" for name in joint.coordinates if name not in _COORDINATES[kind]}
    return bool(lost) and lost.isdisjoint(useful)
