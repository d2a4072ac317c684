"""Trace the motion of loops with one freedom as a curve, past the poses in which its drive locks (host code, float64).

The curve is followed by its arc length in the space of all coordinates, in which it is regular where the drive turns
back: `q(s)` is the closed pose nearest to `q + s t`, with the tangent `t` at `q`. Events are brackets in `s` whose ends
differ in sign, and are refined by Brent's method. At a lock the rate of the drive dq_d/ds is zero, so that an error of
`s` changes the drive by its square only.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.linkage.host_closure import ClosedLoops, ClosureJacobian, LoopCoordinates
from jaxkin.solve.continuation.step import CROSSING

LONGEST_STEP = 0.2
"""Longest step, radians and characteristic lengths of all coordinates together; slides over their `reach`, as long ones
turn the mechanism by so much less."""
FIRST_STEP = 0.02
"""First step, and the longest one where the drive is slow: a dwell may lock twice within a longer one."""
SHORTEST_STEP = 1e-8
"""Step below which the curve counts as lost."""
SLOW = 0.1
"""Absolute entry of the drive in the unit tangent below which the drive is slow."""
LEAST_TANGENT_COSINE = 0.97
"""Least cosine of the angle between the tangents at the ends of a step: 14 degrees."""
LARGEST_CORRECTION = 0.25
"""Largest ratio of the correction to the length of a step."""
ACCURACY = 1e-13
"""Error of the arc length, radians and characteristic lengths, to which events are refined: below the rounding of the
poses."""
MOVES = 1e-9
"""Entry of an idle motion of unit length above which it moves a coordinate: far above rounding."""
RELATIVE = 1e-15
"""The same over the arc length: four roundings, the least that Brent's method takes."""


class CurvePose(NamedTuple):
    """A closed pose on the curve, with its tangent."""

    q: LoopCoordinates
    """Scaled coordinates of a closed pose."""
    tangent: LoopCoordinates
    """Unit tangent."""
    sigma: float
    """Smallest singular value of the closure Jacobian, without those that are zero all along the curve: zero where
    branches cross."""


class MotionCurve:
    """The closed poses of loops that have one freedom beside idle ones, with some coordinates at rest."""

    def __init__(self, loops: ClosedLoops, drive: int, held: Sequence[int], idle: int) -> None:
        """Take the loops with the column of the drive, the columns at rest, and the number of idle freedoms."""
        self.loops, self.drive, self.held, self.idle = loops, drive, list(held), idle
        self.free = [k for k in range(len(loops.columns)) if k not in self.held]
        self.slides = [k for k, length in enumerate(loops.lengths) if length]
        self.spins: list[int] = []
        """Columns that the idle motions move, such as those of the balls of a rod: known once the curve has begun."""

    def _freedoms(self, jacobian: ClosureJacobian) -> tuple[Float[np.ndarray, "freedoms columns"], float]:
        """Compute a basis of the rates that keep the loops closed, and `CurvePose.sigma`.

        There are as many rates as idle freedoms and one more; where branches cross there are further ones.
        """
        columns, jacobian = jacobian.shape[1], jacobian[:, self.free]
        rank = len(self.free) - 1 - self.idle
        values, directions = np.linalg.svd(jacobian, full_matrices=True)[1:]
        least = self.loops.thresholds.rank * values.max(initial=0.0)
        basis = directions[min(rank, int((values > least).sum())) :]
        found = np.zeros((len(basis), columns))
        found[:, self.free] = basis
        return found, float(values[rank - 1]) if rank else np.inf

    def begin(self, direction: float, home: LoopCoordinates) -> CurvePose | None:
        """Find the tangent at a closed pose along which the drive rises or falls.

        It rises where `direction` is 1, and falls where that is -1.
        None where the pose is singular: where the drive does not move to first order, or branches cross.
        """
        basis, sigma = self._freedoms(self.loops.jacobian(home))
        if len(basis) != 1 + self.idle:
            return None
        # the motion of least norm, orthogonal to the idle ones, of which the drive has no part
        tangent = basis.T @ basis[:, self.drive]
        size = float(np.linalg.norm(tangent))
        if size < 1e-6:
            return None
        idle = basis - np.outer(basis @ tangent, tangent) / size**2
        self.spins = np.flatnonzero(np.abs(idle).max(axis=0) > MOVES).tolist() if self.idle else []
        return CurvePose(home, direction * tangent / size, sigma)

    def _idle_motions(self, jacobian: ClosureJacobian) -> Float[np.ndarray, "idle columns"]:
        """Compute a basis of the rates of `spins` that keep the loops closed, none where these are more than the idle
        ones, as in a singular pose of the angles of a ball."""
        columns = jacobian.shape[1]
        if not self.spins:
            return np.zeros((0, columns))
        values, directions = np.linalg.svd(jacobian[:, self.spins], full_matrices=True)[1:]
        rank = int((values > self.loops.thresholds.rank * values.max(initial=0.0)).sum())
        known = rank == len(self.spins) - self.idle
        found = np.zeros((self.idle if known else 0, columns))
        found[:, self.spins] = directions[rank:] if known else 0.0
        return found

    def at(self, here: CurvePose, s: float) -> CurvePose | None:
        """Close the loops where the tangent leads after the arc length `s`; None where they do not close.

        The tangent there is the projection of that `here` on the rates that keep the loops closed, without idle ones:
        those would gather from step to step, until the drive seems to rest.
        """
        q, found = self.loops.closed(here.q + s * here.tangent, self.held)
        if not found.residual_norm <= self.loops.thresholds.residual:
            return None
        basis, sigma = self._freedoms(found.jacobian)
        tangent = basis.T @ (basis @ here.tangent)
        idle = self._idle_motions(found.jacobian)
        tangent -= idle.T @ (idle @ tangent)
        size = float(np.linalg.norm(tangent))
        return None if size < 0.5 else CurvePose(q, tangent / size, sigma)

    def step(self, here: CurvePose, length: float) -> tuple[CurvePose, float] | None:
        """Take a step of at most this length, shortened until it stays on the curve; None where that fails.

        Returns the pose and the length of the step.
        """
        while length >= SHORTEST_STEP:
            there = self.at(here, length)
            if there is not None:
                apart = float(np.linalg.norm(there.q - here.q - length * here.tangent))
                if apart <= LARGEST_CORRECTION * length and float(there.tangent @ here.tangent) >= LEAST_TANGENT_COSINE:
                    return there, length
            length *= 0.5
        return None

    def reach(self, q: LoopCoordinates) -> float:
        """Measure how far the parts are spread: the longest slide, or 1, the characteristic length."""
        return float(np.abs(q[self.slides]).max(initial=1.0))

    def next_length(self, before: CurvePose, here: CurvePose, length: float) -> float:
        """Choose the length to try after a step of `length`: at most half of what is left to where branches cross.

        Beside such a pose the curve may turn back sharply, which a long step would not see.
        """
        longest = FIRST_STEP if abs(here.tangent[self.drive]) < SLOW else LONGEST_STEP
        angles, slides = np.delete(here.tangent, self.slides), here.tangent[self.slides]
        longest /= float(np.hypot(np.linalg.norm(angles), np.linalg.norm(slides) / self.reach(here.q)))
        if (fall := before.sigma - here.sigma) > 0:
            longest = min(longest, max(0.5 * length * here.sigma / fall, CROSSING))
        return min(2.0 * length, longest)

    def locate(self, here: CurvePose, length: float, event: Callable[[CurvePose], float]) -> tuple[float, CurvePose]:
        """Find the arc length within a step at which a function of the pose is zero, and the pose there."""
        from scipy.optimize import root_scalar

        def value(s: float) -> float:
            there = self.at(here, s)
            return np.nan if there is None else event(there)

        if event(here) == 0.0:
            return 0.0, here
        s = float(root_scalar(value, bracket=(0.0, length), method="brentq", xtol=ACCURACY, rtol=RELATIVE).root)
        there = self.at(here, s)
        return s, here if there is None else there
