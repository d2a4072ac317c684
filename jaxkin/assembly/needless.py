"""Parts that only spin and that several parts hold: find which of them constrain no other part, as a set.

Each of six bolts through two flanges is redundant while the other five are there, but without all six the flanges
slide. So sets of parts are judged: a set is needless if the other parts gain no freedom without all of it. Which set is
chosen depends on the places of the parts, not on their order or names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin.assembly.spinning import TWIST_TOLERANCE, Spin, spins
from jaxkin.geometry.part import Part
from jaxkin.joints.combine import LOWER_PAIRS
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import chain, complement, freedoms
from jaxkin.linkage.linkage import SpinningPart
from jaxkin.mobility.twists import Twists, middle, twists
from jaxkin.topology.components import connected
from jaxkin.topology.structure import LoopGroup

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_SORTING_DIGITS = 6
"""Digits to which the places of parts are rounded when parts are sorted, so that the noise of the file does not decide
the order."""

Parts = list[str]


class Found(NamedTuple):
    """The parts of a mechanism that only spin."""

    spins: dict[str, Spin]
    """Parts that constrain no other part, each with its carrier: those on one neighbour alone, and needless ones."""
    needed: tuple[tuple[str, ...], ...]
    """Groups of touching parts, each needless by itself, but not together with the parts in `spins`."""


def found_spinning(mechanism: Mechanism, kept: Sequence[str] = ()) -> Found:
    """Find the parts that only spin, in the order of the mechanism; of those in `kept` only parts on one neighbour."""
    alone, held = spins(mechanism)
    held = {part: spin for part, spin in held.items() if part not in kept}
    found, needed = dict(alone), []
    for loop_group in mechanism.structure.loop_groups if held else ():
        judged = _SpinCandidates.of(mechanism, loop_group, held)
        if judged is None:
            continue
        taken = judged.with_carriers()
        found |= taken
        for group in judged.groups:
            left = tuple(part for part in group if part not in taken)
            if left and judged.is_needless(group) and not judged.is_needless([*taken, *left]):
                needed.append(left)
    return Found({part: found[part] for part in mechanism.parts if part in found}, tuple(needed))


def with_spinning(mechanism: Mechanism) -> Mechanism:
    """Write the parts that only spin, found by the shape of the solids, into the linkage of the mechanism."""
    found = found_spinning(mechanism).spins
    spinning = tuple(SpinningPart(part, spin.freedoms) for part, spin in found.items())
    return replace(mechanism, linkage=replace(mechanism.linkage, spinning=spinning))


class _SpinCandidates(NamedTuple):
    """The parts within one structure element that only spin, and may be needless."""

    groups: list[Parts]
    """The parts in groups that touch each other, such as a stack of washers: each group is first tried as a whole."""
    spins: Mapping[str, Spin]
    joints: Sequence[Joint]
    system: Twists
    row_of: Mapping[str, str]
    preference: Callable[[str], tuple]
    """Sort key of neighbours as carriers: fixed ones first, then larger ones."""

    @staticmethod
    def of(mechanism: Mechanism, loop_group: LoopGroup, held: Mapping[str, Spin]) -> _SpinCandidates | None:
        """Take those of the parts `held` that have all their joints within the element; None where there are none."""
        solids = {part.name: part for part in mechanism.solids}
        joints = [mechanism.all_joints[k] for k in loop_group.joints]
        here = {joint.name for joint in joints}
        elsewhere = {part for each in mechanism.all_joints if each.name not in here for part in each.parts}
        ends = dict.fromkeys(part for joint in joints for part in joint.parts)
        inside = {part: held[part] for part in ends if part in held and part not in elsewhere}
        still = next((part for part in ends if part not in inside), None)
        if not inside or still is None:
            return None
        scale = 10.0**-_SORTING_DIGITS * max(float(np.ptp(solids[part].box)) for part in inside)
        pairs = [joint.parts for joint in joints if set(joint.parts) <= set(inside)]
        order = {part: _place(solids[part], scale) for part in inside}
        groups = [sorted(group, key=order.__getitem__) for group in connected(inside, pairs)]
        groups.sort(key=lambda group: order[group[0]])
        row_of = mechanism.structure.row_of

        def preference(part: str) -> tuple:
            extents = sorted(-np.ptp(solids[part].box, axis=0)) if part in solids else [0.0]
            return part not in mechanism.fixed, part in inside, *extents, *order.get(part, ())

        return _SpinCandidates(groups, inside, joints, twists(joints, row_of, row_of[still]), row_of, preference)

    def is_needless(self, parts: Sequence[str]) -> bool:
        """Whether the other parts gain no freedom without these parts, and these parts can only spin, each by itself,
        while the others rest."""
        if not parts:
            return False
        rows = self.system.rows([k for k, joint in enumerate(self.joints) if set(parts) & set(joint.parts)])
        own = sum(self.spins[part].freedoms for part in parts)
        if self.system.alone(parts, rows) != own:
            return False
        # without its joints each part gains six freedoms, but for those that it has already
        return len(self.system.freed(rows)) == 6 * len(parts) - own

    def together(self, groups: Sequence[Parts], before: Sequence[str] = ()) -> Parts:
        """Find parts of these groups that are needless together with the parts `before`, by bisection.

        All groups are tried at once; if they are not needless, one half, then the other half together with what was
        found in the first, down to the single parts of a group.
        """
        parts = [part for group in groups for part in group]
        if not parts or self.is_needless([*before, *parts]):
            return parts
        if len(groups) == 1:
            if len(parts) == 1:
                return []
            groups = [[part] for part in parts]
        middle = len(groups) // 2
        first = self.together(groups[:middle], before)
        return [*first, *self.together(groups[middle:], [*before, *first])]

    def with_carriers(self) -> dict[str, Spin]:
        """Find parts that are needless together, each with its carrier; parts that stay on none are left out."""
        groups = self.groups
        while parts := self.together(groups):
            carriers = self.carriers(parts)
            if len(carriers) == len(parts):
                return {part: replace(self.spins[part], carrier=carriers[part]) for part in parts}
            groups = [carried for group in groups if (carried := [part for part in group if part in carriers])]
        return {}

    def carriers(self, parts: Sequence[str]) -> dict[str, str]:
        """Choose the neighbour that each part stays on: one that is not idle, or one whose own carrier is known."""
        choices = {part: self._stays_on(part, parts) for part in parts}
        found: dict[str, str] = {}
        while True:
            known = {
                part: [each for each in near if each not in choices or each in found]
                for part, near in choices.items()
                if part not in found
            }
            new = {part: min(near, key=self.preference) for part, near in known.items() if near}
            if not new:
                return found
            found |= new

    def _stays_on(self, part: str, idle: Sequence[str]) -> Parts:
        """Find the neighbours relative to which a part only spins, whatever moves.

        There are none unless the neighbours that are not idle only turn relative to each other about the axis. A sleeve
        between a rod and a cylinder that slide along each other may stay on either, which would be a guess.
        """
        spin = self.spins[part]
        centre, size = middle(self.joints)
        frames = spin.frame.copy()
        frames[:3, 3] = (frames[:3, 3] - centre) / size

        def only(movement: str, one: str, other: str) -> bool:
            forbidden = complement(chain([movement], frames[None], np.zeros(freedoms([movement])))[1])
            relative = self.system.relative(self.row_of[one], self.row_of[other])
            return bool(np.abs(forbidden @ relative).max(initial=0.0) < TWIST_TOLERANCE)

        near = dict.fromkeys(p for each in self.joints if part in each.parts for p in each.parts if p != part)
        used = [neighbour for neighbour in near if neighbour not in idle]
        if not all(only(LOWER_PAIRS[1, 0][1], used[0], other) for other in used[1:]):
            return []
        return [neighbour for neighbour in near if only(spin.movement, neighbour, part)]


def _place(part: Part, scale: float) -> tuple[float, ...]:
    """Place and size of a part, rounded to `scale`: a sort key that does not depend on names and order."""
    numbers = [*part.box.mean(axis=0), *np.ptp(part.box, axis=0)]
    return tuple(float(number) for number in np.round(np.array(numbers) / scale))
