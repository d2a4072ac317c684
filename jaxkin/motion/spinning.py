"""Parts that only spin: screws, pins and washers, which contact analysis reads as hinges.

Such a part can turn about an axis while all others rest, perhaps slide along it or over a face across it, and can do
nothing else; nothing hangs on it, nor would anything move more freely without it. And its solid is round about that
axis: a lever at the end of a chain also turns alone, but that it has no work to do would be a guess, as it would be of
parts without solids.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Pose, frame
from jaxkin.joints.from_contacts import forwards
from jaxkin.joints.joint import Joint, joint
from jaxkin.joints.screws import chain, complement, freedoms
from jaxkin.motion.twists import Twists, constraints, middle, twists
from jaxkin.topology.components import connected
from jaxkin.topology.structure import structure

if TYPE_CHECKING:
    from jaxkin.motion.mechanism import Mechanism

ROUND = 0.84
"""Least over greatest half width of a part that is round about an axis: a hexagon has 0.866, a square 0.707."""
_SAME = 1e-6
"""Entries of unit twists that are equal: far above rounding, far below design."""


@dataclass(frozen=True, eq=False)
class Spin:
    """What a part can do by itself."""

    kind: str
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


def spinning(mechanism: Mechanism) -> dict[str, Spin]:
    """The parts that only spin, and how."""
    solids = {part.name: part for part in mechanism.solids}
    around: dict[str, list[Joint]] = defaultdict(list)
    for each in mechanism.all_joints:
        for part in each.parts:
            around[part].append(each)
    alone: dict[str, Spin] = {}
    held: dict[str, Spin] = {}
    size = middle(mechanism.all_joints)[1]  # the joints of one part may all be in one place
    for part, joints in around.items():
        if part in mechanism.fixed or (spin := _spin(joints, size)) is None:
            continue
        neighbours = dict.fromkeys(p for joint in joints for p in joint.parts if p != part)
        if part not in solids or not _is_round(solids[part], spin):
            continue
        if len(neighbours) > 1:
            held[part] = spin
        else:
            alone[part] = replace(spin, carrier=next(iter(neighbours)))
    found = alone | _needless(mechanism, held, around)
    return {part: found[part] for part in mechanism.parts if part in found}


def left_at_rest(mechanism: Mechanism) -> Mechanism:
    """The mechanism in which a part that only spins is joined to its carrier alone, by what it can do by itself.

    Its other contacts hold nothing that would not be held without them: they only close loops in which it idles.
    """
    joints, notes = list(mechanism.all_joints), list(mechanism.notes)
    for part, spin in spinning(mechanism).items():
        mine = [each for each in joints if part in each.parts]
        others = dict.fromkeys(p for each in mine for p in each.parts if p not in (part, spin.carrier))
        if not others:
            continue
        ends = next(each.parts for each in mine if spin.carrier in each.parts)
        kept = joint("-".join(ends), ends, spin.kind, (spin.movement,), [spin.frame])
        joints[joints.index(next(each for each in mine if spin.carrier in each.parts))] = kept
        joints = [each for each in joints if each is kept or part not in each.parts]
        notes.append(
            f"part {part!r} only spins: it is left at rest on {spin.carrier!r}, its contacts with "
            f"{', '.join(map(repr, others))} are not needed; connect it with rigid= for good"
        )
    if len(joints) == len(mechanism.all_joints):
        return mechanism
    described = [(each.name, *each.parts) for each in joints]
    structured = structure(mechanism.parts, described, mechanism.fixed)
    names = {each.name for each in joints}
    contacts = {name: some for name, some in mechanism.contacts.items() if name in names}
    return replace(mechanism, all_joints=tuple(joints), structure=structured, notes=tuple(notes), contacts=contacts)


def _spin(joints: Sequence[Joint], size: float) -> Spin | None:
    """What a part can do while its neighbours rest, if that is a turn, perhaps with slides along or across its axis."""
    centre, _ = middle(joints)
    forbidden = np.concatenate([constraints(joint, centre, size) for joint in joints])
    _, strengths, directions = np.linalg.svd(forbidden, full_matrices=True)
    free = directions[int((strengths > _SAME).sum()) :]
    _, turns, mixes = np.linalg.svd(free[:, :3].T, full_matrices=True)
    if int((turns > _SAME).sum()) != 1:
        return None
    turn, slides = mixes[0] @ free, (mixes[1:] @ free)[:, 3:]
    axis = turn[:3] / np.linalg.norm(turn[:3])
    along = np.abs(slides @ axis)
    point = np.cross(axis, turn[3:]) / np.linalg.norm(turn[:3])
    pitched = len(free) == 1 and abs(turn[3:] @ axis) > _SAME
    if len(free) <= 2 and np.all(along > 1 - _SAME) and not pitched:
        kind, movement = (("revolute", "T_phi"), ("cylindrical", "T_z_phi"))[len(free) - 1]
    elif len(free) == 3 and np.all(along < _SAME):
        kind, movement, point = "planar", "T_xy_phi", np.zeros(3)
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
    centre = (corners.min(axis=0) + corners.max(axis=0)) / 2 if spin.movement == "T_xy_phi" else np.zeros(2)
    inner = -(hull.equations[:, :2] @ centre + hull.equations[:, 2])
    return bool(inner.min() > ROUND * np.linalg.norm(corners - centre, axis=1).max())


def _needless(
    mechanism: Mechanism, spins: Mapping[str, Spin], around: Mapping[str, Sequence[Joint]]
) -> dict[str, Spin]:
    """Those of some parts, each within one structure element, without which nothing else moves more freely.

    Parts that touch each other, as in a stack of washers, are first tried together.
    """
    found: dict[str, Spin] = {}
    for block in mechanism.structure.blocks:
        joints = [mechanism.all_joints[k] for k in block.joints]
        here = {joint.name for joint in joints}
        inside = [part for part in spins if all(joint.name in here for joint in around[part])]
        still = next((p for joint in joints for p in joint.parts if p not in inside), None)
        if not inside or still is None:
            continue
        row_of = mechanism.structure.row_of
        system = twists(joints, row_of, row_of[still])
        for group in _touching(inside, mechanism):
            idle: list[str] = group if _is_needless(group, system, joints, spins) else []
            for part in [] if idle else group:
                if _is_needless([*idle, part], system, joints, spins):
                    idle.append(part)
            carried = {part: _carried(part, spins[part], idle, system, joints, row_of) for part in idle}
            found |= {part: spin for part, spin in carried.items() if spin}
    return found


def _is_needless(group: Sequence[str], system: Twists, joints: Sequence[Joint], spins: Mapping[str, Spin]) -> bool:
    rows = system.rows([k for k, joint in enumerate(joints) if set(group) & set(joint.parts)])
    # alone each is free six times, of which it has some already
    return len(system.freed(rows)) == sum(6 - spins[part].freedoms for part in group)


def _carried(
    part: str, spin: Spin, idle: Sequence[str], system: Twists, joints: Sequence[Joint], row_of: Mapping[str, str]
) -> Spin | None:
    """The spin with the first neighbour that the part stays on, whatever moves; None if there is none.

    Its neighbours, without those that are idle too, stay together but for turns about the axis: on which of them a
    sleeve stays between a rod and a cylinder that slide along each other shows, and would be a guess.
    """
    centre, size = middle(joints)
    frames = spin.frame.copy()
    frames[:3, 3] = (frames[:3, 3] - centre) / size

    def only(movement: str, one: str, other: str) -> bool:
        forbidden = complement(chain([movement], frames[None], np.zeros(freedoms([movement])))[1])
        return bool(np.abs(forbidden @ system.relative(row_of[one], row_of[other])).max(initial=0.0) < _SAME)

    near = list(dict.fromkeys(p for each in joints if part in each.parts for p in each.parts if p != part))
    used = [neighbour for neighbour in near if neighbour not in idle]
    if not all(only("T_phi", used[0], other) for other in used[1:]):
        return None
    carrier = next((neighbour for neighbour in near if only(spin.movement, neighbour, part)), None)
    return replace(spin, carrier=carrier) if carrier else None


def _touching(parts: Sequence[str], mechanism: Mechanism) -> list[list[str]]:
    """The parts in groups that are joined among themselves."""
    pairs = [joint.parts for joint in mechanism.all_joints if set(joint.parts) <= set(parts)]
    return [sorted(group, key=parts.index) for group in connected(parts, pairs)]
