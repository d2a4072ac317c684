"""Compute the velocities that joints allow at the assembled pose: which parts can move, and which joints hold them.

Each moving body has a twist `V` (6), angular velocity first. A joint between body 1 and body 2 that allows the twists
`S` demands `C (V_2 - V_1) = 0` with `C S = 0`. The origin is the middle of the joints and lengths are divided by the
extent of the joints (`middle`), so that neither unit nor origin matters. The rank at the assembled pose alone cannot
tell whether that pose is singular: the rank serves reports and not the solver.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.pose import Vector
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import chain, complement
from jaxkin.linkage.first_order import RANK_TOLERANCE
from jaxkin.topology.components import connected

_LOST = 1e-10
"""Largest share of the square of a direction of the constraints that may lie in the rows that stay, where the direction
counts as lost with the rows that are removed: above rounding."""

ConstraintRows = Int[np.ndarray, " rows"]
"""Indices of rows of `TwistConstraints.matrix`."""


@dataclass(frozen=True, eq=False)
class TwistConstraints:
    """The constraints of joints on the twists of bodies: `matrix @ twists = 0`."""

    bodies: tuple[str, ...]
    """Names of the bodies that may move: six columns of `matrix` each, angular velocity first."""
    matrix: Float[np.ndarray, "constraints columns"]
    """Constraints, one a row, without unit: lengths are over the extent of the joints."""
    owner: Int[np.ndarray, " constraints"]
    """Index of the joint that each row belongs to."""

    @cached_property
    def _decomposed(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        u, s, vt = np.linalg.svd(self.matrix, full_matrices=False)
        rank = int((s > RANK_TOLERANCE * s.max(initial=0.0)).sum())
        return u[:, :rank], s[:rank], vt[:rank]

    @property
    def freedoms(self) -> int:
        """Number of independent motions of all bodies that all joints allow together."""
        return self.matrix.shape[1] - len(self._decomposed[1])

    def rows(self, joints: Sequence[int]) -> ConstraintRows:
        """List the rows of `matrix` that belong to `joints`, given by their indices."""
        return np.flatnonzero(np.isin(self.owner, joints))

    def alone(self, bodies: Sequence[str], rows: ConstraintRows) -> int:
        """Count the independent motions that the constraints `rows` allow to `bodies` while all other bodies rest."""
        places = [self.bodies.index(body) for body in bodies]
        own = self.matrix[rows].reshape(len(rows), len(self.bodies), 6)[:, places]
        held = [np.flatnonzero(row).tolist() for row in np.any(own, axis=2)]
        # the matrix consists of blocks: one for the bodies that rows connect, such as a stack of washers
        blocks = connected(range(len(bodies)), [(some[0], other) for some in held for other in some[1:]])
        every = []
        for block in map(sorted, blocks):
            of_block = [row for row, some in enumerate(held) if some and some[0] in block]
            every.append(np.linalg.svd(own[np.ix_(of_block, block)].reshape(-1, 6 * len(block)), compute_uv=False))
        strengths = np.concatenate(every)
        return 6 * len(bodies) - int((strengths > RANK_TOLERANCE * strengths.max(initial=0.0)).sum())

    def freed(self, rows: ConstraintRows) -> Float[np.ndarray, "freed bodies 6"]:
        """Compute a basis of the motions of the bodies that become possible when the constraints `rows` are removed.

        The matrix is `A = U S V^T`. A motion `x = V S^-1 z` changes the constraints by `A x = U z`: none but `rows` if
        `U z` vanishes outside of `rows`. So `z` are the right singular vectors of `U[rows]` with singular value 1.
        """
        u, s, vt = self._decomposed
        _, strengths, directions = np.linalg.svd(u[rows], full_matrices=False)
        lost = directions[strengths**2 > 1 - _LOST]
        return ((lost / s) @ vt).reshape(len(lost), len(self.bodies), 6)

    def count_freed(self, rows: ConstraintRows) -> int:
        """Count the motions of `freed`, without computing them: those that become possible without `rows`."""
        share = self._decomposed[0][rows]
        share = share if len(share) < share.shape[1] else share.T
        return int((np.linalg.eigvalsh(share @ share.T) > 1 - _LOST).sum())

    def strength(self, rows: ConstraintRows, gained: Float[np.ndarray, "freed bodies 6"]) -> float:
        """Measure how strongly the constraints `rows` hold the motions `gained`, which become possible without `rows`.

        The strength is that of the motion of unit norm that `rows` change least: radians, or lengths over the extent
        of the joints; at most 1, which is also that of no motion.
        """
        motions = gained.reshape(len(gained), -1)
        unit = np.linalg.svd(motions, full_matrices=False)[2]
        return float(np.linalg.svd(self.matrix[rows] @ unit.T, compute_uv=False).min(initial=1.0))

    def relative(self, one: str, other: str) -> Float[np.ndarray, "6 columns"]:
        """Project the six unit twists of body `other` relative to body `one` on the motions that all joints allow.

        A row of the result is zero where the joints hold this component of the relative twist.
        """
        _, _, vt = self._decomposed
        difference = np.zeros((6, self.matrix.shape[1]))
        for body, sign in ((one, -1), (other, 1)):
            if body in self.bodies:
                column = 6 * self.bodies.index(body)
                difference[:, column : column + 6] = sign * np.eye(6)
        return difference - (difference @ vt.T) @ vt


def twists(joints: Sequence[Joint], body_of: Mapping[str, str], still: str) -> TwistConstraints:
    """Assemble the constraints of joints on bodies.

    `body_of` maps each part to its body; the body `still` rests. A joint inside of one body gives no constraint.
    """
    ends = [tuple(body_of[part] for part in joint.parts) for joint in joints]
    bodies = tuple(dict.fromkeys(body for pair in ends for body in pair if body != still))
    column = {body: 6 * k for k, body in enumerate(bodies)}
    centre, size = middle(joints)
    blocks, owner = [np.zeros((0, 6 * len(bodies)))], [np.zeros(0, int)]
    for index, (joint, (one, other)) in enumerate(zip(joints, ends, strict=True)):
        if one == other:
            continue
        forbidden = constraints(joint, centre, size)
        block = np.zeros((len(forbidden), 6 * len(bodies)))
        for body, sign in ((one, -1), (other, 1)):
            if body != still:
                block[:, column[body] : column[body] + 6] = sign * forbidden
        blocks.append(block)
        owner.append(np.full(len(block), index))
    return TwistConstraints(bodies, np.concatenate(blocks), np.concatenate(owner))


def middle(joints: Sequence[Joint]) -> tuple[Vector, float]:
    """Compute the mean (3) of the origins of joint frames, and the diagonal of the box around these origins.

    Both are in the unit of the mechanism; the diagonal is 1 where it is zero to rounding.
    """
    origins = np.concatenate([np.asarray(joint.frames_1, float)[:, :3, 3] for joint in joints] or [np.zeros((1, 3))])
    extent = float(np.linalg.norm(np.ptp(origins, axis=0)))
    return origins.mean(axis=0), extent if extent > 1e-12 * float(np.abs(origins).max()) else 1.0


def constraints(joint: Joint, centre: Vector, size: float) -> Float[np.ndarray, "constraints 6"]:
    """Compute orthonormal constraints C of a joint, `C V = 0` for the twist V of part 2 relative to part 1.

    Twists are about `centre`, angular velocity first, with lengths divided by `size`.
    """
    frames = np.array(joint.frames_1, float)
    frames[:, :3, 3] = (frames[:, :3, 3] - centre) / size
    splines = tuple(curve and curve.over(size).spline() for curve in joint.curves)
    screws = chain(joint.movements, frames, np.zeros(joint.freedoms), float(joint.pitch) / size, splines=splines)[1]
    return complement(screws)
