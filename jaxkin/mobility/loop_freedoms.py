"""The freedoms of the loops of a mechanism, on the host: screws of the joints at a closed pose that is not special.

First-order freedoms are read off at a pose. The assembled one may be singular (a parallelogram lying flat, a crank at
its dead centre), so a second look is taken at a closed pose beside it. Host code in float64, whatever the device does:
it compiles nothing and decides nothing by the precision of the device.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from functools import cached_property

import numpy as np
from jaxtyping import Float

from jaxkin._memory import once_for_each
from jaxkin.geometry.pose import Pose
from jaxkin.joints.screws import Screws
from jaxkin.joints.subgroups import Subgroup, subgroup
from jaxkin.linkage.first_order import loop_jacobian, null_space
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.host_closure import ClosedLoops, Row, Travel, least_norm
from jaxkin.topology.structure import LoopGroup

_STEP = 0.05
"""How far the second look is taken from the assembled pose, in radians or characteristic lengths: far enough to leave a
singular pose behind, near enough to close."""


class LoopFreedoms:
    """What the loops of one structure element allow at first order; each look is taken when it is asked for.

    Lengths are over the characteristic length.
    """

    def __init__(self, linkage: Linkage, loop_group: LoopGroup) -> None:
        self._loops = ClosedLoops(linkage.solved_joints, linkage.structure, loop_group)
        self.loop_group = loop_group
        self.columns = self._loops.columns
        """(joint, coordinate) of each column: the coordinates of the element's joints in turn."""
        self.thresholds = self._loops.thresholds
        self.centre, self.length = self._loops.centre, self._loops.length
        """The origin of all numbers here, and the characteristic length."""
        self.ends = self._loops.ends
        """For each joint the rows of its parts, all fixed parts together."""
        column_of = {place: column for column, place in enumerate(self.columns)}
        self.driven_together = {
            column_of[index, k]: tuple(column_of[index, other] for other in group)
            for index in loop_group.joints
            for group in linkage.solved_joints[index].driven_together
            for k in group
        }
        """For each column those that can be driven with it only: the three angles of a ball."""
        self.fixed = linkage.structure.row_of[linkage.fixed[0]]
        """The row of the fixed parts."""

    @cached_property
    def _home(self) -> tuple[Row, Travel]:
        return self._loops.closed(np.zeros(len(self.columns)))

    @property
    def closes(self) -> bool:
        """Whether Newton's method closes the loops from the assembled pose: of others nothing is known."""
        return self._loops.coincide or self._home[1].gap < self.thresholds.residual

    @property
    def assembled(self) -> Screws:
        """Screws of the coordinates in world coordinates, at the assembled pose."""
        return self._home[1].screws

    @property
    def screws(self) -> Screws:
        """The same at a closed pose beside it; at the assembled one where none was found, or where the rank falls."""
        return self._generic[1]

    @cached_property
    def places(self) -> Mapping[str, Pose]:
        """Displacements of the rows of parts at the pose of `screws`, about `centre` over `length`."""
        return self._loops.travel(self._generic[0]).places

    @cached_property
    def _generic(self) -> tuple[Row, Screws]:
        """Coordinates and screws at a pose that is not special."""
        home, screws = self._home[0], self.assembled
        jacobian = loop_jacobian(self.loop_group.loops, self.columns, screws)
        generic = np.sin(1.0 + 2.7 * np.arange(len(self.columns)))  # a fixed direction in which nothing is special
        along = generic - least_norm(jacobian, jacobian @ generic, 1e-12)
        there, found = self._loops.closed(home + _STEP * along)
        beside = found.screws
        rank = null_space(loop_jacobian(self.loop_group.loops, self.columns, beside), self.thresholds.rank)[0]
        is_generic = found.gap < self.thresholds.residual and rank >= len(self.columns) - len(self.at_rest)
        return (there, beside) if is_generic else (home, screws)

    @cached_property
    def jacobian(self) -> Float[np.ndarray, "equations columns"]:
        """Closure Jacobian, six rows a loop in world coordinates (derivative of Eq. 10)."""
        return loop_jacobian(self.loop_group.loops, self.columns, self.screws)

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
        return null_space(loop_jacobian(self.loop_group.loops, self.columns, self.assembled), self.thresholds.rank)[1]

    def subgroup(self, joints: Container[int]) -> Subgroup:
        """The smallest displacement subgroup that holds these joints."""
        columns = [column for column, (joint, _) in enumerate(self.columns) if joint in joints]
        return subgroup(self.assembled[:, columns], 10 * self.thresholds.rank)

    @cached_property
    def _decomposed(self) -> tuple[int, Float[np.ndarray, "freedoms columns"]]:
        return null_space(self.jacobian, self.thresholds.rank)


@once_for_each
def loop_freedoms(linkage: Linkage) -> tuple[LoopFreedoms, ...]:
    """The freedoms of the structure elements with loops, in the order of `structure.loop_groups`."""
    return tuple(LoopFreedoms(linkage, loop_group) for loop_group in linkage.structure.loop_groups)
