"""Align joint frames, so that loops that close only in the assembled pose, because numbers were rounded, can move.

Frames from robot files and drawings have about six digits. With such frames a planar four-bar is a spatial linkage,
whose loop closes in the assembled pose and in no other. Loops that move with the frames as given are left unchanged.
For each other loop group two alignments are tried, the first that lets its loops move is taken:

1. axes that are parallel, perpendicular, coaxial or concurrent within the noise become exactly so (`regularise.align`);
2. the frames are moved by the smallest twists with which the loops close along a motion (`nearest_mobile`).

In loops that move then, four-bars that lie flat within the noise are made to lie flat exactly (`change_points`).
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
from jaxkin.linkage.host_closure import ClosedLoops
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.change_points import EXACT, FlatLoop, bodies_of, flat_loops, laid_flat
from jaxkin.mobility.consistency import STILL, beside, rounding
from jaxkin.mobility.nearest_mobile import nearest_mobile
from jaxkin.topology.structure import LoopGroup

SIX_DIGITS = 5e-6
"""Default noise of frames, radians or lengths over `extent`: the largest error of a number rounded to six digits."""
SEVEN_DIGITS = 5e-7
"""Noise by which links may miss a pose in line, unless more than the default is asked for, same units: links that are
nearly equal are design sooner than axes that are nearly parallel."""
MISALIGNMENT_LEVELS = (1e-4, 1e-3)
"""Misalignments that are tried after the noise, same units, to tell a user which joints disagree by more than rounding.
A misalignment above 1e-3 is taken for design: it is larger than the errors of files and drawings."""
_SINGLE_PRECISION_NOISE = 6e-7
"""Error of an origin over its distance from the world origin: ten times the unit of rounding of float32, 6e-8. Some
files are written in single precision, so that the error of an origin grows with that distance."""
_ROUNDING = 1e-13
"""Change of a frame, radians or lengths over `extent`, that counts as none: some 450 units of rounding of float64."""
_NEARLY_EXACT = 1e-11
"""Misalignment, same units, up to which loops may seem to move as they are, and count as planar, for all of which they
are open by more than the tolerance of closed poses; twists found by least squares leave as much."""
_SLACK = 10.0
"""Residual over rounding that is left where axes are made exactly parallel after twists: below the tolerance by ten."""
_MIN_NAMED_SHARE = 0.5
"""A note names the joints that moved by more than this share of the largest move."""


@dataclass(frozen=True)
class Correction:
    """The largest changes of the frames of some joints."""

    angle: float
    """Largest change of a direction, radians."""
    length: float
    """Largest change of an origin, in the unit of the mechanism."""
    joints: tuple[str, ...]
    """Names of the joints whose frames changed the most: see `_MIN_NAMED_SHARE`."""

    def said(self, unit: str) -> str:
        """Say the changes of directions and axes in words; `unit` is the name of the unit of length."""
        sizes = []
        if self.angle:
            sizes.append(f"directions were aligned by at most {self.angle:.1g} rad")
        if self.length:
            sizes.append(f"axes {'' if sizes else 'were aligned '}by at most {self.length:.1g} {unit}".rstrip())
        return " and ".join(sizes)


def asked_noise(align: object) -> float:
    """Return the noise that the option `align` asks for, radians or lengths over `extent`; None asks for `SIX_DIGITS`.

    Raises ValueError for anything but None or a number from 0 to the largest of `MISALIGNMENT_LEVELS`.
    """
    if align is None:
        return SIX_DIGITS
    largest = MISALIGNMENT_LEVELS[-1]
    if isinstance(align, bool) or not isinstance(align, int | float | np.number) or not 0 <= align <= largest:
        raise ValueError(
            f"align must be a number from 0 (move nothing) to {largest:g}, the largest misalignment, in radians or "
            f"over the size of the mechanism, that is taken for rounding; got {align!r}"
        )
    return float(align)


class Aligned(NamedTuple):
    """A linkage whose frames were aligned where its loops need it to move."""

    linkage: Linkage
    notes: tuple[str, ...]
    """Sentences that say how far frames were moved, or would have to be moved for the loops to close."""


def aligned(linkage: Linkage, noise: float, unit: str = "") -> Aligned:
    """Align the joint frames of loop groups that close in the assembled pose only.

    `noise` is the largest change of a frame, radians or lengths over `extent`. Loops that would need a larger change
    keep the joints that were given; the aligned joints become `linkage.ideal`, from which a sweep finds the poses of
    least residual. `unit`, the name of the unit of length, is written in the notes. A linkage is returned unchanged if
    JAX traces its joints, if any of their numbers is not float64, and if any is NaN or infinite.
    """
    leaves = jax.tree.leaves(linkage.joints)
    if traced(leaves) or any(np.asarray(leaf).dtype != np.float64 or not np.isfinite(leaf).all() for leaf in leaves):
        return Aligned(linkage, ())
    exact, ideal, largest, notes = list(linkage.joints), list(linkage.joints), noise, list[str]()
    of_links, more = noise if noise > SIX_DIGITS else min(noise, SEVEN_DIGITS), MISALIGNMENT_LEVELS[0]
    for loop_group in linkage.structure.uncoupled_groups:
        level, joints = _aligned_group(linkage, loop_group, noise)
        if level <= noise:
            joints, _ = _laid_flat(linkage, loop_group, joints, of_links)
            _, off = _laid_flat(linkage, loop_group, joints, more, least_sums=2) if of_links < more else ([], [])
            notes += [_nearly_flat(linkage, off, unit)] if off else []
        for number, joint in zip(loop_group.joints, joints, strict=True):
            ideal[number] = joint
            if level <= noise:
                exact[number] = joint
        largest = max(largest, level)
    if moved := _correction(linkage.joints, exact):
        notes.append(f"for the rounding of the numbers, {moved.said(unit)}")
    if not (disagreement := _correction(exact, ideal)):
        unchanged = not moved and not linkage.ideal
        return Aligned(linkage if unchanged else linkage.with_joints(exact), tuple(notes))
    notes.append(
        "the loops close at the assembled pose only; they would close throughout if "
        f"{disagreement.said(unit)}, most of all of {listed([repr(name) for name in disagreement.joints])}: "
        "other poses are those of least residual (MISFIT); correct the numbers, or have them aligned with "
        f"align={largest:g}"
    )
    return Aligned(linkage.with_joints(exact, ideal), tuple(notes))


def _aligned_group(linkage: Linkage, loop_group: LoopGroup, noise: float) -> tuple[float, list[Joint]]:
    """Return the misalignment level at which the loops of a group could be made to move, and their joints then.

    The levels are `noise` and the `MISALIGNMENT_LEVELS` above it; joints are in the order of `loop_group.joints`. The
    level is 0 and the joints are those given where the loops move as they are given, and where no level helps. Levels
    above `noise` are tried only for loops that do not move: loops that move keep the freedoms of the given numbers.
    """
    given = [linkage.joints[number] for number in loop_group.joints]
    loops = _closed_loops(linkage, loop_group, given)
    for level in (noise, *(level for level in MISALIGNMENT_LEVELS if level > noise)):
        found = beside(loops, max(level, _ROUNDING))
        if found is None:  # no freedoms at this level
            continue
        if np.linalg.norm(found.residual) <= rounding(loops):
            if found.moved >= STILL:
                again = _nearly_exact(given) if noise else given
                return 0.0, again if _correction(given, again) else given
            continue  # closed, but back at the assembled pose
        if level and (joints := _joints_that_move(linkage, loop_group, level)):
            return level, joints
    return 0.0, given


def _joints_that_move(linkage: Linkage, loop_group: LoopGroup, level: float) -> list[Joint] | None:
    """Move the frames of a loop group by at most `level`, so that its loops close along a motion; None if that fails.

    `level` is in radians and in lengths over `extent`, or over the characteristic length for `_nearest_mobile_joints`.
    """
    given = [linkage.joints[number] for number in loop_group.joints]
    related = _with_exact_relations(given, _noise(given, level))
    if _closes_throughout(linkage, loop_group, related, level):
        return related
    for begun in (related, given):
        found = _nearest_mobile_joints(linkage, loop_group, begun, level)
        # twists of least norm take axes a little out of parallel; without that, loops close as well but for rounding
        again = found and _nearly_exact(found)
        if again and _closes_throughout(linkage, loop_group, again, level, _SLACK):
            return again
        if found and _closes_throughout(linkage, loop_group, found, level):
            return found
    return None


def _nearly_exact(joints: Sequence[Joint]) -> list[Joint]:
    """Make axes exactly parallel and so on that are by `_NEARLY_EXACT`: loops of a plane close to the tilt of axes."""
    return _with_exact_relations(joints, Noise(_NEARLY_EXACT, _NEARLY_EXACT * extent(joints)))


def _laid_flat(
    linkage: Linkage, loop_group: LoopGroup, joints: list[Joint], level: float, least_sums: int = 1
) -> tuple[list[Joint], list[FlatLoop]]:
    """Move the pins of four-bar loops by at most `level`, so that they can lie flat (`change_points`).

    `joints` are those of the group, which move. Returns them, and the loops that missed it; joints as they are and no
    loops where that fails. Loops of fewer than `least_sums` sums are left out: only equal links make two of them zero.
    """
    numbered, size = dict(zip(loop_group.joints, joints, strict=True)), extent(joints)
    loops = flat_loops(numbered, bodies_of(linkage.structure, numbered), level * size)
    loops = [loop for loop in loops if len(loop.signs) >= least_sums]
    off = [loop for loop in loops if loop.off_by() > EXACT * size]
    if off and level and (moved := laid_flat(loops, numbered, level * size, size)):
        found = [moved.get(number, joint) for number, joint in numbered.items()]
        if _closes_throughout(linkage, loop_group, found, level):
            return found, off
    return joints, []


def _nearly_flat(linkage: Linkage, loops: Sequence[FlatLoop], unit: str) -> str:
    """Say which of the loops misses lying flat by most."""
    worst = max(loops, key=FlatLoop.off_by)
    return (
        f"the links between {listed([repr(linkage.joints[number].name) for number in worst.joints])} miss by "
        f"{f'{worst.off_by():.1g} {unit}'.rstrip()} lying flat in one line"
        + (f", and those of {len(loops) - 1} more loops by less" if len(loops) > 1 else "")
        + ": near that pose such a loop folds over, or stops; if links are equal by design, give more digits, or have "
        f"them made so with align={MISALIGNMENT_LEVELS[0]:g}"
    )


def _noise(joints: Sequence[Joint], level: float) -> Noise:
    """Return the noise of a misalignment `level`, with lengths in the unit of the mechanism."""
    farthest = max(float(np.abs(side[:, :3, 3]).max()) for joint in joints for side in (joint.frames_1, joint.frames_2))
    return Noise(level, level * extent(joints) + _SINGLE_PRECISION_NOISE * farthest)


def extent(joints: Sequence[Joint]) -> float:
    """Measure the diagonal of the axis-aligned box around the origins of all frames, in the unit of the mechanism."""
    origins = np.concatenate([side[:, :3, 3] for joint in joints for side in (joint.frames_1, joint.frames_2)])
    return float(np.linalg.norm(np.ptp(origins, axis=0)))


def _with_exact_relations(joints: Sequence[Joint], noise: Noise) -> list[Joint]:
    """Make axes that are parallel, perpendicular, coaxial or concurrent within the noise exactly so."""
    sides = [side for joint in joints for side in (joint.frames_1, joint.frames_2)]
    names = [name for joint in joints for _ in range(2) for name in joint.movements]
    frames = align(names, np.concatenate(sides), noise)[0]
    pieces = iter(np.split(frames, np.cumsum([len(side) for side in sides])[:-1]))
    return [replace(joint, frames_1=next(pieces), frames_2=next(pieces)) for joint in joints]


def _nearest_mobile_joints(
    linkage: Linkage, loop_group: LoopGroup, joints: Sequence[Joint], level: float
) -> list[Joint] | None:
    """Move the frames by the smallest twists with which the loops close along a motion (`nearest_mobile`).

    None where a twist exceeds `level`, radians or lengths over the characteristic length, and where a joint has
    different frames on its two parts.
    """
    if not all(joint.coincides for joint in joints):
        return None
    loops = _closed_loops(linkage, loop_group, joints)
    if not nearest_mobile(loops, level):
        return None
    found = []
    for number, joint in zip(loop_group.joints, joints, strict=True):
        frames = loops.chains[number].frames_1.copy()
        frames[:, :3, 3] = loops.centre + loops.length * frames[:, :3, 3]
        found.append(replace(joint, frames_1=frames, frames_2=frames))
    return found


def _closes_throughout(
    linkage: Linkage, loop_group: LoopGroup, joints: Sequence[Joint], level: float, slack: float = 1.0
) -> bool:
    """Tell whether the loops with these joints close, to `slack` times rounding, beside the assembled pose in three
    directions."""
    loops = _closed_loops(linkage, loop_group, joints)
    for seed in range(3):
        found = beside(loops, level, seed)
        if found is None or np.linalg.norm(found.residual) > slack * rounding(loops) or found.moved < STILL:
            return False
    return True


def _closed_loops(linkage: Linkage, loop_group: LoopGroup, joints: Sequence[Joint]) -> ClosedLoops:
    """Describe the loops of a group as numbers, with `joints` in place of the given ones of the group."""
    every = list(linkage.joints)
    for number, joint in zip(loop_group.joints, joints, strict=True):
        every[number] = joint
    return ClosedLoops(every, linkage.structure, loop_group)


def _correction(given: Sequence[Joint], found: Sequence[Joint]) -> Correction | None:
    """Measure the largest changes from the frames `given` to those `found`; None where no frame changed."""
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
    named = [joint.name for joint, share in zip(given, np.maximum(*shares), strict=True) if share > _MIN_NAMED_SHARE]
    return Correction(float(angles.max()), float(lengths.max()), tuple(named))
