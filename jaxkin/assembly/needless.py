"""Find round parts that can spin by themselves and constrain no other part, such as bolts, pins and washers.

Parts between two or more neighbours are judged as sets. Each of six bolts through two flanges constrains nothing while
the other five are there, but with no bolt the flanges slide on each other. So a set of parts is called needless if the
other parts gain no freedom when the whole set is removed. Several sets may be needless, not all together; which one is
chosen depends on the positions of the parts, not on their order or names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin.assembly.spinning import TWIST_TOLERANCE, Spin, spins
from jaxkin.geometry.part import Part
from jaxkin.joints.combine import SUBGROUP_JOINTS
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import chain, complement, freedoms
from jaxkin.linkage.linkage import SpinningPart
from jaxkin.mobility.twists import TwistConstraints, middle, twists
from jaxkin.topology.components import connected
from jaxkin.topology.structure import LoopGroup

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_SORTING_DIGITS = 6
"""Digits, relative to the largest part, to which positions are rounded when parts are sorted.

Fewer than the seven digits of float32, so that the noise of the file does not decide the order."""

Parts = list[str]


class SpinningParts(NamedTuple):
    """The parts of a mechanism that only spin, and those that would by themselves, but not together with these."""

    spins: dict[str, Spin]
    """Motion and carrier of each part that constrains no other part: parts with a single neighbour, and needless sets
    of parts with several."""
    needed: tuple[tuple[str, ...], ...]
    """Groups of parts joined to each other that are needless by themselves, but not together with those in `spins`."""


def found_spinning(mechanism: Mechanism, kept: Sequence[str] = ()) -> SpinningParts:
    """Find the parts of a mechanism that only spin, in the order of its parts.

    Parts named in `kept` are not judged needless; they are still found if they have a single neighbour.
    """
    alone, held = spins(mechanism)
    held = {part: spin for part, spin in held.items() if part not in kept}
    found, needed = dict(alone), []
    for loop_group in mechanism.structure.loop_groups if held else ():
        candidates = _SpinCandidates.of(mechanism, loop_group, held)
        if candidates is None:
            continue
        chosen = candidates.with_carriers()
        found |= chosen
        for group in candidates.groups:
            remaining = tuple(part for part in group if part not in chosen)
            if remaining and candidates.is_needless(group) and not candidates.is_needless([*chosen, *remaining]):
                needed.append(remaining)
    return SpinningParts({part: found[part] for part in mechanism.parts if part in found}, tuple(needed))


def with_spinning(mechanism: Mechanism) -> Mechanism:
    """Return the mechanism with the parts that only spin written into its linkage (`found_spinning`)."""
    found = found_spinning(mechanism).spins
    spinning = tuple(SpinningPart(part, spin.freedoms) for part, spin in found.items())
    return replace(mechanism, linkage=replace(mechanism.linkage, spinning=spinning))


class _SpinCandidates(NamedTuple):
    """The candidates of one loop group: round parts that can spin while all others rest, and may be needless."""

    groups: list[Parts]
    """The candidates, those joined to each other in one group, such as a stack of washers; sorted by position."""
    spins: Mapping[str, Spin]
    """The motion of each candidate while all other parts rest."""
    joints: Sequence[Joint]
    """The joints of the loop group."""
    system: TwistConstraints
    """The constraints of these joints on the twists of all bodies of the loop group but one, which rests."""
    row_of: Mapping[str, str]
    """For each part the name of its body in `system`; all fixed parts are one body."""
    preference: Callable[[str], tuple]
    """Sort key of neighbours as carriers, the best first: fixed parts, then parts that are no candidates, then larger
    parts."""

    @staticmethod
    def of(mechanism: Mechanism, loop_group: LoopGroup, held: Mapping[str, Spin]) -> _SpinCandidates | None:
        """Take the parts of `held` that have all their joints in the loop group; None where no part has.

        `held` maps round parts with several neighbours to their motion. None too where all parts of the loop group are
        candidates, so that none is left to be at rest.
        """
        solids = {part.name: part for part in mechanism.solids}
        joints = [mechanism.all_joints[k] for k in loop_group.joints]
        names = {joint.name for joint in joints}
        outside = {part for each in mechanism.all_joints if each.name not in names for part in each.parts}
        parts = dict.fromkeys(part for joint in joints for part in joint.parts)
        candidates = {part: held[part] for part in parts if part in held and part not in outside}
        at_rest = next((part for part in parts if part not in candidates), None)
        if not candidates or at_rest is None:
            return None
        scale = 10.0**-_SORTING_DIGITS * max(float(np.ptp(solids[part].box)) for part in candidates)
        pairs = [joint.parts for joint in joints if set(joint.parts) <= set(candidates)]
        order = {part: _place(solids[part], scale) for part in candidates}
        groups = [sorted(group, key=order.__getitem__) for group in connected(candidates, pairs)]
        groups.sort(key=lambda group: order[group[0]])
        row_of = mechanism.structure.row_of

        def preference(part: str) -> tuple:
            extents = sorted(-np.ptp(solids[part].box, axis=0)) if part in solids else [0.0]
            return part not in mechanism.fixed, part in candidates, *extents, *order.get(part, ())

        system = twists(joints, row_of, row_of[at_rest])
        return _SpinCandidates(groups, candidates, joints, system, row_of, preference)

    def is_needless(self, parts: Sequence[str]) -> bool:
        """Check whether candidates are needless as a set; False for an empty set.

        The set is needless if, first, the freedoms of its parts while all other parts rest are the spins of each by
        itself; and, second, the other parts gain no freedom when the whole set is removed.
        """
        if not parts:
            return False
        rows = self.system.rows([k for k, joint in enumerate(self.joints) if set(parts) & set(joint.parts)])
        own = sum(self.spins[part].freedoms for part in parts)
        if self.system.alone(parts, rows) != own:
            return False
        # without its joints a part gains six freedoms less those of its spin: more is gained by the other parts
        return self.system.count_freed(rows) == 6 * len(parts) - own

    def needless_subset(self, groups: Sequence[Parts], chosen: Sequence[str] = ()) -> Parts:
        """Find, by bisection, parts of some groups that are needless as one set with the parts `chosen` before.

        All groups are tried at once. If they are not needless, the first half is searched, then the second half with
        the parts found in the first half counted as chosen; a single group is divided into its parts.
        """
        parts = [part for group in groups for part in group]
        if not parts or self.is_needless([*chosen, *parts]):
            return parts
        if len(groups) == 1:
            if len(parts) == 1:
                return []
            groups = [[part] for part in parts]
        middle = len(groups) // 2
        first = self.needless_subset(groups[:middle], chosen)
        return [*first, *self.needless_subset(groups[middle:], [*chosen, *first])]

    def with_carriers(self) -> dict[str, Spin]:
        """Find a needless set of parts, and the carrier of each; parts without a carrier are not in the set.

        Where some part of a set has no carrier, a new set is searched for among the parts that have one.
        """
        groups = self.groups
        while parts := self.needless_subset(groups):
            carriers = self.carriers(parts)
            if len(carriers) == len(parts):
                return {part: replace(self.spins[part], carrier=carriers[part]) for part in parts}
            groups = [carried for group in groups if (carried := [part for part in group if part in carriers])]
        return {}

    def carriers(self, parts: Sequence[str]) -> dict[str, str]:
        """Choose the carrier of each part of a needless set: the neighbour that the part stays on.

        It is a part outside of the set, or a part of the set that has a carrier itself, so that carriers lead from each
        part out of the set; of several, the first by `preference`. Parts without such a neighbour are left out.
        """
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

    def _stays_on(self, part: str, needless: Sequence[str]) -> Parts:
        """Find the neighbours relative to which a part of the set `needless` only spins in all motions of the system.

        No neighbour is returned unless those outside of the set only rotate relative to each other about the axis of
        the spin. A sleeve between a rod and a cylinder that slide along each other could stay on either: a guess.
        """
        spin = self.spins[part]
        centre, size = middle(self.joints)
        frames = spin.frame.copy()
        frames[:3, 3] = (frames[:3, 3] - centre) / size

        def allows_only(movement: str, one: str, other: str) -> bool:
            """Check that `other` moves relative to `one` only by `movement`, in the frame of the spin."""
            forbidden = complement(chain([movement], frames[None], np.zeros(freedoms([movement])))[1])
            relative = self.system.relative(self.row_of[one], self.row_of[other])
            return bool(np.abs(forbidden @ relative).max(initial=0.0) < TWIST_TOLERANCE)

        near = dict.fromkeys(p for each in self.joints if part in each.parts for p in each.parts if p != part)
        outside = [neighbour for neighbour in near if neighbour not in needless]
        revolute = SUBGROUP_JOINTS[1, 0][1]
        if not all(allows_only(revolute, outside[0], other) for other in outside[1:]):
            return []
        return [neighbour for neighbour in near if allows_only(spin.movement, neighbour, part)]


def _place(part: Part, scale: float) -> tuple[float, ...]:
    """Make a sort key of a part: centre and extents of its box, six numbers, in units of `scale`, rounded."""
    numbers = [*part.box.mean(axis=0), *np.ptp(part.box, axis=0)]
    return tuple(float(number) for number in np.round(np.array(numbers) / scale))
