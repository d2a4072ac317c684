"""Find the first-order freedoms of the loops of a mechanism, at the assembled pose and at a generic pose beside it.

The assembled pose may be singular (a parallelogram lying flat, a crank at its dead point), so the freedoms are computed
at a second closed pose too. Host code in float64 whatever the precision of the device, without compilation.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from functools import cached_property

import numpy as np
from jaxtyping import Float

from jaxkin._memory import once_for_each
from jaxkin.geometry.pose import Transform
from jaxkin.joints.screws import Screws
from jaxkin.joints.subgroups import Subgroup, subgroup
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.first_order import loop_jacobian, null_space
from jaxkin.linkage.host_closure import LoopCoordinates, Travel, least_norm
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.home_pose import HomePose, home_pose
from jaxkin.topology.structure import LoopGroup

_STEP = 0.05
"""Distance of the second pose from the assembled pose, radians or characteristic lengths: far enough to be away from a
singular pose, near enough to close."""


class LoopFreedoms:
    """The first-order freedoms of the loops of one loop group, computed when they are asked for.

    Lengths are over the characteristic length, and the origin is the centroid of the joint frames.
    """

    def __init__(self, linkage: Linkage, loop_group: LoopGroup) -> None:
        self._loops = closed_loops(linkage, loop_group)
        self.loop_group = loop_group
        self.columns = self._loops.columns
        """(joint, coordinate) of each column: the coordinates of the joints of the loop group in turn."""
        self.thresholds = self._loops.thresholds
        self.centre, self.length = self._loops.centre, self._loops.length
        """Origin in the world, and characteristic length in the unit of the mechanism."""
        self.ends = self._loops.ends
        """For each joint the rows of its parts, all fixed parts together."""
        column_of = {place: column for column, place in enumerate(self.columns)}
        self.driven_together = {
            column_of[index, k]: tuple(column_of[index, other] for other in group)
            for index in loop_group.joints
            for group in linkage.solved_joints[index].driven_together
            for k in group
        }
        """For each column all columns that must be driven together with it, itself included: the angles of a ball."""
        self.fixed = linkage.structure.row_of[linkage.fixed[0]]
        """The row of the fixed parts."""

    @cached_property
    def home(self) -> HomePose:
        """The assembled pose, or, where that is open, as after a change of lengths, where the loops close."""
        return home_pose(self._loops)

    @property
    def closes(self) -> bool:
        """Whether Newton's method closes the loops from the assembled pose: if not, their freedoms are unknown."""
        return self.home.closed

    @property
    def assembled_screws(self) -> Screws:
        """Twists of the coordinates (6, columns) at the assembled pose, in world coordinates."""
        return self.home.travel.screws

    @property
    def screws(self) -> Screws:
        """Twists of the coordinates (6, columns) at the generic pose: a closed pose beside the assembled one, or the
        assembled pose itself where no such pose was found or the rank is lower there."""
        return self._generic[1].screws

    @cached_property
    def places(self) -> Mapping[str, Transform]:
        """Displacements of the rows of parts at the pose of `screws`, about `centre` over `length`."""
        return self._generic[1].places

    @cached_property
    def _generic(self) -> tuple[LoopCoordinates, Travel]:
        """Find the scaled coordinates of the generic pose, and the quantities of the loops there."""
        home = self.home.q
        jacobian = self._jacobian(self.home.travel)
        generic = np.sin(1.0 + 2.7 * np.arange(len(self.columns)))  # a fixed direction without symmetry
        along = generic - least_norm(jacobian, jacobian @ generic, 1e-12)
        there, found = self._loops.closed(home + _STEP * along)
        rank = null_space(self._jacobian(found), self.thresholds.rank)[0]
        assembled_rank = len(self.columns) - len(self.assembled_motions)
        is_generic = found.residual_norm < self.thresholds.residual and rank >= assembled_rank
        return (there, found) if is_generic else (home, self.home.travel)

    def _jacobian(self, there: Travel) -> Float[np.ndarray, "equations columns"]:
        """Compute the closure Jacobian at a closed pose, with the derivatives of the couplings below it."""
        of_loops = loop_jacobian(self.loop_group.loops, self.columns, there.screws)
        return np.concatenate([of_loops, there.coupling_jacobian])

    @cached_property
    def jacobian(self) -> Float[np.ndarray, "equations columns"]:
        """Closure Jacobian, six rows a loop in world coordinates (derivative of Eq. 10), then one row a coupling."""
        return self._jacobian(self._generic[1])

    @cached_property
    def rank(self) -> int:
        """Number of independent equations among the rows of `jacobian`."""
        return self._decomposed[0]

    @cached_property
    def motions(self) -> Float[np.ndarray, "freedoms columns"]:
        """An orthonormal basis of the rates that keep all loops closed at the generic pose."""
        return self._decomposed[1]

    @cached_property
    def assembled_motions(self) -> Float[np.ndarray, "freedoms columns"]:
        """An orthonormal basis of the rates that keep all loops closed at the assembled pose: perhaps more of them."""
        return null_space(self._jacobian(self.home.travel), self.thresholds.rank)[1]

    def subgroup(self, joints: Container[int]) -> Subgroup:
        """Find the smallest displacement subgroup that holds the motions of these joints."""
        columns = [column for column, (joint, _) in enumerate(self.columns) if joint in joints]
        return subgroup(self.assembled_screws[:, columns], 10 * self.thresholds.rank)

    @cached_property
    def _decomposed(self) -> tuple[int, Float[np.ndarray, "freedoms columns"]]:
        """Decompose `jacobian`: its rank, and a basis of its null space."""
        return null_space(self.jacobian, self.thresholds.rank)


@once_for_each
def loop_freedoms(linkage: Linkage) -> tuple[LoopFreedoms, ...]:
    """Find the freedoms of all loop groups, in the order of `structure.loop_groups`."""
    return tuple(LoopFreedoms(linkage, loop_group) for loop_group in linkage.structure.loop_groups)
