"""Parts that only spin: screws, pins and washers, which contact analysis reads as hinges.

Such a part can turn about an axis while all others rest, perhaps slide along it or over a face across it, and can do
nothing else; nothing hangs on it, nor would anything move more freely without it. And its solid is round about that
axis: a lever at the end of a chain also turns alone, but that it has no work to do would be a guess, as it would be of
parts without solids.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Pose, frame
from jaxkin.joints.combine import LOWER_PAIRS
from jaxkin.joints.from_contacts import forwards
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.screws import freedoms
from jaxkin.mobility.twists import constraints, middle

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

MIN_ROUNDNESS = 0.84
"""Least over greatest half width of a part that is round about an axis: a hexagon has 0.866, a square 0.707."""
TWIST_TOLERANCE = 1e-6
"""Entries of unit twists that are equal: far above rounding, far below design."""


@dataclass(frozen=True, eq=False)
class Spin:
    """What a part can do by itself."""

    kind: JointKind
    movement: str
    """The lower pair that it amounts to: revolute, cylindrical or planar."""
    frame: Pose
    """Of that pair, z along the axis of the turn."""
    carrier: str = ""
    """The neighbour that it stays on: relative to it the part never does anything else."""

    @property
    def freedoms(self) -> int:
        """How many freedoms are the part's alone."""
        return freedoms([self.movement])


def spins(mechanism: Mechanism) -> tuple[dict[str, Spin], dict[str, Spin]]:
    """The round parts that can spin while all others rest: those on one neighbour, their carrier, and those that
    several neighbours hold, as yet without a carrier, of which some may have work to do."""
    solids = {part.name: part for part in mechanism.solids}
    around: dict[str, list[Joint]] = defaultdict(list)
    for each in mechanism.all_joints:
        for part in each.parts:
            around[part].append(each)
    alone: dict[str, Spin] = {}
    held: dict[str, Spin] = {}
    size = middle(mechanism.all_joints)[1]  # the joints of one part may all be in one place
    for part, joints in around.items():
        if part in mechanism.fixed or part not in solids or (spin := _spin(joints, size)) is None:
            continue
        if not _is_round(solids[part], spin):
            continue
        neighbours = dict.fromkeys(p for joint in joints for p in joint.parts if p != part)
        if len(neighbours) > 1:
            held[part] = spin
        else:
            alone[part] = replace(spin, carrier=next(iter(neighbours)))
    return alone, held


def _spin(joints: Sequence[Joint], size: float) -> Spin | None:
    """What a part can do while its neighbours rest, if that is a turn, perhaps with slides along or across its axis."""
    centre, _ = middle(joints)
    forbidden = np.concatenate([constraints(joint, centre, size) for joint in joints])
    _, strengths, directions = np.linalg.svd(forbidden, full_matrices=True)
    free = directions[int((strengths > TWIST_TOLERANCE).sum()) :]
    _, turns, mixes = np.linalg.svd(free[:, :3].T, full_matrices=True)
    if int((turns > TWIST_TOLERANCE).sum()) != 1:
        return None
    turn, slides = mixes[0] @ free, (mixes[1:] @ free)[:, 3:]
    axis = turn[:3] / np.linalg.norm(turn[:3])
    along = np.abs(slides @ axis)
    point = np.cross(axis, turn[3:]) / np.linalg.norm(turn[:3])
    pitched = len(free) == 1 and abs(turn[3:] @ axis) > TWIST_TOLERANCE
    if len(free) <= 2 and np.all(along > 1 - TWIST_TOLERANCE) and not pitched:
        kind, movement = LOWER_PAIRS[1, len(free) - 1]
    elif len(free) == 3 and np.all(along < TWIST_TOLERANCE):
        (kind, movement), point = LOWER_PAIRS[1, 2], np.zeros(3)
    else:
        return None
    return Spin(kind, movement, forwards(frame(centre + size * point, axis)))


def _is_round(part: Part, spin: Spin) -> bool:
    """Whether the outline of a part, seen along an axis, is about the axis all around; about its middle, if it may
    slide across the axis."""
    from scipy.spatial import ConvexHull, QhullError

    outline = (part.triangles.reshape(-1, 3) - spin.frame[:3, 3]) @ spin.frame[:3, :2]
    try:
        hull = ConvexHull(outline)
    except QhullError:  # a sheet seen from its edge
        return False
    corners = outline[hull.vertices]
    centre = (
        (corners.min(axis=0) + corners.max(axis=0)) / 2
        if MOVEMENTS[spin.movement].turns_and_slides == (1, 2)
        else np.zeros(2)
    )
    inner = -(hull.equations[:, :2] @ centre + hull.equations[:, 2])
    return bool(inner.min() > MIN_ROUNDNESS * np.linalg.norm(corners - centre, axis=1).max())
