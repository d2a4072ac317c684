"""Align the frames of a mechanism, so that its loops close throughout a motion where rounded numbers keep them from it.

Numbers from robot files, drawings and people have some six digits. What they leave of a planar four-bar is a spatial
linkage that closes in its assembled pose only. Only such loops are touched: nothing is moved where the loops move as
far as their freedoms promise. What is parallel, perpendicular, coaxial or concurrent within the noise is made exactly
so; where that does not suffice, the nearest frames are taken with which the loops move.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import jax
import numpy as np

from jaxkin._names import listed
from jaxkin._traced import traced
from jaxkin.joints.joint import Joint
from jaxkin.joints.regularise import Noise, align
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.consistency import STILL, beside, rounding
from jaxkin.mobility.host_closure import ClosedLoops
from jaxkin.mobility.nearest_mobile import nearest_mobile
from jaxkin.topology.structure import LoopGroup

SIX_DIGITS = 5e-6
"""Radians, or lengths over the extent of the joints: the largest error of a number that is rounded to six digits."""
PLAY = (1e-4, 1e-3)
"""The same, of joints that disagree by more than rounding: what is more is design, or a mistake to be told as such."""
_SINGLE = 6e-7
"""Ten roundings of single precision, over the coordinate: what files leave of places far from the origin."""
_ROUNDING = 1e-13
"""Radians, or lengths over the extent of the joints: a change that is no more than the rounding of the arithmetic."""
_NAMED = 0.5
"""Joints are named that moved by more than this part of what the most moved one did."""


@dataclass(frozen=True)
class Correction:
    """How far frames were moved."""

    angle: float
    """Largest change of a direction, radians."""
    length: float
    """Largest change of a place, in the unit of the mechanism."""
    joints: tuple[str, ...]
    """Those that were moved the most."""

    def said(self, unit: str) -> str:
        """How far, in words, lengths in the given unit."""
        sizes = []
        if self.angle:
            sizes.append(f"directions were aligned by at most {self.angle:.1g} rad")
        if self.length:
            sizes.append(f"axes {'' if sizes else 'were aligned '}by at most {self.length:.1g} {unit}".rstrip())
        return " and ".join(sizes)


def asked_noise(align: object) -> float:
    """The noise that the option `align` asks for; ValueError where it is no such number."""
    if align is None:
        return SIX_DIGITS
    if isinstance(align, bool) or not isinstance(align, int | float | np.number) or not 0 <= align <= PLAY[-1]:
        raise ValueError(
            f"align must be a number from 0 (move nothing) to {PLAY[-1]:g}, the largest misalignment, in radians or "
            f"over the size of the mechanism, that is taken for rounding; got {align!r}"
        )
    return float(align)


class Aligned(NamedTuple):
    """A linkage whose frames were aligned where its loops need it."""

    linkage: Linkage
    notes: tuple[str, ...]
    """By how much frames were moved, or would have to be, in words."""


def aligned(linkage: Linkage, noise: float, unit: str = "") -> Aligned:
    """Align the frames of loops that close at the assembled pose only; lengths of the notes are in the given unit.

    Where more than `noise` would be needed, the joints stay as they are, and the nearest ones that move become
    `linkage.ideal`: what the poses of least residual are found from. Where JAX traces the joints, and for those in
    single precision, nothing is done.
    """
    leaves = jax.tree.leaves(linkage.joints)
    if traced(leaves) or any(np.asarray(leaf).dtype != np.float64 or not np.isfinite(leaf).all() for leaf in leaves):
        return Aligned(linkage, ())
    exact, ideal, play = list(linkage.joints), list(linkage.joints), noise
    for loop_group in linkage.structure.loop_groups:
        level, joints = _consistent(linkage, loop_group, noise)
        for number, joint in zip(loop_group.joints, joints, strict=True):
            ideal[number] = joint
            if level <= noise:
                exact[number] = joint
        play = max(play, level)
    notes = []
    if moved := _correction(linkage.joints, exact):
        notes.append(f"for the rounding of the numbers, {moved.said(unit)}")
    if not (disagreement := _correction(exact, ideal)):
        unchanged = not moved and not linkage.ideal
        return Aligned(linkage if unchanged else linkage.with_joints(exact), tuple(notes))
    notes.append(
        "the loops close at the assembled pose only; they would close throughout if "
        f"{disagreement.said(unit)}, most of all of {listed([repr(name) for name in disagreement.joints])}: "
        "other poses are those of least residual (MISFIT); correct the numbers, or have them aligned with "
        f"align={play:g}"
    )
    return Aligned(linkage.with_joints(exact, ideal), tuple(notes))


def _consistent(linkage: Linkage, loop_group: LoopGroup, noise: float) -> tuple[float, list[Joint]]:
    """The joints with which the loops close throughout, and the noise that they were aligned for; 0 for none at all.

    Loops that move at all have the freedoms of their own numbers: more play is looked for in those only that do not.
    """
    given = [linkage.joints[number] for number in loop_group.joints]
    loops = _closed_loops(linkage, loop_group, given)
    for level in (noise, *(play for play in PLAY if play > noise)):
        found = beside(loops, level)
        if found is None:
            continue
        if np.linalg.norm(found.residual) <= rounding(loops):
            if found.moved >= STILL:
                return 0.0, given
            continue
        if joints := _made_exact(linkage, loop_group, level):
            return level, joints
    return 0.0, given


def _made_exact(linkage: Linkage, loop_group: LoopGroup, level: float) -> list[Joint] | None:
    """The joints of a loop group moved by at most `level` so that its loops close throughout; None where that fails."""
    given = [linkage.joints[number] for number in loop_group.joints]
    related = _related(given, _noise(given, level))
    for joints in (related, _mobile(linkage, loop_group, related, level), _mobile(linkage, loop_group, given, level)):
        if joints and _closes_throughout(linkage, loop_group, joints, level):
            return joints
    return None


def _noise(joints: Sequence[Joint], level: float) -> Noise:
    farthest = max(float(np.abs(side[:, :3, 3]).max()) for joint in joints for side in (joint.frames_1, joint.frames_2))
    return Noise(level, level * extent(joints) + _SINGLE * farthest)


def extent(joints: Sequence[Joint]) -> float:
    """The diagonal of the box around the origins of all frames."""
    origins = np.concatenate([side[:, :3, 3] for joint in joints for side in (joint.frames_1, joint.frames_2)])
    return float(np.linalg.norm(np.ptp(origins, axis=0)))


def _related(joints: Sequence[Joint], noise: Noise) -> list[Joint]:
    """The joints with directions and places related as they are but for the noise."""
    sides = [side for joint in joints for side in (joint.frames_1, joint.frames_2)]
    names = [name for joint in joints for _ in range(2) for name in joint.movements]
    frames = align(names, np.concatenate(sides), noise)[0]
    rest = iter(np.split(frames, np.cumsum([len(side) for side in sides])[:-1]))
    return [replace(joint, frames_1=next(rest), frames_2=next(rest)) for joint in joints]


def _mobile(linkage: Linkage, loop_group: LoopGroup, joints: Sequence[Joint], level: float) -> list[Joint] | None:
    """The joints with the nearest frames with which the loops move; None where they are farther than `level`."""
    if not all(np.array_equal(joint.frames_1, joint.frames_2) for joint in joints):
        return None
    loops = _closed_loops(linkage, loop_group, joints)
    if not nearest_mobile(loops, level):
        return None
    found = []
    for number, joint in zip(loop_group.joints, joints, strict=True):
        frames = loops.chains[number][1].copy()
        frames[:, :3, 3] = loops.centre + loops.length * frames[:, :3, 3]
        found.append(replace(joint, frames_1=frames, frames_2=frames))
    return found


def _closes_throughout(linkage: Linkage, loop_group: LoopGroup, joints: Sequence[Joint], level: float) -> bool:
    loops = _closed_loops(linkage, loop_group, joints)
    for seed in range(3):
        found = beside(loops, level, seed)
        if found is None or np.linalg.norm(found.residual) > rounding(loops) or found.moved < STILL:
            return False
    return True


def _closed_loops(linkage: Linkage, loop_group: LoopGroup, joints: Sequence[Joint]) -> ClosedLoops:
    """The loops of a loop group with these joints, all others as they are given."""
    every = list(linkage.joints)
    for number, joint in zip(loop_group.joints, joints, strict=True):
        every[number] = joint
    return ClosedLoops(every, linkage.structure, loop_group)


def _correction(given: Sequence[Joint], found: Sequence[Joint]) -> Correction | None:
    """The largest changes of frames; None where there are none."""
    if not given:
        return None
    angles, lengths = np.zeros(len(given)), np.zeros(len(given))
    for number, (one, other) in enumerate(zip(given, found, strict=True)):
        for side in ("frames_1", "frames_2") if one is not other else ():
            change = np.asarray(getattr(other, side)) - np.asarray(getattr(one, side))
            angles[number] = max(angles[number], np.linalg.norm(change[:, :3, 2], axis=1).max(initial=0.0))
            lengths[number] = max(lengths[number], np.linalg.norm(change[:, :3, 3], axis=1).max(initial=0.0))
    size = extent(given)
    lengths[lengths < _ROUNDING * size] = 0.0
    angles[angles < _ROUNDING] = 0.0
    if not angles.any() and not lengths.any():
        return None
    shares = [each / each.max() if each.any() else each for each in (angles, lengths)]
    named = [joint.name for joint, share in zip(given, np.maximum(*shares), strict=True) if share > _NAMED]
    return Correction(float(angles.max()), float(lengths.max()), tuple(named))
