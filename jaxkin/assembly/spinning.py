"""Parts that only spin: screws, pins and washers, which look like hinges to the contact analysis.

Such a part can turn about an axis while all other parts rest, perhaps also slide along the axis or over a face across
it, and can do nothing else; it carries no other part and constrains none. Its solid is round about that axis, or it is
a loose ball, which turns about its middle. A lever at the end of a chain also turns alone, but is not round: that it
has no function would be a guess, and so it would be for parts without solids.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.outline import roundness
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Transform, frame
from jaxkin.geometry.surfaces import Cylinder
from jaxkin.joints.combine import SUBGROUP_JOINTS
from jaxkin.joints.from_contacts import forwards
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.screws import freedoms
from jaxkin.mobility.twists import constraints, middle

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

MIN_ROUNDNESS = 0.84
"""Smallest ratio of least to greatest half width of a part that is round about an axis: a hexagon has 0.866, a square
0.707."""
MIN_BUSH = 0.95
"""The same of a bush, and of a ball in all directions: round but for its tessellation."""
BALL_DIRECTIONS = np.array([each for each in product((-1.0, 0.0, 1.0), repeat=3) if any(each)])
"""Directions in which a ball reaches equally far: those to the faces, edges and corners of a cube."""
BALL_DIRECTIONS /= np.linalg.norm(BALL_DIRECTIONS, axis=1, keepdims=True)
MAX_PLAY = 0.1
"""Difference of the radii of a bush and of the shaft that turns in it, over that of the shaft, at most."""
TWIST_TOLERANCE = 1e-6
"""Entries of unit twists below this count as zero: far above rounding, far below design."""


@dataclass(frozen=True, eq=False)
class Spin:
    """The motion of a part that can move while all other parts rest."""

    kind: JointKind
    movement: str
    """Key of the movement of the joint: revolute, cylindrical, planar or spherical."""
    frame: Transform
    """Frame of that joint, z along the axis of rotation; of a ball at its middle, with the axes of the world."""
    carrier: str = ""
    """The neighbour that the part stays on: relative to the carrier it has this motion only."""

    @property
    def freedoms(self) -> int:
        """Number of freedoms of the motion."""
        return freedoms([self.movement])


def spins(mechanism: Mechanism) -> tuple[dict[str, Spin], dict[str, Spin]]:
    """Find the round parts that can spin while all others rest: those on one neighbour, and those on several.

    The one neighbour is the carrier. Parts on several neighbours have no carrier yet, and some may hold other parts.
    """
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
        if not _is_round(solids[part], spin) or _turns_on_a_ring(mechanism, joints, part, spin):
            continue
        neighbours = dict.fromkeys(p for joint in joints for p in joint.parts if p != part)
        if len(neighbours) > 1:
            held[part] = spin
        else:
            alone[part] = replace(spin, carrier=next(iter(neighbours)))
    return alone, held


def _spin(joints: Sequence[Joint], size: float) -> Spin | None:
    """Find the motion of a part whose neighbours rest; None if it is no turn, perhaps with slides along or across, and
    no roll about one point."""
    centre, _ = middle(joints)
    forbidden = np.concatenate([constraints(joint, centre, size) for joint in joints])
    _, strengths, directions = np.linalg.svd(forbidden, full_matrices=True)
    free = directions[int((strengths > TWIST_TOLERANCE).sum()) :]
    _, turns, mixes = np.linalg.svd(free[:, :3].T, full_matrices=True)
    count = int((turns > TWIST_TOLERANCE).sum())
    if count == len(free) == 3:
        point = _centre_of_turns(free)
        return None if point is None else Spin(*SUBGROUP_JOINTS[3, 0], frame(centre + size * point, np.eye(3)[2]))
    if count != 1:
        return None
    turn, slides = mixes[0] @ free, (mixes[1:] @ free)[:, 3:]
    axis = turn[:3] / np.linalg.norm(turn[:3])
    along = np.abs(slides @ axis)
    point = np.cross(axis, turn[3:]) / np.linalg.norm(turn[:3])
    pitched = len(free) == 1 and abs(turn[3:] @ axis) > TWIST_TOLERANCE
    if len(free) <= 2 and np.all(along > 1 - TWIST_TOLERANCE) and not pitched:
        kind, movement = SUBGROUP_JOINTS[1, len(free) - 1]
    elif len(free) == 3 and np.all(along < TWIST_TOLERANCE):
        (kind, movement), point = SUBGROUP_JOINTS[1, 2], np.zeros(3)
    else:
        return None
    return Spin(kind, movement, forwards(frame(centre + size * point, axis)))


def _turns_on_a_ring(mechanism: Mechanism, joints: Sequence[Joint], part: str, spin: Spin) -> bool:
    """Tell whether a body fits in or on a ring that is long and one body with others, as a shaft in a bush and a hub on
    a hollow axle do: it is there to turn."""
    rows = mechanism.structure.row_of
    sizes = Counter(rows.values())
    beside = {rows[other] for joint in joints for other in joint.parts if other != part}
    own = _cylinders(*(each for each in mechanism.solids if rows.get(each.name) == rows[part]))
    for ring in (each for each in mechanism.solids if rows.get(each.name) in beside and sizes[rows[each.name]] > 1):
        away = (ring.outermost - spin.frame[:3, 3]) @ spin.frame[:3, :3]
        length, around = np.ptp(away[:, 2]), _cylinders(ring)
        long = any(each.side < 0 and length >= each.radius for each in around)
        fits = any(
            one.side == -other.side and abs(one.radius - other.radius) <= MAX_PLAY * one.radius
            for one in own
            for other in around
        )
        if long and fits and roundness(away[:, :2], np.zeros(2)) > MIN_BUSH:
            return True
    return False


def _centre_of_turns(twists: Float[np.ndarray, "turns 6"]) -> Float[np.ndarray, "3"] | None:
    """Find the point about which a part turns by all twists, from where these are taken; None where there is none.

    The velocity of a turn w about the point p is v = p x w.
    """
    crosses, velocities = np.concatenate([np.cross(np.eye(3), w).T for w in twists[:, :3]]), twists[:, 3:].ravel()
    point = np.linalg.lstsq(crosses, velocities, rcond=None)[0]
    return point if np.abs(crosses @ point - velocities).max() <= TWIST_TOLERANCE else None


def _cylinders(*parts: Part) -> list[Cylinder]:
    """List the cylindrical faces of parts."""
    return [face.surface for part in parts for face in part.faces if isinstance(face.surface, Cylinder)]


def _is_round(part: Part, spin: Spin) -> bool:
    """Tell whether the outline of a part, seen along the axis, is round about the axis; of one on a ball joint, whether
    it is a ball.

    If the part may slide across the axis, the outline need only be round about its own middle.
    """
    if spin.kind is JointKind.SPHERICAL:
        # how far it reaches in each direction: the corners of a cube are equally far, and its faces are not
        reach = ((part.outermost - spin.frame[:3, 3]) @ BALL_DIRECTIONS.T).max(axis=0)
        return bool(reach.min() > MIN_BUSH * reach.max())
    outline = (part.outermost - spin.frame[:3, 3]) @ spin.frame[:3, :2]
    slides_across = MOVEMENTS[spin.movement].turns_and_slides == (1, 2)
    return roundness(outline, None if slides_across else np.zeros(2)) > MIN_ROUNDNESS
