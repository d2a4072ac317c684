"""The freedoms of the loops of a mechanism, on the host: screws of the joints at a closed pose that is not special.

First-order freedoms are read off at a pose. The assembled one may be singular (a parallelogram lying flat, a crank at
its dead centre), so a second look is taken at a closed pose beside it. Host code in float64, whatever the device does:
it compiles nothing and decides nothing by the precision of the device.
"""

from __future__ import annotations

from collections.abc import Collection, Container
from functools import cached_property

import numpy as np
from jaxtyping import Float

from jaxkin.joints.screws import Screws
from jaxkin.joints.subgroups import Subgroup, subgroup
from jaxkin.motion.closed_loops import ClosedLoops, Row, least_norm
from jaxkin.motion.mechanism import Mechanism
from jaxkin.topology.rates import loop_jacobian, null_space, without
from jaxkin.topology.structure import Block

_TOGETHER = 3
"""Parts in a row that may be idle together."""
_STEP = 0.05
"""How far the second look is taken from the assembled pose, in radians or characteristic lengths: far enough to leave a
singular pose behind, near enough to close."""


class LoopFreedoms:
    """What the loops of one structure element allow at first order; each look is taken when it is asked for.

    Lengths are over the characteristic length.
    """

    def __init__(self, mechanism: Mechanism, block: Block) -> None:
        self._loops = ClosedLoops(mechanism, block)
        self.block = block
        self.columns = self._loops.columns
        """(joint, coordinate) of each column: the coordinates of the element's joints in turn."""
        self.noise = self._loops.noise
        self.ends = self._loops.ends
        """For each joint the rows of its parts, all fixed parts together."""
        self.fixed = mechanism.structure.row_of[mechanism.fixed[0]]
        """The row of the fixed parts."""

    @cached_property
    def _home(self) -> tuple[Row, Screws]:
        return self._loops.closed(np.zeros(len(self.columns)))[:2]

    @property
    def assembled(self) -> Screws:
        """Screws of the coordinates in world coordinates, at the assembled pose."""
        return self._home[1]

    @cached_property
    def screws(self) -> Screws:
        """The same at a closed pose beside it; at the assembled one where none was found, or where the rank falls."""
        home, screws = self._home
        jacobian = loop_jacobian(self.block.loops, self.columns, screws)
        generic = np.sin(1.0 + 2.7 * np.arange(len(self.columns)))  # a fixed direction in which nothing is special
        along = generic - least_norm(jacobian, jacobian @ generic, 1e-12)
        _, beside, gap = self._loops.closed(home + _STEP * along)
        rank = null_space(loop_jacobian(self.block.loops, self.columns, beside), self.noise)[0]
        return beside if gap < self.noise.closed and rank >= len(self.columns) - len(self.at_rest) else screws

    @cached_property
    def jacobian(self) -> Float[np.ndarray, "equations columns"]:
        """Closure Jacobian, six rows a loop in world coordinates (derivative of Eq. 10)."""
        return loop_jacobian(self.block.loops, self.columns, self.screws)

    @cached_property
    def rank(self) -> int:
        """Independent equations among them."""
        return self._decomposed[0]

    @cached_property
    def motions(self) -> Float[np.ndarray, "freedoms columns"]:
        """An orthonormal basis of the rates that keep all loops closed."""
        return self._decomposed[1]

    @cached_property
    def at_rest(self) -> Float[np.ndarray, "freedoms columns"]:
        """The same at the assembled pose, where there may be more of them."""
        return null_space(loop_jacobian(self.block.loops, self.columns, self.assembled), self.noise)[1]

    def idle(self, left_out: Collection[str] = ()) -> Float[np.ndarray, "idle columns"]:
        """An orthonormal basis of the motions in which one part of the loops moves while all others rest.

        A part that is held by several others: between two parts any motion is of use. A few parts in a row that stay
        together, such as the two halves of a leg that spins between its balls, are one part here. Parts that are left
        out hold nothing, and their motions are not looked for.
        """
        found = [np.zeros((0, len(self.columns)))]
        for parts in sorted(self._held_by_several(set(left_out)), key=sorted):
            within = {joint for joint, ends in self.ends.items() if (ends[0] in parts) != (ends[1] in parts)}
            found.append(
                without(
                    self.motions, [c for c, (joint, _) in enumerate(self.columns) if joint not in within], self.noise
                )
            )
        _, values, directions = np.linalg.svd(np.concatenate(found), full_matrices=False)
        return directions[values > self.noise.rate]

    def _held_by_several(self, left_out: set[str]) -> set[frozenset[str]]:
        """Parts with two or more neighbours, and rows of up to three that have two neighbours each."""
        near: dict[str, set[str]] = {}
        for part, other in (ends for ends in self.ends.values() if left_out.isdisjoint(ends)):
            near.setdefault(part, set()).add(other)
            near.setdefault(other, set()).add(part)
        single = {frozenset((part,)) for part in near if part != self.fixed and len(near[part]) > 1}
        rows = {row for row in single if all(len(near[part]) == 2 for part in row)}
        found, chain = set(single), {part for row in rows for part in row}
        for _ in range(_TOGETHER - 1):
            rows = {row | {other} for row in rows for part in row for other in near[part] & chain - row}
            found |= {row for row in rows if len(set.union(*(near[part] for part in row)) - row) > 1}
        return found

    def subgroup(self, joints: Container[int]) -> Subgroup:
        """The smallest displacement subgroup that holds these joints."""
        columns = [column for column, (joint, _) in enumerate(self.columns) if joint in joints]
        return subgroup(self.assembled[:, columns], 10 * self.noise.rank)

    @cached_property
    def _decomposed(self) -> tuple[int, Float[np.ndarray, "freedoms columns"]]:
        return null_space(self.jacobian, self.noise)


def loop_freedoms(mechanism: Mechanism) -> tuple[LoopFreedoms, ...]:
    """The freedoms of the structure elements with loops, in the order of `structure.blocks`."""
    return tuple(LoopFreedoms(mechanism, block) for block in mechanism.structure.blocks)
